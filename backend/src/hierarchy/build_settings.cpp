// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/build_settings.h"

namespace lodestone::hierarchy {

Hash hash_of(const BuildSettings& settings) {
    // Law: the version of the algorithms, raised whenever the same settings give other stand-ins.
    constexpr uint32_t kAlgorithms = 48;
    return Hasher()
        .value(kAlgorithms)
        .value(settings.level_ratio)
        .value(settings.rays)
        .value(settings.samples)
        .value(settings.group_triangles)
        .value(settings.seed)
        .result();
}

Hash hash_of(const BuildSettings& settings, const CostModel& costs) {
    return Hasher()
        .value(hash_of(settings))
        .value(costs.triangle_bytes)
        .value(costs.primitive_bytes)
        .value(costs.occurrence_bytes)
        .value(costs.crossing_bytes)
        .result();
}

}  // namespace lodestone::hierarchy
