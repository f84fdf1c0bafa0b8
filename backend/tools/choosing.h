// SPDX-License-Identifier: GPL-3.0-or-later
// Choosing: what --max-triangles, --max-memory, --criterion, --off-screen and --ray-classes mean,
// for every verb that makes a cut.
#pragma once

#include "arguments.h"
#include "report.h"
#include "session.h"

namespace lodestone::tools {

extern const OptionHelp kMaxTriangles;
extern const OptionHelp kMaxMemory;
extern const OptionHelp kCriterion;
extern const OptionHelp kOffScreen;
extern const OptionHelp kRayClasses;

class CutOptions {
public:
    /// Throws UsageError. The view's threshold is the criterion's.
    CutOptions(const CommandArguments& arguments, lds_view& view);
    CutOptions(const CutOptions&) = delete;
    CutOptions& operator=(const CutOptions&) = delete;

    /// The view's cut; with a budget view.pixel_error becomes what fits, and a warning is said
    /// where nothing does.
    CutHandle cut(lds_model* model, lds_job* job);
    /// What the classes of rays asked for meet: printed, and for a report; empty without any.
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
