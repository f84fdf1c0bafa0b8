// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene/occurrence_text.h"

#include "choose/ray_class/ray_cut.h"

#include <array>
#include <string_view>

namespace lodestone::povray {
namespace {

/// For each of kRayClasses: what hides a thing from it.
constexpr std::array kHiddenWords{" no_image", " no_reflection", " no_shadow", " no_radiosity"};
static_assert(kHiddenWords.size() == kRayClasses.size());

/// Whether what the camera sees can be hidden from each class that may meet something else in its
/// place.
constexpr bool replaced_things_can_be_hidden() {
    for (size_t i = 0; i < kHiddenWords.size(); ++i) {
        if (choose::kRayRules[i] != choose::RayRule::None && kHiddenWords[i][0] == '\0')
            return false;
    }
    return true;
}
static_assert(replaced_things_can_be_hidden());

const std::string& name_of_node(const Model& model, const choose::Cut& cut, uint32_t node) {
    const choose::CutNode& here = cut.nodes[node];
    if (here.parent == choose::kNoParent)
        return model.objects[here.object].name;
    const Object& group = model.objects[cut.nodes[here.parent].object];
    return group.representations[0].assembly().placements[here.placement].name;
}

}  // namespace

void append_hidden(std::string& out, RayMask hidden) {
    for (size_t i = 0; i < kRayClasses.size(); ++i) {
        if ((hidden & kRayClasses[i]) != 0)
            out += kHiddenWords[i];
    }
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
