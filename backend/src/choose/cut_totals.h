// SPDX-License-Identifier: GPL-3.0-or-later
// Cut totals: the sums of a cut, kept up to date while nodes come and go.
#pragma once

#include "choose/cut_chooser.h"

namespace lodestone::choose {

class CutTotals {
public:
    /// Starts again with an empty cut of the levels of this table.
    void clear(const ChoiceTable& table);
    /// Adds the cost of an occurrence that is drawn by a level to the sums of the cut, or subtracts
    /// it.
    void count(const TableLevel& level, bool more, Cut& cut);
    const std::array<uint64_t, kKinds>& kinds() const { return kinds_; }

private:
    std::vector<uint32_t> uses_;  // by TableLevel::distinct
    std::array<uint64_t, kKinds> kinds_{};
    uint64_t occurrence_bytes_ = 0;
};

}  // namespace lodestone::choose
