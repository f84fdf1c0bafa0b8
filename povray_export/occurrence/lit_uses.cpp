// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/occurrence/lit_uses.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lodestone::povray {

std::vector<light::DrawnThing> drawn_things(const Model& model, const choose::Cut& cut,
                                            std::span<const OccurrenceUse> uses,
                                            std::span<const RayMask> replaced) {
    std::vector<light::DrawnThing> drawn;
    drawn.reserve(uses.size());
    for (const OccurrenceUse& use : uses) {
        const choose::CutNode& node = cut.nodes[use.node];
        RayMask hidden = use.in_place != 0 ? kAllRays : node.hidden;
        // An object with flags is not parted; this flag says nothing to lights.
        if ((replaced[use.node] & ~hidden) != 0)
            hidden |= kRadiosityRays;
        drawn.push_back(
            {&model.objects.at(node.object).representations.at(use.lod), use.world, hidden});
    }
    return drawn;
}

std::vector<LitUse> lit_uses(std::span<const OccurrenceUse> drawn, const light::LightPlan& plan) {
    std::vector<uint32_t> parts(drawn.size(), 0);
    for (const light::LitPiece& piece : plan.pieces)
        ++parts[piece.drawn];
    std::vector<LitUse> out;
    out.reserve(plan.pieces.size());
    for (const light::LitPiece& piece : plan.pieces) {
        LitUse part{drawn[piece.drawn], piece.within, piece.group};
        if (parts[piece.drawn] > 1)
            part.use.hidden |= kShadowRays;
        out.push_back(part);
    }
    for (size_t i = 0; i < drawn.size(); ++i) {
        if (parts[i] < 2 || (drawn[i].hidden & kShadowRays) != 0)
            continue;
        LitUse whole{drawn[i], {}};
        whole.use.hidden = kAllRays & static_cast<RayMask>(~kShadowRays);
        out.push_back(whole);
    }
    return out;
}

std::vector<double> lamp_rays(std::span<const Bound> bounds, const light::LightPlan& plan) {
    std::vector<double> rays(bounds.size(), 0);
    std::vector<double> sizes(bounds.size(), 0);
    for (const light::LitPiece& piece : plan.pieces) {
        Box3 box = bounds[piece.drawn].box;
        if (piece.within && !box.empty()) {
            box.low = glm::max(box.low, piece.within->low);
            box.high = glm::min(box.high, piece.within->high);
        }
        if (box.empty())
            continue;
        const glm::dvec3 edges = box.size();
        const double size = glm::dot(edges, edges);
        sizes[piece.drawn] += size;
        for (const light::GroupLight& light : plan.groups[piece.group])
            rays[piece.drawn] += size * light::shadow_rays(plan.lights[light.light], light.grid);
    }
    for (size_t i = 0; i < rays.size(); ++i)
        rays[i] = sizes[i] > 0 ? rays[i] / sizes[i] : 0;
    return rays;
}

}  // namespace lodestone::povray
