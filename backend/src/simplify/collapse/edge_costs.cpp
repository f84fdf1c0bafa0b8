// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse/edge_costs.h"

#define LODESTONE_LANES 4
#include "simplify/collapse/edge_costs_lanes.h"

namespace lodestone::simplify {

void edge_costs(EdgeBlock& block, size_t count) {
#ifdef LODESTONE_AVX2
    static const bool kWide = __builtin_cpu_supports("avx2");
    if (kWide) {
        edge_costs_by_8(block, count);
        return;
    }
#endif
    edge_costs_by_4(block, count);
}

void edge_costs_by_4(EdgeBlock& block, size_t count) {
    costs_of(block, count);
}

}  // namespace lodestone::simplify
