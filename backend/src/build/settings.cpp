// SPDX-License-Identifier: GPL-3.0-or-later
#include "build/settings.h"

namespace lodestone::build {

Hash hash_of(const Settings& settings) {
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

}  // namespace lodestone::build
