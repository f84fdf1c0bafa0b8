// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/occurrence/ray_class_uses.h"

namespace lodestone::povray {

std::vector<OwnUse> own_uses(const Model& model, const choose::Cut& cut,
                             std::span<const choose::RayCut> rays, bool softened) {
    std::vector<OwnUse> out;
    std::vector<uint8_t> there(cut.nodes.size(), 0);  // classes of each node together
    for (const choose::RayCut& of : rays) {
        for (const choose::RayChoice& own : of.own) {
            if (there.at(own.node) != 0 || (own.soft && !softened))
                continue;
            there[own.node] = own.alone ? 1 : 0;
            const choose::CutNode& node = cut.nodes[own.node];
            OwnUse use{own.node, own.lod, cut.world(node), 0, node.hidden, true};
            if (!own.alone) {
                use.in_place = of.rays;
                use.hidden |= static_cast<RayMask>(kAllRays & ~of.rays);
                use.textures = choose::rule_of(of.rays) != choose::RayRule::Shadow;
            }
            if (own.scale != 1) {
                const Primitive& solid =
                    model.objects.at(node.object).representations.at(own.lod).primitive();
                use.world =
                    cut.world(node) * Affine{glm::dmat3(own.scale), (1 - own.scale) * solid.center};
            }
            out.push_back(use);
        }
    }
    return out;
}

std::vector<uint8_t> nodes_left_out(const choose::Cut& cut, std::span<const choose::RayCut> rays) {
    std::vector<RayMask> alone(cut.nodes.size(), 0);
    for (const choose::RayCut& of : rays) {
        for (const choose::RayChoice& own : of.own) {
            if (own.alone)
                alone.at(own.node) = 1;
        }
    }
    return replaced_ray_classes(cut, std::move(alone));
}

std::vector<RayMask> replaced_ray_classes(const choose::Cut& cut, std::vector<RayMask> replaced) {
    for (size_t i = 0; i < replaced.size(); ++i) {
        if (cut.nodes[i].parent != choose::kNoParent)
            replaced[i] |= replaced[cut.nodes[i].parent];
    }
    return replaced;
}

}  // namespace lodestone::povray
