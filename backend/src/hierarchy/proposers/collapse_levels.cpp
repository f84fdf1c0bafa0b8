// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/collapse_levels.h"

#include "hierarchy/proposers/surface_chunks.h"

#include <algorithm>
#include <cmath>

namespace lodestone::hierarchy {
namespace {

bool shows_vertex_colors(const Material& material) {
    return material.vertex_colors || (material.other && shows_vertex_colors(*material.other));
}

}  // namespace

std::vector<size_t> targets_of(size_t triangles, size_t first, double ratio) {
    std::vector<size_t> targets;
    auto target = static_cast<double>(first);
    while (target >= kFewestTriangles) {
        const auto count = static_cast<size_t>(target);
        if (count < triangles && (targets.empty() || count < targets.back()))
            targets.push_back(count);
        target *= ratio;
    }
    return targets;
}

std::vector<size_t> targets_of(const Mesh& mesh, const BuildSettings& settings) {
    const size_t count = mesh.triangles.size();
    const auto first = static_cast<size_t>(static_cast<double>(count) * settings.level_ratio);
    // Each chunk of a large surface takes the level that it needs, so that steps half as large pay.
    const double ratio =
        is_large_surface(mesh) ? std::sqrt(settings.level_ratio) : settings.level_ratio;
    return targets_of(count, first, ratio);
}

std::vector<Material> materials_of(const Model& model, const Representation& finest) {
    std::vector<Material> materials;
    for (const uint32_t material : finest.materials)
        materials.push_back(model.materials.at(material));
    if (materials.empty())
        materials.emplace_back();
    return materials;
}

const Mesh& without_unseen_colors(const Mesh& mesh, const std::vector<Material>& materials,
                                  Mesh& plain) {
    if (mesh.colors.empty() || std::any_of(materials.begin(), materials.end(), shows_vertex_colors))
        return mesh;
    plain = mesh;
    plain.colors.clear();
    return plain;
}

}  // namespace lodestone::hierarchy
