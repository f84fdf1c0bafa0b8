// SPDX-License-Identifier: GPL-3.0-or-later
// RecentBlockers: triangles that blocked rays lately and may block the rays that come next.
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>

namespace lodestone::ray {

/// The blockers of one scene, for one thread. A scene that is asked with them gives the same
/// answers, sooner where the triangle that blocks a ray is likely to block the next one.
class RecentBlockers {
public:
    /// Adds a triangle in the place of the oldest of eight. Corners lie in the unit sphere.
    void add(const std::array<glm::vec3, 3>& corners);
    /// Whether one of them surely blocks a ray without end: by so much that a watertight test in
    /// single precision says so too. The direction has unit length.
    bool block(const glm::vec3& origin, const glm::vec3& direction) const;

private:
    using Four = float __attribute__((vector_size(16)));
    /// Groups of four triangles.
    /// Taste: a larger value remembers more blockers and costs 40 instructions more for every ray.
    static constexpr size_t kFours = 2;

    /// Edges as Pluecker coordinates: the sign of a product tells on which side a ray passes an
    /// edge.
    struct PlueckerTriangles {
        std::array<std::array<Four, 3>, 3> edges;
        std::array<std::array<Four, 3>, 3> moments;
        std::array<Four, 3> normal;
        Four height;  // the plane's, times the normal's length
        Four slack;   // the doubt of products; a triangle without area at first
    };
    std::array<PlueckerTriangles, kFours> fours_{};
    size_t next_ = 0;
};

}  // namespace lodestone::ray
