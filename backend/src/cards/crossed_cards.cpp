// SPDX-License-Identifier: GPL-3.0-or-later
#include "cards/crossed_cards.h"

#include "cards/card_light.h"
#include "cards/card_normals.h"
#include "cards/coverage_fit.h"
#include "solids/stand_in_material.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lodestone::cards {
namespace {

/// The picture's place of a card's border, 0...1 from the picture's lower left corner.
glm::vec2 place_in(const CardPicture& picture, const CardPatch& patch, double x, double y) {
    const double column = patch.left + 0.5 * (x + 1) * patch.width;
    const double row = patch.top + 0.5 * (1 - y) * patch.height;
    return {static_cast<float>(column / picture.width),
            static_cast<float>(1 - row / picture.height)};
}

/// Two rectangles for each plane, back to back: each side has its own normals.
Mesh mesh_of(const std::vector<CardPlane>& planes, const CardPicture& picture) {
    // The distance of a side from its plane, over its half diagonal.
    // Taste: no pixel of a level is as small; a smaller one is lost where scenes are large.
    constexpr double kApart = 2e-4;
    Mesh out;
    for (size_t i = 0; i < planes.size(); ++i) {
        const CardPlane& plane = planes[i];
        for (const size_t side : {0, 1}) {
            const double sign = side == 0 ? 1 : -1;
            const glm::dvec3 face = sign * plane.normal();
            const glm::dvec3 off = kApart * glm::length(plane.half_size) * face;
            const auto first = static_cast<uint32_t>(out.positions.size());
            const SideNormals normals(picture.normals[i][side], face);
            for (const glm::dvec2& corner :
                 {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1)}) {
                const glm::dvec2 at(sign * corner.x, corner.y);
                out.positions.emplace_back(plane.at(at.x, at.y) + off);
                out.uvs.push_back(place_in(picture, picture.patches[i], at.x, at.y));
                out.normals.emplace_back(normals.at(at));
            }
            out.triangles.emplace_back(first, first + 1, first + 2);
            out.triangles.emplace_back(first, first + 2, first + 3);
        }
    }
    return out;
}

}  // namespace

double picture_bytes(const Mesh& mesh, const glm::dvec3& middle, const CardOptions& options) {
    // Law: red, green, blue and alpha of 8 bits.
    constexpr double kTexelBytes = 4;
    const std::vector<CardPlane> planes = crossed_planes(mesh, middle);
    return kTexelBytes *
           static_cast<double>(picture_of_cards(planes, options.texels).texels.size());
}

std::optional<CrossedCards> crossed_cards(const Mesh& mesh, const ray::MeshScene& scene,
                                          const ray::MeshSkin& skin, const Attributes& attributes,
                                          const CardOptions& options, const Job& job) {
    const std::vector<CardPlane> planes = crossed_planes(mesh, attributes.centroid);
    if (planes.empty())
        return std::nullopt;
    CardPicture picture = picture_of_cards(planes, options.texels);
    cast_picture(picture, planes, mesh, scene, skin, options.seed, job);
    if (std::none_of(picture.texels.begin(), picture.texels.end(),
                     [](const glm::vec4& texel) { return texel.w > 0; }))
        return std::nullopt;
    fill_clear(picture);  // before the fit, which covers texels that no ray has hit
    fit_coverage(picture, planes, scene, options.seed, job);
    match_light(picture, planes, mesh, scene, skin, options.seed, job);
    fill_clear(picture);  // again: what is around changed its color
    const Texture color = texture_of(picture);
    Texture alpha = color;
    alpha.channel = TextureChannel::Alpha;
    alpha.scale = glm::dvec3(1.0);
    CrossedCards out;
    out.material = solids::mean_material(attributes);
    out.material.name = "cards";
    out.material.base_color_texture = color;
    out.material.alpha_texture = alpha;
    out.material.base_color = glm::dvec3(color.picture->mean) * color.scale;
    out.material.alpha = color.picture->mean.w;
    out.material.alpha_mode = AlphaMode::Clip;
    out.material.alpha_cutoff = double{kCardCutoff};
    out.mesh = mesh_of(planes, picture);
    out.picture = std::move(picture);
    return out;
}

}  // namespace lodestone::cards
