// SPDX-License-Identifier: GPL-3.0-or-later
// Report: the values that a verb found, in the order they are to be written; --json saves them.
#pragma once

#include "lodestone/lodestone.h"

#include <concepts>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace lodestone::tools {

class ReportValue;
using List = std::vector<ReportValue>;
using Fields = std::vector<std::pair<std::string, ReportValue>>;  // an object; its order is kept

/// A value that JSON can hold.
class ReportValue {
public:
    using Held = std::variant<std::nullptr_t, bool, uint64_t, double, std::string, List, Fields>;

    // These are not explicit: a report reads as a table of names and plain values.
    ReportValue() : held_(nullptr) {}
    ReportValue(bool value) : held_(value) {}
    ReportValue(std::unsigned_integral auto value) : held_(uint64_t{value}) {}
    ReportValue(double value) : held_(value) {}
    ReportValue(const char* text) : held_(std::string(text)) {}
    ReportValue(std::string text) : held_(std::move(text)) {}
    ReportValue(List values) : held_(std::move(values)) {}
    ReportValue(Fields fields) : held_(std::move(fields)) {}

    const Held& held() const { return held_; }

private:
    Held held_;
};

/// A report with the fields every verb has.
Fields report_of(const char* verb, const std::string& input);

/// The report's "cut".
Fields fields_of(const lds_cut_summary& summary);

/// "3 meshes, 1 boxes, ...": the occurrences drawn by each kind.
std::string kinds_line(const lds_cut_summary& summary);

/// The model's problems as the report's list; printed to stderr too.
List problems_of(const lds_model* model);

/// Writes the report as JSON where --json says (atomically), if it says so. Throws CallFailure.
void write_report(const std::string* path, const Fields& report);

}  // namespace lodestone::tools
