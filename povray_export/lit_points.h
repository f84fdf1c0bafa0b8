// SPDX-License-Identifier: GPL-3.0-or-later
// Lit points: what a view shows of a scene, as points with what they send back.
#pragma once

#include "povray_export/light_plan.h"
#include "quality/light_cut.h"
#include "ray/placed_scenes.h"

namespace lodestone::povray {

/// The drawn things, ready for rays. Things hidden from a class of rays are not met by it.
class LitScene {
public:
    /// Throws Error(RaysUnavailable); needs what is drawn to be resident, and to outlive it.
    LitScene(const Model& model, std::span<const Lit> drawn, const Job& job);

    /// About `count` points, evenly over the picture; `region` is the index of the drawn thing.
    std::vector<quality::LitPoint> points(const View& view, size_t count, const Job& job) const;

    /// Share of a light that reaches a point; what is see-through hides nothing.
    /// `blocker`: see quality::Reaches.
    double reaches(const Light& light, const quality::LitPoint& point, uint32_t& blocker) const;
    /// Whether any of a drawn thing is.
    bool partly_clear(uint32_t drawn) const {
        const Shape& shape = shapes_[shape_of_[drawn]];
        return shape.opaque != shape.all;
    }
    /// Whether nothing hides one point from another, ends excepted.
    bool clear(const glm::dvec3& from, const glm::dvec3& to) const;

private:
    struct Shape {
        std::shared_ptr<const Mesh> mesh;
        std::shared_ptr<const ray::Scene> all;
        std::shared_ptr<const ray::Scene> opaque;  // null: nothing is; the same where everything is
    };
    struct Surface {
        glm::dvec3 albedo{0.8};
        double gloss = 0;
        double exponent = 1;
        bool mirror = false;
        bool see_through = false;
    };
    struct Ray {
        glm::dvec3 origin;
        glm::dvec3 direction;
        double z = 0;  // the way to its origin
    };

    Surface surface_of(const Lit& lit, uint16_t slot) const;
    Shape shape_of(const Lit& lit) const;
    void follow(Ray ray, std::vector<quality::LitPoint>& out) const;

    const Model& model_;
    std::span<const Lit> drawn_;
    std::vector<uint32_t> shape_of_;  // by drawn thing
    std::vector<Shape> shapes_;
    std::vector<Surface> surfaces_;  // by material, and one for none
    ray::PlacedScenes seen_;
    ray::PlacedScenes blocking_;
    double least_ = 0;  // no ray begins nearer than this to what it leaves
};

}  // namespace lodestone::povray
