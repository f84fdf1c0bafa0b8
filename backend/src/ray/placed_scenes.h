// SPDX-License-Identifier: GPL-3.0-or-later
// Placed scenes: rays through many placements of few meshes, each mesh kept once.
#pragma once

#include "base/maths.h"
#include "ray/mesh_scene.h"

#include <memory>
#include <vector>

namespace lodestone::ray {

/// Const methods may be called from any thread, once finish() has been.
class PlacedScenes {
public:
    /// What a hit is named by. A placement that cannot be inverted or is not finite is never hit.
    void add(std::shared_ptr<const MeshScene> scene, const Bound& bound, const Affine& world,
             uint32_t name);
    /// Sorts what was added into a tree of boxes.
    void finish();

    struct PlacedHit {
        bool hit = false;
        uint32_t name = 0;
        uint32_t triangle = kNoTriangle;
        double u = 0;
        double v = 0;
        double t = std::numeric_limits<double>::infinity();  // point = origin + t direction
    };
    /// The nearest hit with 0 <= t <= far; among equally near ones the one that was added first.
    PlacedHit first_hit(const glm::dvec3& origin, const glm::dvec3& direction,
                        double far = std::numeric_limits<double>::infinity()) const;
    bool occluded(const glm::dvec3& origin, const glm::dvec3& direction, double far) const;
    /// The same, sooner where `blocker` is what blocked a ray beside this one: it is tried first,
    /// and becomes what blocks this one. It changes no answer. kNothing: none is known.
    bool occluded(const glm::dvec3& origin, const glm::dvec3& direction, double far,
                  uint32_t& blocker) const;
    static constexpr uint32_t kNothing = ~uint32_t{0};

    /// Of all that was added, world frame.
    const Box3& box() const { return all_; }

private:
    struct PlacedScene {
        std::shared_ptr<const MeshScene> scene;
        Affine inverse;
        Box3 box;
        uint32_t name = 0;
    };
    struct SceneCell {
        Box3 box;
        uint32_t first = 0;  // of placed_; inside: the second child, the first comes right after it
        uint32_t count = 0;  // 0: inside
    };

    void split(uint32_t first, uint32_t last, int depth);
    uint32_t divide(uint32_t first, uint32_t last, const Box3& middles);
    template <typename Visit>
    void walk(const glm::dvec3& origin, const glm::dvec3& direction, double& far,
              const Visit& visit) const;

    std::vector<PlacedScene> placed_;
    std::vector<SceneCell> cells_;
    Box3 all_;
};

}  // namespace lodestone::ray
