// SPDX-License-Identifier: GPL-3.0-or-later
// Cards with masks on them, shared by the tests of what is cut out of them.
#pragma once

#include "povray/povray_scenes.h"
#include "povray_export/mesh/mesh_cutting.h"

#include <functional>

namespace lodestone::povray {

using AlphaAt = std::function<double(double, double)>;  // of picture coordinates, v up

inline Texture alpha_of(int side, const AlphaAt& alpha) {
    std::vector<glm::vec4> texels;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x)
            texels.emplace_back(
                0.2, 0.6, 0.3, std::clamp(alpha((x + 0.5) / side, 1 - (y + 0.5) / side), 0.0, 1.0));
    }
    Texture texture;
    texture.picture = scenes::picture(side, texels);
    texture.channel = TextureChannel::Alpha;
    return texture;
}

/// A disk whose edge is a texel wide.
inline Texture disk(int side = 64, double radius = 0.3) {
    return alpha_of(side, [=](double u, double v) {
        return 0.5 + (radius - std::hypot(u - 0.5, v - 0.5)) * side;
    });
}

inline Material leaf(const Texture& alpha) {
    Material material;
    material.specular = 0;
    material.base_color_texture = alpha;
    material.base_color_texture.channel = TextureChannel::Color;
    material.alpha_texture = alpha;
    material.alpha_mode = AlphaMode::Blend;
    return material;
}

/// A square of one metre on which the picture lies `times` in both directions.
inline Mesh card(double times = 1) {
    Mesh mesh = shapes::quad(1, 1);
    for (const glm::vec3& at : mesh.positions)
        mesh.uvs.emplace_back(times * at.x, times * at.y);
    return mesh;
}

/// The mesh with its only material's mask cut out, as an export does it.
inline CutMesh cut(const Mesh& mesh, const Material& material, std::optional<int> outline = {},
                   bool coarse_crowds = true) {
    scenes::Builder builder;
    const ObjectIndex object = builder.mesh(mesh, {builder.material(material)});
    MaskOutlines outlines;
    RepresentationOptions options;
    options.outline = outline;
    options.coarse_crowds = coarse_crowds;
    return cut_masks(builder.model, builder.model.objects[object].representations[0], options,
                     outlines, {});
}

}  // namespace lodestone::povray
