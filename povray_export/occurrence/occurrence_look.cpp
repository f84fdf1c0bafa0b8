// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/occurrence/occurrence_look.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lodestone::povray {

bool is_environment(const Model& model, const choose::Cut& cut,
                    const std::vector<uint8_t>& holds_environment, uint32_t node) {
    if (holds_environment[cut.nodes[node].object] != 0)
        return true;
    for (uint32_t at = node; at != choose::kNoParent; at = cut.nodes[at].parent) {
        if (model.objects[cut.nodes[at].object].role == ObjectRole::Environment)
            return true;
    }
    return false;
}

std::optional<glm::dvec3> without_glow(const Model& model, const Representation& representation,
                                       RayMask hidden) {
    if ((hidden & kRadiosityRays) == 0)
        return {};
    glm::dvec3 color(0.0);
    bool glows = false;
    double count = 0;
    for (const uint32_t index : representation.materials) {
        if (index >= model.materials.size())
            continue;
        const Material& material = model.materials[index];
        glows = glows || glm::dot(material.emission, material.emission) > 0;
        color += glm::clamp(material.base_color, 0.0, 1.0);
        ++count;
    }
    if (!glows)
        return {};
    return color / count;
}

}  // namespace lodestone::povray
