// SPDX-License-Identifier: GPL-3.0-or-later
// Budget: the finest threshold whose cut costs no more than asked (5.5.3 with counts instead of time).
#pragma once

#include "quality/cut.h"

namespace lodestone::quality {

struct Budgeted {
    Cut cut;
    double pixel_error = 0;  // the threshold it was chosen with
    bool fits = false;       // false: the coarsest cut, which costs more than the budget
    uint32_t cuts = 0;       // that were tried
};

/// The cut of the least threshold not below view.pixel_error whose cost fits. A larger budget never
/// gives a coarser threshold. Memory may rise while the threshold does, where a mesh is then used at two
/// levels instead of one: finer thresholds that fit behind such a hump are found where a power of two is
/// among them. Throws Error(InvalidArgument) for Criterion::Distance.
/// cost: up to some 100 cuts, each given up when it is known not to fit
Budgeted choose_within(const Model& model, const View& view, const Budget& budget,
                       const Job& job = {});
/// The same with a whole table of the model for the view's kinds.
Budgeted choose_within(const Table& table, const View& view, const Budget& budget,
                       const Job& job = {});

}  // namespace lodestone::quality
