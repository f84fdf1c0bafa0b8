// SPDX-License-Identifier: GPL-3.0-or-later
// Edge costs for AVX2: compiled for it, and called only where the processor has it.
#ifdef LODESTONE_AVX2
#define LODESTONE_LANES 8
#include "simplify/collapse/edge_costs_lanes.h"

namespace lodestone::simplify {

void edge_costs_by_8(EdgeBlock& block, size_t count) {
    costs_of(block, count);
}

}  // namespace lodestone::simplify
#endif
