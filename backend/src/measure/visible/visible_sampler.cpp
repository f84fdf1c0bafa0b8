// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/visible/visible_sampler.h"

#include "measure/visible/stratified_points.h"

#include <algorithm>
#include <cmath>

namespace lodestone::measure {
namespace {

/// Rays of the pilot, of each kind.
/// Taste: a larger value chooses better where both kinds cost about the same, and costs as many
/// rays.
constexpr uint32_t kPilotRays = 256;
// The cost of a ray that leaves the surface, over a line that is only asked whether it hits: the
// ray starts among things to hit.
// Taste: about the ratio of their times; a larger value prefers lines.
constexpr double kCostOfSurfaceRay = 2;
/// The cost of a line that also looks for the nearest points from both ends, over one that does
/// not.
/// Taste: about the ratio of their times; a larger value prefers rays from the surface.
constexpr double kCostOfLineWithPoints = 4;
/// The points of a line in a fixed number of rays, all of which have points.
/// Taste: between one and two; a larger value prefers lines.
constexpr double kPointsOfLine = 1.5;
/// The misses of a pilot up to which rays leave the surface without a pilot of lines.
/// Taste: a larger value spares more pilots where lines could be surer.
constexpr uint32_t kFewMisses = 2;
/// Triangles in one place that are told apart.
/// Taste: a larger value counts denser stacks of coincident surfaces right, and costs memory.
constexpr size_t kMostInOnePlace = 16;

/// Every point that a triangle uses and that is finite, once.
std::vector<glm::dvec3> used_points(const Mesh& mesh) {
    std::vector<uint8_t> used(mesh.positions.size(), 0);
    for (const Triangle& t : mesh.triangles)
        used[t.x] = used[t.y] = used[t.z] = 1;
    std::vector<glm::dvec3> points;
    points.reserve(mesh.positions.size());
    for (size_t i = 0; i < used.size(); ++i) {
        const glm::dvec3 point(mesh.positions[i]);
        if (used[i] != 0 && std::isfinite(point.x + point.y + point.z))
            points.push_back(point);
    }
    return points;
}

double radius_around(std::span<const glm::dvec3> points) {
    Box3 box;
    for (const glm::dvec3& point : points)
        box.add(point);
    double square = 0;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 arm = point - box.center();
        square = std::max(square, glm::dot(arm, arm));
    }
    return std::sqrt(square);
}

}  // namespace

double radius_of(const Mesh& mesh) {
    return radius_around(used_points(mesh));
}

VisibleSampler::VisibleSampler(const Mesh& mesh, const ray::MeshScene& scene, uint64_t seed,
                               CastMethod casting, double relative_error)
    : mesh_(&mesh), scene_(&scene), bound_({}, glm::dmat3(1.0), 0), numbers_(seed) {
    if (scene.triangles() != mesh.triangles.size())
        fail(Status::InvalidArgument, "a scene of ", scene.triangles(),
             " triangles does not hold a mesh of ", mesh.triangles.size());
    inertia_ = inertia_of_mesh(mesh);
    if (inertia_.empty())
        return;
    sides_ = sides_of(mesh, scene);
    std::vector<double> up_to(mesh.triangles.size());
    std::vector<double> covered_up_to(scene.see_through() ? up_to.size() : 0);
    double covered = 0;
    for (size_t i = 0; i < up_to.size(); ++i) {
        double part = (sides_.both(i) ? 1 : 0.5) * glm::length(area_vector(mesh, i));
        part = part > 0 && std::isfinite(part) ? part : 0;
        possible_area_ += part;
        up_to[i] = possible_area_;
        if (covered_up_to.empty())
            continue;
        covered += part * scene.uniform_alpha(static_cast<uint32_t>(i)).value_or(1);
        covered_up_to[i] = covered;
    }
    sides_area_ = AreaDraw(std::move(up_to));
    if (covered > 0 && covered < possible_area_)
        covers_.emplace(std::move(covered_up_to));
    const std::vector<glm::dvec3> points = used_points(mesh);
    lift_ = ray_lift(radius_around(points));
    from_surface_ = casting != CastMethod::FromBound;
    if (casting == CastMethod::FromSurface)
        return;
    PilotRays surface;
    if (casting == CastMethod::Best) {
        surface = pilot(seed);
        shows_all_ = sides_.hides_nothing && !covers_ && surface.hits == kPilotRays;
        if (surface.hits + kFewMisses >= kPilotRays)
            return;  // lines could hardly be surer
    }
    bound_ = ConvexBound(points, principal_variances(inertia_).axes, lift_);
    if (casting == CastMethod::Best && bound_.area() > 0) {
        from_surface_ = false;
        const PilotRays line = pilot(seed + 1);
        from_surface_ = is_surface_better(surface, line, relative_error);
    } else {
        from_surface_ = !(bound_.area() > 0);
    }
}

