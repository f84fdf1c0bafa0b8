// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/visible_sampler.h"

#include "measure/surface_inertia.h"

#include <algorithm>
#include <cmath>

namespace lodestone::measure {
namespace {

constexpr uint32_t kPilotRays = 256;
/// A line that hits gives two points, a ray from the surface one; and surfaces that touch or cross
/// others are seen a little too well from themselves. So rays from the surface must be this much
/// better.
constexpr double kSurfaceMustBe = 0.5;

/// The lowest element of the set that `i` is in.
uint32_t root(std::vector<uint32_t>& parent, uint32_t i) {
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

/// Every point some triangle with finite corners uses, once.
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

/// Variance of an estimate from m of n hits, relative to its square and per ray. Two hits and two
/// misses are added: a pilot that saw only one kind knows nothing about the other.
double relative_variance(double hits, double rays) {
    const double p = (hits + 2) / (rays + 4);
    return (1 - p) / p;
}

}  // namespace

Sides sides_of(const Mesh& mesh, const ray::Scene& scene) {
    Sides out;
    out.open = scene.see_through() || !closed(mesh);
    if (out.open)
        return out;
    const std::vector<uint32_t> welded = weld(mesh);
    std::vector<uint32_t> parent(mesh.positions.size());
    for (size_t i = 0; i < parent.size(); ++i)
        parent[i] = static_cast<uint32_t>(i);
    for (const Triangle& t : mesh.triangles) {
        for (int corner = 1; corner < 3; ++corner) {
            const uint32_t a = root(parent, welded[t[0]]);
            const uint32_t b = root(parent, welded[t[corner]]);
            parent[std::max(a, b)] = std::min(a, b);
        }
    }
    // Six times the volume of each part, about one of its own points: digits far from the origin.
    std::vector<double> volume(mesh.positions.size(), 0);
    for (const Triangle& t : mesh.triangles) {
        const uint32_t part = root(parent, welded[t.x]);
        const glm::dvec3 origin(mesh.positions[part]);
        const glm::dvec3 a = glm::dvec3(mesh.positions[t.x]) - origin;
        const glm::dvec3 b = glm::dvec3(mesh.positions[t.y]) - origin;
        const glm::dvec3 c = glm::dvec3(mesh.positions[t.z]) - origin;
        volume[part] += glm::dot(a, glm::cross(b, c));
    }
    out.turned.resize(mesh.triangles.size());
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        out.turned[i] = volume[root(parent, welded[mesh.triangles[i].x])] < 0;
    return out;
}

double radius_of(const Mesh& mesh) {
    return radius_around(used_points(mesh));
}

VisibleSampler::VisibleSampler(const Mesh& mesh, const ray::Scene& scene, uint64_t seed)
    : mesh_(&mesh), scene_(&scene), bound_({}, glm::dmat3(1.0), 0), numbers_(seed) {
    if (scene.triangles() != mesh.triangles.size())
        fail(Status::InvalidArgument, "a scene of ", scene.triangles(),
             " triangles does not hold a mesh of ", mesh.triangles.size());
    const SurfaceInertia inertia = of_mesh(mesh);
    if (inertia.empty())
        return;
    sides_ = sides_of(mesh, scene);
    possible_area_ = inertia.area * (sides_.open ? 2 : 1);
    const std::vector<glm::dvec3> points = used_points(mesh);
    lift_ = ray_lift(radius_around(points));
    bound_ = ConvexBound(points, principal_variances(inertia).axes, lift_);
    area_up_to_.resize(mesh.triangles.size());
    double area = 0;
    for (size_t i = 0; i < area_up_to_.size(); ++i) {
        const double part = 0.5 * glm::length(area_vector(mesh, i));
        area += part > 0 && std::isfinite(part) ? part : 0;
        area_up_to_[i] = area;
    }
    from_surface_ = prefers_surface(seed);
}

bool VisibleSampler::prefers_surface(uint64_t seed) const {
    if (!(bound_.area() > 0))
        return true;
    // Other numbers than those of the measurement, which the choice must not depend on.
    const Sobol numbers(scramble(seed) ^ 1u);
    int from_bound = 0;
    int from_surface = 0;
    std::array<VisiblePoint, 2> points;
    for (uint32_t i = 0; i < kPilotRays; ++i) {
        const std::array<double, 4> u = numbers.point(i);
        from_bound += cast_line(u, points) > 0 ? 1 : 0;
        from_surface += cast_from_surface(u, points) > 0 ? 1 : 0;
    }
    return relative_variance(from_surface, kPilotRays) <
           kSurfaceMustBe * relative_variance(from_bound, kPilotRays);
}

int VisibleSampler::cast(uint32_t ray, std::array<VisiblePoint, 2>& points) const {
    const std::array<double, 4> u = numbers_.point(ray);
    return from_surface_ ? cast_from_surface(u, points) : cast_line(u, points);
}

int VisibleSampler::cast_line(const std::array<double, 4>& u,
                              std::array<VisiblePoint, 2>& points) const {
    const Ray line = bound_.enter(u);
    const ray::Hit near = scene_->first_hit(line.origin, line.direction);
    if (!near.hit)
        return 0;
    points[0] = {near.point, near.triangle, -line.direction, near.u, near.v};
    // The same line from its other end: past everything, looking back.
    const glm::dvec3 arm = near.point - line.origin;
    const double beyond = std::abs(glm::dot(arm, line.direction)) + 4e5 * lift_;
    const ray::Hit far = scene_->first_hit(line.origin + beyond * line.direction, -line.direction);
    if (!far.hit)
        return 1;
    points[1] = {far.point, far.triangle, line.direction, far.u, far.v};
    return 2;
}

int VisibleSampler::cast_from_surface(const std::array<double, 4>& u,
                                      std::array<VisiblePoint, 2>& points) const {
    const double target = u[0] * area_up_to_.back();
    auto found = std::upper_bound(area_up_to_.begin(), area_up_to_.end(), target);
    if (found == area_up_to_.end())
        found = std::lower_bound(area_up_to_.begin(), area_up_to_.end(), area_up_to_.back());
    const auto index = static_cast<size_t>(found - area_up_to_.begin());
    const double before = index == 0 ? 0 : area_up_to_[index - 1];
    double rest = std::clamp((target - before) / (area_up_to_[index] - before), 0.0, 1.0);
    glm::dvec3 normal = glm::normalize(area_vector(*mesh_, index));
    if (sides_.open) {
        // The choice of the side takes one more bit from the same number.
        if (rest >= 0.5) {
            normal = -normal;
            rest = 2 * rest - 1;
        } else {
            rest = 2 * rest;
        }
    } else if (sides_.turned[index] != 0) {
        normal = -normal;
    }
    const Triangle& t = mesh_->triangles[index];
    const glm::dvec3 a(mesh_->positions[t.x]);
    const glm::dvec2 weights = uniform_in_triangle(rest, u[1]);
    if (!scene_->stops(static_cast<uint32_t>(index), weights.x, weights.y))
        return 0;
    const glm::dvec3 point = a + weights.x * (glm::dvec3(mesh_->positions[t.y]) - a) +
                             weights.y * (glm::dvec3(mesh_->positions[t.z]) - a);
    if (scene_->occluded(point + lift_ * normal, cosine_direction(normal, u[2], u[3])))
        return 0;
    points[0] = {point, static_cast<uint32_t>(index), normal, weights.x, weights.y};
    return 1;
}

}  // namespace lodestone::measure
