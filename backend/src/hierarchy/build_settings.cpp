// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/build_settings.h"

namespace lodestone::hierarchy {

Hash hash_of(const BuildSettings& settings) {
    constexpr uint32_t kAlgorithms = 27;  // raised whenever the same settings give other stand-ins
    return Hasher()
        .value(kAlgorithms)
        .value(settings.level_ratio)
        .value(settings.rays)
        .value(settings.samples)
        .value(settings.group_triangles)
        .value(settings.seed)
        .result();
}

}  // namespace lodestone::hierarchy
