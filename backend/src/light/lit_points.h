// SPDX-License-Identifier: GPL-3.0-or-later
// Lit points: the visible surfaces of a scene in a view, as points with the light they send back.
#pragma once

#include "base/random.h"
#include "light/light_cut.h"
#include "light/light_plan.h"
#include "light/seen/sight_ray.h"
#include "ray/placed_scenes.h"

namespace lodestone::light {

/// Points in a grid over a picture, row by row; those of one cell lie one behind the other.
struct LitGrid {
    size_t rows = 0;
    size_t columns = 0;
    std::vector<uint32_t> first;  // the first point of each cell; one more at the end
    std::vector<LitPoint> points;
};

/// A cell and the cells that touch it, rising.
std::vector<size_t> around(const LitGrid& grid, size_t row, size_t column);

/// The distance within which other points count as beside this point.
double reach_beside(const View& view, const LitGrid& grid, const LitPoint& point);

/// The drawn things, ready for rays. Rays of a class do not meet things hidden from it.
class LitScene {
public:
    /// Throws Error(RaysUnavailable); all drawn things must be resident and outlive the scene.
    LitScene(const Model& model, const RendererSurfaces& renderer,
             std::span<const DrawnThing> drawn, const Job& job);

    /// Whether there are more distinct triangles than rays are cast at: each takes memory and time
    /// before the first ray.
    static bool too_large(std::span<const DrawnThing> drawn);

    /// About `count` cells, with a ray through each; `region` of a point is the index of the drawn
    /// thing. `bounces`: further points from where the ray ends, each where light may come from.
    LitGrid points(const View& view, size_t count, int bounces, const Job& job) const;
    /// The points at a place of the picture (0...1 from its left, top), nearest first.
    std::vector<LitPoint> seen(const View& view, double x, double y) const {
        return followed(sight_ray(view, x, y));
    }

    /// The points at which so many rays end that leave a drawn thing all over it, weighted by the
    /// cosine; fewer where some meet nothing.
    std::vector<LitPoint> surroundings(uint32_t drawn, int rays, PcgRandom& random) const;

    /// Sets the light that points get besides lamps: of a uniform sky, as far as they see it where
    /// it is shaded, and of suns where nothing hides them (what is partly clear hides them
    /// where it hides more than half).
    void add_other_light(const LightDemands& demands, std::span<LitPoint> points,
                         const Job& job) const;

    /// The share of the sky that a point sees, weighted by the cosine, by few rays: rather less.
    double sky_share(const LitPoint& point, size_t number) const;
    /// The share of a light that reaches a point; see-through surfaces hide nothing. `blocker`: see
    /// Reaches.
    double reaches(const Light& light, const LitPoint& point, uint32_t& blocker) const;
    /// Whether a part of a light, but not all of it, reaches a point, by a few rays.
    bool soft(const Light& light, const LitPoint& point) const;
    /// The distance of what hides a part of a sun from a point, the farthest of it, by a few rays;
    /// 0 where all of the sun is hidden, or nothing.
    double penumbra_from(const Light& sun, const LitPoint& point) const;
    /// Whether any part of a drawn thing is see-through.
    bool partly_clear(uint32_t drawn) const {
        const SceneShape& shape = shapes_[shape_of_[drawn]];
        return shape.opaque != shape.all;
    }
    /// Whether nothing hides one point from another, ends excepted.
    bool clear(const glm::dvec3& from, const glm::dvec3& to) const;

private:
    struct SceneShape {
        std::shared_ptr<const Mesh> mesh;
        std::shared_ptr<const ray::MeshScene> all;
        /// The opaque part; null: nothing is opaque; the same as `all` where everything is.
        std::shared_ptr<const ray::MeshScene> opaque;
        /// All of it; what is partly clear lets rays through where it hides less than half.
        std::shared_ptr<const ray::MeshScene> dimming;
    };
    struct LitSurface {
        SurfaceReflection reflection;
        bool see_through = false;
    };
    /// Whether nothing hides a place of a lamp from a point.
    bool free(const LitPoint& point, const glm::dvec3& place, uint32_t& blocker) const;
    LitSurface surface_of(const DrawnThing& lit, uint16_t slot) const;
    SceneShape shape_of(const DrawnThing& lit);
    std::vector<LitPoint> followed(SightRay ray) const;
    /// A ray that leaves a matt surface by chance.
    static SightRay sent_on(const glm::dvec3& from, const glm::dvec3& normal, PcgRandom& random);
    void bounce(int times, PcgRandom& random, std::vector<LitPoint>& out) const;

    const Model& model_;
    std::span<const DrawnThing> drawn_;
    std::vector<uint32_t> shape_of_;  // by drawn thing
    std::vector<SceneShape> shapes_;
    std::vector<LitSurface> surfaces_;  // by material, and one more for things without material
    ray::PlacedScenes seen_;
    ray::PlacedScenes blocking_;
    ray::PlacedScenes dimming_;  // blocking_, and what is partly clear
    std::shared_ptr<image::TexelCache> texels_;
    double tolerance_ = 0;
    double least_ = 0;  // no ray begins nearer than this to the surface it leaves
};

}  // namespace lodestone::light
