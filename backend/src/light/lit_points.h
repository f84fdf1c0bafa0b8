// SPDX-License-Identifier: GPL-3.0-or-later
// Lit points: what a view shows of a scene, as points with what they send back.
#pragma once

#include "base/random.h"
#include "light/light_cut.h"
#include "light/light_plan.h"
#include "ray/placed_scenes.h"

namespace lodestone::light {

/// Points in a grid over a picture, row by row; those of one cell lie one behind the other.
struct LitGrid {
    size_t rows = 0;
    size_t columns = 0;
    std::vector<uint32_t> first;  // point of each cell; one more at the end
    std::vector<LitPoint> points;
};

/// A cell and those that touch it, rising.
std::vector<size_t> around(const LitGrid& grid, size_t row, size_t column);

/// How far from a point those are that count as beside it.
double reach_beside(const View& view, const LitGrid& grid, const LitPoint& point);

/// The drawn things, ready for rays. Things hidden from a class of rays are not met by it.
class LitScene {
public:
    /// Throws Error(RaysUnavailable); needs what is drawn to be resident, and to outlive it.
    LitScene(const Model& model, const RendererSurfaces& renderer,
             std::span<const DrawnThing> drawn, const Job& job);

    /// About `count` cells, a ray through each; `region` of a point is the index of the drawn
    /// thing. `bounces`: then from where it ends on, each where light may come from.
    LitGrid points(const View& view, size_t count, int bounces, const Job& job) const;
    /// What is seen at a place of the picture (0...1 from its left, top), nearest first.
    std::vector<LitPoint> seen(const View& view, double x, double y) const {
        return followed(ray_at(view, x, y));
    }

    /// Share of a light that reaches a point; what is see-through hides nothing.
    /// `blocker`: see Reaches.
    double reaches(const Light& light, const LitPoint& point, uint32_t& blocker) const;
    /// Whether any of a drawn thing is.
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
        std::shared_ptr<const ray::MeshScene>
            opaque;  // null: nothing is; the same where everything is
    };
    struct LitSurface {
        SurfaceReflection reflection;
        bool see_through = false;
    };
    struct SightRay {
        glm::dvec3 origin;
        glm::dvec3 direction;
        double z = 0;  // the way to its origin
    };

    LitSurface surface_of(const DrawnThing& lit, uint16_t slot) const;
    SceneShape shape_of(const DrawnThing& lit) const;
    static SightRay ray_at(const View& view, double x, double y);
    std::vector<LitPoint> followed(SightRay ray) const;
    void bounce(int times, PcgRandom& random, std::vector<LitPoint>& out) const;

    const Model& model_;
    std::span<const DrawnThing> drawn_;
    std::vector<uint32_t> shape_of_;  // by drawn thing
    std::vector<SceneShape> shapes_;
    std::vector<LitSurface> surfaces_;  // by material, and one for none
    ray::PlacedScenes seen_;
    ray::PlacedScenes blocking_;
    double tolerance_ = 0;
    double least_ = 0;  // no ray begins nearer than this to what it leaves
};

}  // namespace lodestone::light
