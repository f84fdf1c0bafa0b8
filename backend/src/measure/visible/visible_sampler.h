// SPDX-License-Identifier: GPL-3.0-or-later
// VisibleSampler: points of a mesh drawn in proportion to how visible they are from outside.
#pragma once

#include "measure/visible/convex_bound.h"
#include "measure/visible/outside_sides.h"
#include "measure/visible/sobol_points.h"
#include "measure/visible/surface_inertia.h"
#include "ray/mesh_scene.h"

#include <optional>
#include <vector>

namespace lodestone::measure {

/// A point of the mesh that a ray from outside hit.
struct VisiblePoint {
    glm::dvec3 point{0.0};
    uint32_t triangle = 0;
    glm::dvec3 seen_from{0.0};  // unit direction towards the viewer
    double u = 0;               // where on the triangle, like ray::RayHit
    double v = 0;
};

/// The points that one ray found: 0...2, all with equal weight.
struct CastPoints {
    std::array<VisiblePoint, 2> points;
    int count = 0;
};

/// The kind of rays that a VisibleSampler casts: those that a pilot of both found to be surer for
/// their cost, or for checks always the same ones.
enum class CastMethod : uint8_t { Best, FromBound, FromSurface };

/// The sampler draws visible points by one of two kinds of rays: lines that cross a tight convex
/// bound (dense things: a book), or rays that leave the surface (sparse things: a flock). Where
/// surfaces of several triangles lie in one place and face the same way, the first of these
/// triangles has the points. A surface that is as clear everywhere is left by rays as often as it
/// covers what is behind it, and these count fully. The points of a ray depend on its four numbers
/// alone. The mesh and the scene must outlive the sampler. Const methods may be called from any
/// thread.
class VisibleSampler {
public:
    /// `scene` must hold `mesh`, else Error(InvalidArgument). The better casting is chosen for an
    /// area that is to be known to `relative_error`; 0: for a number of rays, all with points.
    VisibleSampler(const Mesh& mesh, const ray::MeshScene& scene, uint64_t seed,
                   CastMethod casting = CastMethod::Best, double relative_error = 0);

    /// True when the mesh has no area: then nothing may be cast.
    bool empty() const { return !(possible_area_ > 0); }
    /// The area of all sides that could be seen, m^2: of closed parts one side, of open ones both;
    /// transparent parts count.
    double possible_area() const { return possible_area_; }
    /// The area (m^2) that the share of hits refers to: visible area (4.6) = reference_area() *
    /// rays that hit / rays cast.
    double reference_area() const { return from_surface_ ? starts().area() : bound_.area(); }
    /// Whether rays leave the surface: then a ray that hits has one point, else mostly two.
    bool from_surface() const { return from_surface_; }
    /// Whether nothing hides anything, so that all of possible_area() is visible.
    bool shows_all() const { return shows_all_; }
    /// The sides of the mesh that can be seen.
    const OutsideSides& sides() const { return sides_; }
    /// The inertia of the mesh by traversal, one side of everything.
    const SurfaceInertia& inertia() const { return inertia_; }
    /// The number of rays that the choice between the two kinds has cost.
    uint64_t pilot_rays() const { return pilot_rays_; }

    /// Casts the ray of four numbers in [0, 1); returns how many points it found.
    int cast(const std::array<double, 4>& u, std::array<VisiblePoint, 2>& points) const;
    /// Casts ray number `ray` of an even sequence; returns how many points it found.
    int cast(uint32_t ray, std::array<VisiblePoint, 2>& points) const {
        return cast(numbers_.point(ray), points);
    }
    /// The unit direction to the eye of a point that cast() found with the ray of that number.
    glm::dvec3 towards_eye(uint32_t ray, const VisiblePoint& point) const;
    /// Whether cast() would find any point; faster.
    bool hits(const std::array<double, 4>& u) const;
    bool hits(uint32_t ray) const { return hits(numbers_.point(ray)); }
    /// A point uniform in possible_area(), seen or not.
    VisiblePoint on_surface(const std::array<double, 4>& u) const;
    VisiblePoint on_surface(uint32_t ray) const { return on_surface(numbers_.point(ray)); }

private:
    /// Triangles, drawn in proportion to some area of each.
    class AreaDraw {
    public:
        AreaDraw() = default;
        explicit AreaDraw(std::vector<double> area_up_to);
        double area() const { return up_to_.empty() ? 0 : up_to_.back(); }
        /// The triangle at that share of all area; `rest` is how far in it, 0...1.
        size_t at(double share, double& rest) const;

    private:
        std::vector<double> up_to_;          // area of each triangle and all before
        std::vector<std::ptrdiff_t> steps_;  // the triangle at even steps of that area
    };

    /// The triangles that rays from the surface leave.
    const AreaDraw& starts() const { return covers_ ? *covers_ : sides_area_; }
    VisiblePoint drawn(const AreaDraw& from, const std::array<double, 4>& u) const;
    int cast_line(const std::array<double, 4>& u, std::array<VisiblePoint, 2>& points) const;
    bool reaches_infinity(const VisiblePoint& from, const std::array<double, 4>& u) const;
    bool is_first(const VisiblePoint& point) const;

    /// The counts of a pilot of one kind of rays.
    struct PilotRays {
        uint32_t hits = 0;
        uint32_t differ = 0;  // pairs of which one ray hits
        /// The variance of the estimated area, over its square. Two is added to the pairs that
        /// differ: a pilot in which no pair differs does not know that none does.
        double relative_variance() const {
            const double h = hits + 1.0;
            return (differ + 2.0) / (h * h);
        }
        /// The number of rays that make the estimate about as sure as `relative_error`.
        double rays_for(double relative_error) const;
    };
    PilotRays pilot(uint64_t seed);
    static bool is_surface_better(const PilotRays& surface, const PilotRays& line,
                                  double relative_error);

    const Mesh* mesh_;
    const ray::MeshScene* scene_;
    SurfaceInertia inertia_;
    OutsideSides sides_;
    double possible_area_ = 0;
    double lift_ = 0;
    ConvexBound bound_;
    AreaDraw sides_area_;             // sides that could be seen
    std::optional<AreaDraw> covers_;  // the same areas times the alpha, where some of it is clear
    bool from_surface_ = false;
    bool shows_all_ = false;
    uint64_t pilot_rays_ = 0;
    SobolPoints numbers_;
};

/// The radius of the mesh's bounding sphere in metres, over finite vertices that a triangle uses; 0
/// without any.
double radius_of(const Mesh& mesh);

/// Where the area is wanted, only so many lines look for their points: they know centroid, tensor
/// and colors to a percent or two. Rays from the surface have their points anyway.
/// Taste: a larger value knows the centroid better and costs four lines without points each.
inline constexpr uint64_t kMostLinesWithPoints = 2048;

/// The distance in metres from a surface at which its rays start. The factor is well above the
/// rounding of single precision, and well below anything visible.
inline double ray_lift(double radius) {
    return 1e-5 * radius;
}

}  // namespace lodestone::measure