VisibleSampler::AreaDraw::AreaDraw(std::vector<double> area_up_to) : up_to_(std::move(area_up_to)) {
    const size_t count = up_to_.size();
    steps_.assign(count + 1, static_cast<std::ptrdiff_t>(count));
    size_t i = 0;
    for (size_t step = 0; step < count; ++step) {
        const double up_to = static_cast<double>(step) / static_cast<double>(count);
        while (i < count && up_to_[i] <= up_to * up_to_.back())
            ++i;
        steps_[step] = static_cast<std::ptrdiff_t>(i);
    }
}

size_t VisibleSampler::AreaDraw::at(double share, double& rest) const {
    const double target = share * up_to_.back();
    // The search is only near the step that it lies in: a step more on both sides, as rounding may
    // have it.
    const size_t last = steps_.size() - 1;
    const auto step = static_cast<size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(last));
    auto found = std::upper_bound(up_to_.begin() + steps_[std::max<size_t>(step, 1) - 1],
                                  up_to_.begin() + steps_[std::min(step + 2, last)], target);
    if (found == up_to_.end())
        found = std::lower_bound(up_to_.begin(), up_to_.end(), up_to_.back());
    const auto index = static_cast<size_t>(found - up_to_.begin());
    const double before = index == 0 ? 0 : up_to_[index - 1];
    rest = std::clamp((target - before) / (up_to_[index] - before), 0.0, 1.0);
    return index;
}

VisibleSampler::PilotRays VisibleSampler::pilot(uint64_t seed) {
    // These numbers are others than those of the measurement, which the choice must not depend on.
    const StratifiedPoints numbers(~seed, kPilotRays);
    PilotRays out;
    for (uint32_t i = 0; i < kPilotRays; i += 2) {
        const bool one = hits(numbers.point(i));
        const bool other = hits(numbers.point(i + 1));
        out.hits += (one ? 1 : 0) + (other ? 1 : 0);
        out.differ += one != other ? 1 : 0;
    }
    pilot_rays_ += kPilotRays;
    return out;
}

double VisibleSampler::PilotRays::rays_for(double relative_error) const {
    const double deviation = relative_error / 1.96;  // the standard deviation for a 95 % interval
    return kPilotRays * relative_variance() / (deviation * deviation);
}

bool VisibleSampler::is_surface_better(const PilotRays& surface, const PilotRays& line,
                                       double relative_error) {
    if (!(relative_error > 0))
        return kCostOfSurfaceRay * kPointsOfLine * surface.relative_variance() <
               kCostOfLineWithPoints * line.relative_variance();
    const double lines = line.rays_for(relative_error);
    const double with_points = std::min(lines, static_cast<double>(kMostLinesWithPoints));
    return kCostOfSurfaceRay * surface.rays_for(relative_error) <
           lines + (kCostOfLineWithPoints - 1) * with_points;
}

bool VisibleSampler::hits(const std::array<double, 4>& u) const {
    if (from_surface_)
        return reaches_infinity(drawn(starts(), u), u);
    const BoundRay line = bound_.entering_ray(u);
    return scene_->occluded(line.origin, line.direction);
}

