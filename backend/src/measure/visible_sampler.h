// SPDX-License-Identifier: GPL-3.0-or-later
// VisibleSampler: points of a mesh drawn in proportion to how visible they are from outside.
#pragma once

#include "measure/convex_bound.h"
#include "measure/sobol.h"
#include "ray/scene.h"

namespace lodestone::measure {

/// Which sides of a mesh's triangles can be seen from outside at all.
struct Sides {
    bool open = true;             // both sides of every triangle
    std::vector<uint8_t> turned;  // closed: 1 where the outer side is not the one its corners say
};
/// A mesh that is closed() has one side, per connected part the one away from its volume; one that
/// rays pass through is open.
Sides sides_of(const Mesh& mesh, const ray::Scene& scene);

/// A point of the mesh that a ray from outside hit.
struct VisiblePoint {
    glm::dvec3 point{0.0};
    uint32_t triangle = 0;
    glm::dvec3 seen_from{0.0};  // direction towards whoever sees it, any length
    double u = 0;               // where on the triangle, as ray::Hit
    double v = 0;
};

/// Draws visible points by one of two kinds of rays, whichever hits more surely on this mesh:
/// lines that cross a tight convex bound (dense things: a book), or rays that leave the surface
/// (sparse things: a flock). Every ray has a number; what it finds depends on nothing else. The
/// mesh and the scene must outlive the sampler. Const methods may be called from any thread.
class VisibleSampler {
public:
    /// `scene` must hold `mesh`, else Error(InvalidArgument).
    VisibleSampler(const Mesh& mesh, const ray::Scene& scene, uint64_t seed);

    /// True when the mesh has no area: then nothing may be cast.
    bool empty() const { return !(possible_area_ > 0); }
    /// Area of all sides that could be seen: the mesh's, twice that when it is open; what is
    /// transparent counts.
    double possible_area() const { return possible_area_; }
    /// Visible area (4.6) = reference_area() * rays that hit / rays cast.
    double reference_area() const { return from_surface_ ? possible_area_ : bound_.area(); }
    /// Whether rays leave the surface: then a ray that hits has one point, else mostly two.
    bool from_surface() const { return from_surface_; }
    const Sides& sides() const { return sides_; }

    /// Casts ray number `ray`: 0...2 visible points, all with equal weight.
    int cast(uint32_t ray, std::array<VisiblePoint, 2>& points) const;

private:
    int cast_line(const std::array<double, 4>& u, std::array<VisiblePoint, 2>& points) const;
    int cast_from_surface(const std::array<double, 4>& u,
                          std::array<VisiblePoint, 2>& points) const;
    bool prefers_surface(uint64_t seed) const;

    const Mesh* mesh_;
    const ray::Scene* scene_;
    Sides sides_;
    double possible_area_ = 0;
    double lift_ = 0;
    ConvexBound bound_;
    std::vector<double> area_up_to_;  // of each triangle and all before
    bool from_surface_ = false;
    Sobol numbers_;
};

/// Radius of the mesh's bounding sphere, of finite vertices that a triangle uses; 0 without any.
double radius_of(const Mesh& mesh);

/// How far off a surface its rays start: well above the rounding of single precision, well below
/// anything visible.
inline double ray_lift(double radius) {
    return 1e-5 * radius;
}

}  // namespace lodestone::measure
