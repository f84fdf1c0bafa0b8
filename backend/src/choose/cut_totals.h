// SPDX-License-Identifier: GPL-3.0-or-later
// CutTotals: a cut's sums, kept while nodes come and go.
#pragma once

#include "choose/cut_chooser.h"

namespace lodestone::choose {

class CutTotals {
public:
    /// Of nothing.
    void clear(const ChoiceTable& table);
    /// Adds what something costs that is drawn by a level to the cut's sums, or takes it away.
    void count(const TableLevel& level, bool more, Cut& cut);
    const std::array<uint64_t, kKinds>& kinds() const { return kinds_; }

private:
    std::vector<uint32_t> uses_;  // by TableLevel::distinct
    std::array<uint64_t, kKinds> kinds_{};
};

}  // namespace lodestone::choose