int VisibleSampler::cast(const std::array<double, 4>& u,
                         std::array<VisiblePoint, 2>& points) const {
    if (!from_surface_)
        return cast_line(u, points);
    points[0] = drawn(starts(), u);
    return reaches_infinity(points[0], u) ? 1 : 0;
}

int VisibleSampler::cast_line(const std::array<double, 4>& u,
                              std::array<VisiblePoint, 2>& points) const {
    const BoundRay line = bound_.entering_ray(u);
    const ray::RayHit near = scene_->first_hit(line.origin, line.direction);
    if (!near.hit)
        return 0;
    points[0] = {near.point, near.triangle, -line.direction, near.u, near.v};
    // The same line is cast from its other end: past everything, looking back.
    const glm::dvec3 arm = near.point - line.origin;
    const double beyond = std::abs(glm::dot(arm, line.direction)) + 4e5 * lift_;
    const ray::RayHit far =
        scene_->first_hit(line.origin + beyond * line.direction, -line.direction);
    if (!far.hit)
        return 1;
    points[1] = {far.point, far.triangle, line.direction, far.u, far.v};
    return 2;
}

VisiblePoint VisibleSampler::on_surface(const std::array<double, 4>& u) const {
    return drawn(sides_area_, u);
}

VisiblePoint VisibleSampler::drawn(const AreaDraw& from, const std::array<double, 4>& u) const {
    double rest = 0;
    const size_t index = from.at(u[0], rest);
    glm::dvec3 normal = glm::normalize(area_vector(*mesh_, index));
    double across = u[1];
    if (sides_.of[index] == VisibleSide::Both) {
        // The choice of the side takes one bit, not of the number that runs along the triangles:
        // there the first points on each would all be on one side.
        normal = across < 0.5 ? normal : -normal;
        across = 2 * across - (across < 0.5 ? 0 : 1);
    } else if (sides_.of[index] == VisibleSide::Back) {
        normal = -normal;
    }
    const Triangle& t = mesh_->triangles[index];
    const glm::dvec3 a(mesh_->positions[t.x]);
    const glm::dvec2 weights = uniform_in_triangle(rest, across);
    const glm::dvec3 point = a + weights.x * (glm::dvec3(mesh_->positions[t.y]) - a) +
                             weights.y * (glm::dvec3(mesh_->positions[t.z]) - a);
    return {point, static_cast<uint32_t>(index), normal, weights.x, weights.y};
}

bool VisibleSampler::reaches_infinity(const VisiblePoint& from,
                                      const std::array<double, 4>& u) const {
    // A point that is drawn as often as it covers is there.
    return ((covers_ && scene_->uniform_alpha(from.triangle)) ||
            scene_->ends_ray(from.triangle, from.u, from.v)) &&
           !scene_->occluded(from.point + lift_ * from.seen_from,
                             cosine_direction(from.seen_from, u[2], u[3])) &&
           (!sides_.may_coincide || is_first(from));
}

bool VisibleSampler::is_first(const VisiblePoint& point) const {
    std::vector<ray::RayCrossing> others;
    scene_->list_crossings(
        point.point + lift_ * point.seen_from, -point.seen_from, 2 * lift_, kMostInOnePlace,
        [](uint32_t /*triangle*/, double /*alpha*/) { return false; }, others);
    for (const ray::RayCrossing& other : others) {
        if (other.triangle >= point.triangle)
            continue;
        const double along = glm::dot(area_vector(*mesh_, other.triangle), point.seen_from);
        const VisibleSide side = sides_.of[other.triangle];
        if (side == VisibleSide::Both || (side == VisibleSide::Front ? along > 0 : along < 0))
            return false;
    }
    return true;
}

glm::dvec3 VisibleSampler::towards_eye(uint32_t ray, const VisiblePoint& point) const {
    if (!from_surface_)
        return point.seen_from;
    const std::array<double, 4> u = numbers_.point(ray);
    return cosine_direction(point.seen_from, u[2], u[3]);
}

}  // namespace lodestone::measure
