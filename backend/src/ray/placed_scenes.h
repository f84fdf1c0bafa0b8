// SPDX-License-Identifier: GPL-3.0-or-later
// PlacedScenes: rays through many placements of few meshes, each mesh kept once.
// Our own tree of boxes although Embree has instances: every mesh keeps its own scene, whose frame
// and scale spend single precision on the mesh alone. Split by surface area, and with the last
// blocker tried first, it chooses 400 lamps in a third to a half of the time that a tree of halves
// took.
#pragma once

#include "base/maths.h"
#include "ray/mesh_scene.h"

#include <functional>
#include <memory>
#include <vector>

namespace lodestone::ray {

/// Const methods may be called from any thread, once finish() has been called.
class PlacedScenes {
public:
    /// Adds a placement; `name` is what hits on it are called. A placement that cannot be inverted
    /// or is not finite is never hit.
    void add(std::shared_ptr<const MeshScene> scene, const Bound& bound, const Affine& world,
             uint32_t name);
    /// Sorts the placements into a tree of boxes.
    void finish();

    /// The first hit of a ray.
    struct PlacedHit {
        bool hit = false;
        uint32_t name = 0;
        uint32_t triangle = kNoTriangle;
        double u = 0;
        double v = 0;
        double t = std::numeric_limits<double>::infinity();  // point = origin + t direction
    };
    /// The nearest hit with 0 <= t <= far; the placement added first wins among equally near ones.
    PlacedHit first_hit(const glm::dvec3& origin, const glm::dvec3& direction,
                        double far = std::numeric_limits<double>::infinity()) const;
    /// Visits the placements whose boxes a ray meets within `far`, about near ones before far ones,
    /// with the ray in the frame of each. The visit returns how far the ray goes on.
    using VisitPlaced =
        std::function<double(const MeshScene& scene, uint32_t name, const glm::dvec3& origin,
                             const glm::dvec3& direction, double far)>;
    void visit(const glm::dvec3& origin, const glm::dvec3& direction, double far,
               const VisitPlaced& visit) const;
    /// Whether anything blocks the ray within `far`.
    bool occluded(const glm::dvec3& origin, const glm::dvec3& direction, double far) const;
    /// Whether anything blocks the ray; faster where `blocker` is the placement that blocked a ray
    /// beside this one: it is tried first, and becomes the one that blocks this ray. It changes no
    /// answer. kNothing: none is known.
    bool occluded(const glm::dvec3& origin, const glm::dvec3& direction, double far,
                  uint32_t& blocker) const;
    /// Law: the largest number of 32 bits; there are never so many placements.
    static constexpr uint32_t kNothing = ~uint32_t{0};

    /// The box around all placements, world frame.
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
        /// The first of placed_; inside the tree the second child: the first child comes right
        /// after the cell.
        uint32_t first = 0;
        uint32_t count = 0;  // 0: the cell has children
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
