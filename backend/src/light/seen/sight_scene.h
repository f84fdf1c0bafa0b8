// SPDX-License-Identifier: GPL-3.0-or-later
// Sight scene: drawn things, ready for rays that go on through what is clear.
#pragma once

#include "light/light_plan.h"
#include "light/seen/sight_ray.h"
#include "ray/placed_scenes.h"

#include <memory>
#include <span>
#include <vector>

namespace lodestone::light {

/// A ray on its way through a sight scene.
struct SightWalk {
    glm::dvec3 origin{0.0};          // world
    glm::dvec3 direction{0, 0, -1};  // has length 1
    double far = kInfinity;          // metres that are left of the way
    RayMask sees = kCameraRays;      // the class of the ray
    double way = 0;                  // metres from its beginning to `origin`
    int steps = 0;                   // the surfaces that it has met, clear ones too
    /// The triangle that it met last, which it may meet again where it goes on.
    uint32_t last_drawn = ray::kNoTriangle;
    uint32_t last_triangle = ray::kNoTriangle;
};

/// A place where a ray meets something that is there.
struct SightCrossing {
    uint32_t drawn = 0;
    uint32_t triangle = 0;
    double u = 0;
    double v = 0;
    glm::dvec3 point{0.0};
    double way = 0;        // metres from the beginning of the walk
    bool ends = true;      // no ray goes on straight ahead, as one of a shadow does in glass
    bool mirrors = false;  // some rays may go on mirrored
    bool bends = false;    // rays go on in directions that only the renderer knows
};

/// The drawn things. A mesh is made ready once for all its placements. Const methods may be called
/// from any thread.
class SightScene {
public:
    /// Throws Error(RaysUnavailable), Error(BadFile), Error(Cancelled). All drawn things must be resident and
    /// outlive the scene.
    SightScene(const Model& model, const RendererSurfaces& renderer,
               std::span<const DrawnThing> drawn, const Job& job);

    /// Moves a walk to the next thing that is there for it: masks and clear things let as many rays
    /// pass as they hide nothing of, and after the others it goes on behind them. False: there is none, or the ray has
    /// met so many surfaces that what is behind does not show.
    bool step(SightWalk& walk, SightCrossing& out) const;

    /// The triangles of a drawn thing.
    const Mesh& mesh(uint32_t drawn) const { return *shapes_[shape_of_[drawn]].mesh; }
    /// The number of a drawn thing's mesh, below shapes().
    uint32_t shape(uint32_t drawn) const { return shape_of_[drawn]; }
    size_t shapes() const { return shapes_.size(); }
    const Mesh& mesh_of_shape(size_t shape) const { return *shapes_[shape].mesh; }
    /// The distance from a point, `way` metres from where its ray began, at which the next ray begins.
    double aside(double way) const { return std::max(least_, kRelative * way); }

    /// The share of a way by which a ray begins above what it leaves.
    /// Law: positions are known to 1e-7 of it; this is a large margin.
    static constexpr double kRelative = 1e-5;
    /// The same behind what it went through: layers lie close to each other.
    /// Law: a tenth, just above what positions are known to.
    static constexpr double kBehind = 0.1;

private:
    struct SightShape {
        std::shared_ptr<const Mesh> mesh;
        std::shared_ptr<const ray::MeshScene> scene;
        ray::SkinPtr skin;  // null: all of it is opaque
    };
    SightShape shape_of(const DrawnThing& thing);

    const Model& model_;
    const RendererSurfaces& renderer_;
    std::span<const DrawnThing> drawn_;
    std::vector<uint32_t> shape_of_;  // by drawn thing
    std::vector<SightShape> shapes_;
    std::vector<uint8_t> bends_;      // by material
    std::vector<uint8_t> transmits_;  // by material
    ray::PlacedScenes seen_;
    ray::PlacedScenes shading_;
    double least_ = 0;
};

}  // namespace lodestone::light
