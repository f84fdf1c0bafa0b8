// SPDX-License-Identifier: GPL-3.0-or-later
// Random place: triangles of a placed mesh, and places on them, by chance.
#pragma once

#include "base/maths.h"
#include "base/random.h"
#include "measure/visible/convex_bound.h"
#include "model/mesh.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <span>

namespace lodestone::light {

/// Takes its chances from a generator, which it shares. For one thread; the mesh and the generator
/// outlive it.
class RandomPlace {
public:
    RandomPlace(const Mesh& mesh, const Affine& world, PcgRandom& random)
        : mesh_(mesh), world_(world), random_(random) {}

    /// One of some triangles (at least one), rather one that faces a way (world): what is solid
    /// hides the others from there.
    uint32_t one_of(std::span<const uint32_t> triangles, const glm::dvec3& way) {
        // The triangles that are looked at for one that faces the way.
        // Taste: more choose one more surely, also where few face it.
        constexpr int kPicks = 4;
        uint32_t chosen = triangles.front();
        for (int i = 0; i < kPicks; ++i) {
            const double at = random_.uniform() * static_cast<double>(triangles.size());
            chosen = triangles[std::min(static_cast<size_t>(at), triangles.size() - 1)];
            if (glm::dot(across(chosen), way) > 0)
                break;
        }
        return chosen;
    }

    /// Across a triangle in the world, to the side from which its corners turn left; as long as twice
    /// its area.
    glm::dvec3 across(uint32_t triangle) const {
        const glm::dvec3 a = corner(triangle, 0);
        const glm::dvec3 u = world_.linear * (corner(triangle, 1) - a);
        const glm::dvec3 v = world_.linear * (corner(triangle, 2) - a);
        return glm::cross(u, v);
    }

    /// A place on a triangle, in the world.
    glm::dvec3 point_on(uint32_t triangle) {
        const double a = random_.uniform();
        const glm::dvec2 at = measure::uniform_in_triangle(a, random_.uniform());
        return world_((1 - at.x - at.y) * corner(triangle, 0) + at.x * corner(triangle, 1) +
                      at.y * corner(triangle, 2));
    }

private:
    glm::dvec3 corner(uint32_t triangle, int i) const {
        return glm::dvec3(mesh_.positions[mesh_.triangles[triangle][i]]);
    }

    const Mesh& mesh_;
    const Affine world_;
    PcgRandom& random_;
};

}  // namespace lodestone::light
