// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene/occurrence_text.h"

#include <string_view>

namespace lodestone::povray {
namespace {

const std::string& name_of_node(const Model& model, const choose::Cut& cut, uint32_t node) {
    const choose::CutNode& here = cut.nodes[node];
    if (here.parent == choose::kNoParent)
        return model.objects[here.object].name;
    const Object& group = model.objects[cut.nodes[here.parent].object];
    return group.representations[0].assembly().placements[here.placement].name;
}

}  // namespace

void append_hidden(std::string& out, RayMask hidden) {
    if ((hidden & kCameraRays) != 0)
        out += " no_image";
    if ((hidden & kReflectionRays) != 0)
        out += " no_reflection";
    if ((hidden & kShadowRays) != 0)
        out += " no_shadow";
    if ((hidden & kRadiosityRays) != 0)
        out += " no_radiosity";
}

void append_name(std::string& out, const Model& model, const choose::Cut& cut, uint32_t node) {
    const std::string& name = name_of_node(model, cut, node);
    if (name.empty())
        out += "unnamed";
    for (const char c : std::string_view(name).substr(0, 60)) {
        const bool kept =
            (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
        out += kept ? c : '_';
    }
}

}  // namespace lodestone::povray
