// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/seen/distinct_shapes.h"

#include <unordered_map>

namespace lodestone::light {

DistinctShapes distinct_shapes(std::span<const DrawnThing> drawn) {
    DistinctShapes out;
    std::unordered_map<Hash, uint32_t> known;
    for (uint32_t i = 0; i < drawn.size(); ++i) {
        const auto [at, fresh] = known.try_emplace(drawn[i].representation->summary.hash,
                                                   static_cast<uint32_t>(out.firsts.size()));
        if (fresh)
            out.firsts.push_back(i);
        out.of_thing.push_back(at->second);
    }
    return out;
}

}  // namespace lodestone::light
