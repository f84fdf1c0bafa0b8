// SPDX-License-Identifier: GPL-3.0-or-later
// RecentBlockers: the triangles that blocked rays lately, which may block the next ones beside these.
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>

namespace lodestone::ray {

/// Of one scene, by one thread. A scene that is asked with them answers the same, sooner where what
/// blocks a ray is likely to block the next one.
class RecentBlockers {
public:
    /// Takes the place of the oldest of eight. Corners lie in the unit sphere.
    void add(const std::array<glm::vec3, 3>& corners);
    /// Whether one of them surely blocks a ray without end: by so much that a watertight test in
    /// single precision says so too. The direction has unit length.
    bool block(const glm::vec3& origin, const glm::vec3& direction) const;

private:
    using Four = float __attribute__((vector_size(16)));
    static constexpr size_t kFours = 2;

    /// Edges as Pluecker coordinates: a ray passes each on the side that a product tells.
    struct PlueckerTriangles {
        std::array<std::array<Four, 3>, 3> edges;
        std::array<std::array<Four, 3>, 3> moments;
        std::array<Four, 3> normal;
        Four height;  // of the plane, times the normal's length
        Four slack;   // of products; without one, as at first, a triangle without area
    };
    std::array<PlueckerTriangles, kFours> fours_{};
    size_t next_ = 0;
};

}  // namespace lodestone::ray
