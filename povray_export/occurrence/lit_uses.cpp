// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/occurrence/lit_uses.h"

namespace lodestone::povray {

std::vector<LitUse> lit_uses(std::span<const OccurrenceUse* const> drawn,
                             const light::LightPlan& plan) {
    std::vector<uint32_t> parts(drawn.size(), 0);
    for (const light::LitPiece& piece : plan.pieces)
        ++parts[piece.drawn];
    std::vector<LitUse> out;
    out.reserve(plan.pieces.size());
    for (const light::LitPiece& piece : plan.pieces) {
        LitUse part{*drawn[piece.drawn], piece.within, piece.group};
        if (parts[piece.drawn] > 1)
            part.use.hidden |= kShadowRays;
        out.push_back(part);
    }
    for (size_t i = 0; i < drawn.size(); ++i) {
        if (parts[i] < 2 || (drawn[i]->hidden & kShadowRays) != 0)
            continue;
        LitUse whole{*drawn[i], {}};
        whole.use.hidden = kAllRays & static_cast<RayMask>(~kShadowRays);
        out.push_back(whole);
    }
    return out;
}

}  // namespace lodestone::povray
