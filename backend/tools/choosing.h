// SPDX-License-Identifier: GPL-3.0-or-later
// Choosing: the options --max-triangles, --max-memory, --criterion, --off-screen and --ray-classes,
// for every verb that makes a cut.
#pragma once

#include "arguments.h"
#include "report.h"
#include "session.h"

namespace lodestone::tools {

/// The options of choosing, for the verbs' lists.
extern const OptionHelp kMaxTriangles;
extern const OptionHelp kMaxMemory;
extern const OptionHelp kCriterion;
extern const OptionHelp kOffScreen;
extern const OptionHelp kRayClasses;

/// The options of choosing as they were given.
class CutOptions {
public:
    /// Reads the options; the view's threshold becomes the criterion's. Throws UsageError.
    CutOptions(const CommandArguments& arguments, lds_view& view);
    CutOptions(const CutOptions&) = delete;
    CutOptions& operator=(const CutOptions&) = delete;

    /// Makes the view's cut. With a budget view.pixel_error becomes the error that fits, and a
    /// warning is printed where nothing fits.
    CutHandle cut(lds_model* model, lds_job* job);
    /// Prints the representations that the classes of rays asked for meet, and returns them for a
    /// report; empty without any.
    Fields rays(const lds_cut* cut) const;
    /// Adds to a report how the threshold was found.
    void report(Fields& fields) const;

private:
    lds_view& view_;
    lds_modifiers modifiers_;
    lds_budget budget_{};
    lds_budget_report found_{};
    std::string criterion_;
};

}  // namespace lodestone::tools
