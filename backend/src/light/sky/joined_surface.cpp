// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/sky/joined_surface.h"

#include <glm/matrix.hpp>

#include <utility>

namespace lodestone::light {
namespace {

/// Adds a surface to a mesh whose slots are 0 for what is opaque and 1 for the rest.
void join(const SkySurface& surface, const Affine& placed, Mesh& all) {
    const Mesh& mesh = *surface.mesh;
    const bool mirrored = glm::determinant(placed.linear) < 0;
    std::vector<uint32_t> numbers(mesh.positions.size(), ~uint32_t{0});
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        Triangle t = mesh.triangles[i];
        if (mirrored)
            std::swap(t.y, t.z);
        for (int corner = 0; corner < 3; ++corner) {
            uint32_t& number = numbers[t[corner]];
            if (number == ~uint32_t{0}) {
                number = static_cast<uint32_t>(all.positions.size());
                all.positions.emplace_back(placed(glm::dvec3(mesh.positions[t[corner]])));
            }
            t[corner] = number;
        }
        all.triangles.push_back(t);
        all.slots.push_back(surface.opaque_slot(mesh.slot(i)) ? 0 : 1);
    }
}

}  // namespace

std::optional<SkySurface> joined_surface(const SkySurfaces& surfaces,
                                         std::span<const SkyOccluder> occluders,
                                         const Affine& world, uint64_t most_triangles) {
    uint64_t triangles = 0;
    for (const SkyOccluder& occluder : occluders) {
        triangles += surfaces.of(*occluder.representation).mesh->triangles.size();
        if (triangles > most_triangles)
            return {};
    }
    Affine to_own;
    to_own.linear = glm::inverse(world.linear);
    to_own.offset = -(to_own.linear * world.offset);
    if (triangles == 0 || !to_own.finite())
        return {};
    Mesh mesh;
    SkySurface out;
    for (const SkyOccluder& occluder : occluders) {
        const SkySurface& own = surfaces.of(*occluder.representation);
        join(own, to_own * occluder.world, mesh);
        out.masks.insert(out.masks.end(), own.masks.begin(), own.masks.end());
    }
    out.see_through = {0, 1};
    out.scene = std::make_shared<const ray::MeshScene>(mesh);
    out.mesh = std::make_shared<const Mesh>(std::move(mesh));
    return out;
}

}  // namespace lodestone::light
