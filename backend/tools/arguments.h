// SPDX-License-Identifier: GPL-3.0-or-later
// Command arguments: positional words and long options, checked against what a verb takes.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace lodestone::tools {

/// A mistake on the command line; the command ends with exit code 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// One option of a verb, for parsing and for help.
struct OptionHelp {
    const char* name;   // without the dashes
    const char* value;  // "N", "FILE", ...; "" for a switch
    const char* text;
};

/// The words of a command line, parsed.
class CommandArguments {
public:
    /// Takes the words after the verb. Throws UsageError for an unknown option or a missing value.
    CommandArguments(const std::vector<std::string>& words, const std::vector<OptionHelp>& options);

    const std::vector<std::string>& positional() const { return positional_; }
    /// Whether the option was given, and its value.
    bool has(const std::string& option) const { return values_.count(option) != 0; }
    std::optional<std::string> text(const std::string& option) const;
    /// The value of an option, or `otherwise`. Throws UsageError unless it is a finite number
    /// within the range.
    double number(const std::string& option, double otherwise, double least, double most) const;
    uint64_t count(const std::string& option, uint64_t otherwise) const;

private:
    std::vector<std::string> positional_;
    std::map<std::string, std::string> values_;
};

}  // namespace lodestone::tools
