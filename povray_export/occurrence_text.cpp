// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/occurrence_text.h"

namespace lodestone::povray {
namespace {

/// A user's name inside a comment: letters, digits and underscores only.
std::string plain(const std::string& name) {
    std::string out;
    for (const char c : name) {
        const bool kept =
            (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
        out += kept ? c : '_';
        if (out.size() == 60)
            break;
    }
    return out.empty() ? "unnamed" : out;
}

std::string name_of_node(const Model& model, const quality::Cut& cut, uint32_t node) {
    const quality::Node& here = cut.nodes[node];
    if (here.parent == quality::kNoParent)
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

std::string comment_of(const Model& model, const quality::Cut& cut, uint32_t node) {
    return plain(name_of_node(model, cut, node));
}

}  // namespace lodestone::povray
