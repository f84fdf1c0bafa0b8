// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/occurrence/occurrence_text.h"

#include "povray_export/scene/magnification.h"
#include "povray_export/scene/povray_number.h"
#include "povray_export/texture/surface_finish.h"

#include <array>
#include <string_view>

namespace lodestone::povray {
namespace {

/// For each of kRayClasses: what hides a thing from it. Each class needs a word: where something is
/// drawn a second time for some classes, all others must meet one of the two.
constexpr std::array kHiddenWords{" no_image", " no_reflection", " no_shadow", " no_radiosity"};
static_assert(kHiddenWords.size() == kRayClasses.size());

constexpr bool each_class_has_a_word() {
    for (const char* word : kHiddenWords) {
        if (word[0] != ' ' || word[1] == '\0')
            return false;
    }
    return true;
}
static_assert(each_class_has_a_word(), "a thing can be hidden from each class of rays");

const std::string& name_of_node(const Model& model, const choose::Cut& cut, uint32_t node) {
    const choose::CutNode& here = cut.nodes[node];
    if (here.parent == choose::kNoParent)
        return model.objects[here.object].name;
    const Object& group = model.objects[cut.nodes[here.parent].object];
    return group.representations[0].assembly().placements[here.placement].name;
}

}  // namespace

void append_occurrence(std::string& out, const std::string& identifier, const OccurrenceUse& use,
                       const std::optional<glm::dvec3>& flat, double times,
                       const std::optional<Box3>& within) {
    out += "object{";
    out += identifier;
    out += ' ';
    if (flat) {
        append_flat_texture(out, *flat);
        out += ' ';
    }
    if (use.dull) {
        out += "texture{pigment{";
        append_rgb(out, *use.dull);
        out += "} finish{ambient 0 emission 0 diffuse 1}} ";
    }
    append_matrix(out, magnified(use.world, times));
    append_hidden(out, use.hidden);
    if (within) {
        out += " clipped_by{box{";
        append_vector(out, within->low * times, 15);
        out += ',';
        append_vector(out, within->high * times, 15);
        out += "}}";
    }
    out += "} // ";
}

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
