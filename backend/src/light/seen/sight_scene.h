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

/// A straight part of a ray's way through a sight scene.
struct SightWalk {
    glm::dvec3 origin{0.0};          // world
    glm::dvec3 direction{0, 0, -1};  // has length 1
    double far = kInfinity;          // metres
    RayMask sees = kCameraRays;      // the class of the ray
    double way = 0;                  // metres from the ray's beginning to `origin`
};

/// A place where a ray meets something that is there.
struct SightCrossing {
    uint32_t drawn = 0;
    uint32_t triangle = 0;
    double u = 0;
    double v = 0;
    glm::dvec3 point{0.0};
    double way = 0;        // metres from the ray's beginning
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

    /// Finds what a walk meets, near things first, up to the first that ends it; masks and clear
    /// things let as many rays pass as they hide nothing of. Behind very many surfaces nothing
    /// shows, and nothing is found. `out` is emptied first.
    void cross(const SightWalk& walk, std::vector<SightCrossing>& out) const;

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

private:
    struct SightShape {
        std::shared_ptr<const Mesh> mesh;
        std::shared_ptr<const ray::MeshScene> scene;
        ray::SkinPtr skin;  // null: all of it is opaque
    };
    SightShape shape_of(const DrawnThing& thing);
    /// The material of a triangle; beyond all materials: it has none.
    size_t material_of(uint32_t drawn, uint32_t triangle) const;
    bool transmits(uint32_t drawn, uint32_t triangle) const;

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
