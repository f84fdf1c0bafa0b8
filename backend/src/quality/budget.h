// SPDX-License-Identifier: GPL-3.0-or-later
// Budget: the finest threshold whose cut costs no more than asked (5.5.3 with counts instead of time).
#pragma once

#include "quality/cut.h"

namespace lodestone::quality {

struct Budget {
    uint64_t triangles = 0;  // placed; 0: any number
    uint64_t bytes = 0;      // in POV-Ray's memory, as Cut::bytes; 0: any number

    bool fits(const Cut& cut) const {
        return (triangles == 0 || cut.triangles <= triangles) && (bytes == 0 || cut.bytes <= bytes);
    }
};

struct Budgeted {
    Cut cut;
    double pixel_error = 0;  // the threshold it was chosen with
    bool fits = false;       // false: the coarsest cut, which costs more than the budget
    uint32_t cuts = 0;       // that were tried
};

/// The cut of the least threshold not below view.pixel_error (of Criterion::Distance: the greatest not
/// above) whose cost fits. A larger budget never gives a coarser threshold. Memory may rise while the
/// threshold does, where a mesh is then used at two levels instead of one: such a hump is looked behind
/// where it is narrower than a factor of two.
/// cost: up to some 100 cuts, each given up when it is known not to fit
Budgeted choose_within(const Model& model, const View& view, const Budget& budget,
                       const Job& job = {});

}  // namespace lodestone::quality
