// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/cut_totals.h"

namespace lodestone::choose {

void CutTotals::clear(const ChoiceTable& table) {
    uses_.assign(table.distinct(), 0);
    kinds_.fill(0);
    occurrence_bytes_ = table.model().costs.occurrence_bytes;
}

void CutTotals::count(const TableLevel& level, bool more, Cut& cut) {
    uint32_t& uses = uses_[level.distinct];
    // A union of solids is copied for each occurrence.
    const bool own = is_copied(level.kind) || uses == (more ? 0u : 1u);
    const uint64_t bytes = occurrence_bytes_ + (own ? level.bytes : 0);
    const uint64_t original = level.lod == 0 ? 1 : 0;
    uint64_t& kind = kinds_[static_cast<size_t>(level.kind)];
    if (more) {
        ++uses;
        ++kind;
        cut.triangles += level.triangles;
        cut.bytes += bytes;
        cut.originals += original;
    } else {
        --uses;
        --kind;
        cut.triangles -= level.triangles;
        cut.bytes -= bytes;
        cut.originals -= original;
    }
}

}  // namespace lodestone::choose
