// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/visible/seen_from_outside.h"

#include "base/parallel.h"
#include "measure/visible/convex_bound.h"
#include "measure/visible/sobol_points.h"
#include "measure/visible/visible_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>

namespace lodestone::measure {
namespace {

/// The rays of a large triangle, over those of a mean one, at most.
/// Taste: a larger value finds large triangles that are seen through narrower gaps, for more rays.
constexpr double kMostRaysTimes = 64;
/// The rays from a side of a triangle beside one that is seen. What lies in an opening sees little
/// of the sky, and is all that an eye in the opening sees.
/// Taste: a larger value finds what is seen through narrower openings (of triangles that see 4 % of
/// the sky one in four is missed, if none beside it is found), for more rays at the edges of the
/// dark.
constexpr int kRaysBesideSeen = 32;

/// The rays that leave the triangles of a mesh.
class LeavingRays {
public:
    LeavingRays(const Mesh& mesh, const ray::MeshScene& scene, const OutsideSides& sides,
                uint64_t seed)
        : mesh_(mesh), scene_(scene), sides_(sides), seed_(seed), lift_(ray_lift(radius_of(mesh))) {
        for (size_t i = 0; i < mesh.triangles.size(); ++i)
            mean_ += glm::length(area_vector(mesh, i)) / static_cast<double>(mesh.triangles.size());
    }

    /// A board of two triangles is as large as the thousand tiles on it, and seen between them.
    int of(size_t index, int of_mean) const {
        const double area = glm::length(area_vector(mesh_, index));
        const double share = area > mean_ ? std::min(area / mean_, kMostRaysTimes) : 1;
        return static_cast<int>(std::ceil(share * of_mean));
    }

    /// The sides of a triangle from which rays leave.
    int sides(size_t index) const { return sides_.both(index) ? 2 : 1; }

    /// Whether one of the rays first ... end - 1 of a triangle reaches infinity.
    bool any_gets_out(size_t index, int first, int end, ray::RecentBlockers& blockers) const {
        const glm::dvec3 area = area_vector(mesh_, index);
        const double length = glm::length(area);
        if (!(length > 0))
            return true;
        const glm::dvec3 normal = area / length;
        const Triangle& t = mesh_.triangles[index];
        const glm::dvec3 a(mesh_.positions[t.x]);
        const glm::dvec3 ab = glm::dvec3(mesh_.positions[t.y]) - a;
        const glm::dvec3 ac = glm::dvec3(mesh_.positions[t.z]) - a;
        const SobolPoints points(scramble(seed_) + index);
        const auto step = static_cast<int>(sides(index));
        for (int i = first; i < end; ++i) {
            const bool back = step > 1 ? i % step != 0 : sides_.of[index] == VisibleSide::Back;
            const glm::dvec3 outward = back ? -normal : normal;
            const std::array<double, 4> u = points.point(static_cast<uint32_t>(i / step));
            const glm::dvec2 weights = uniform_in_triangle(u[0], u[1]);
            const glm::dvec3 origin = a + weights.x * ab + weights.y * ac + lift_ * outward;
            if (!scene_.occluded(origin, cosine_direction(outward, u[2], u[3]), blockers))
                return true;
        }
        return false;
    }

private:
    const Mesh& mesh_;
    const ray::MeshScene& scene_;
    const OutsideSides& sides_;
    uint64_t seed_;
    double lift_;
    double mean_ = 0;  // twice the area of a mean triangle
};

/// Sees `some` of the triangles by their rays from `first` to `end`, and marks those it sees.
using RayNumber = std::function<int(uint32_t triangle)>;
void see(const LeavingRays& rays, std::span<const uint32_t> some, const RayNumber& first,
         const RayNumber& end, std::vector<uint8_t>& seen, const Job& job) {
    parallel_for((some.size() + kBlock - 1) / kBlock, [&](size_t block) {
        job.check();
        const ray::FlushDenormals burst;
        ray::RecentBlockers blockers;
        for (size_t i = block * kBlock; i < std::min(some.size(), (block + 1) * kBlock); ++i)
            seen[some[i]] =
                rays.any_gets_out(some[i], first(some[i]), end(some[i]), blockers) ? 1 : 0;
    });
}

}  // namespace

std::vector<uint8_t> seen_from_outside(const Mesh& mesh, const ray::MeshScene& scene,
                                       int rays_per_triangle, uint64_t seed, const Job& job) {
    return seen_from_outside(mesh, scene, sides_of(mesh, scene), rays_per_triangle, seed, job);
}

std::vector<uint8_t> seen_from_outside(const Mesh& mesh, const ray::MeshScene& scene,
                                       const OutsideSides& sides, int rays_per_triangle,
                                       uint64_t seed, const Job& job) {
    if (scene.triangles() != mesh.triangles.size())
        fail(Status::InvalidArgument, "a scene of ", scene.triangles(),
             " triangles does not hold a mesh of ", mesh.triangles.size());
    std::vector<uint8_t> seen(mesh.triangles.size(), 0);
    if (mesh.empty())
        return seen;
    const LeavingRays rays(mesh, scene, sides, seed);
    std::vector<uint32_t> dark(mesh.triangles.size());
    std::iota(dark.begin(), dark.end(), 0u);
    // Half of the rays come first. What they do not find, with nothing found at its corners, lies
    // in the dark with everything around it. What is found beside is light for its own neighbors.
    const RayNumber none = [](uint32_t) { return 0; };
    const RayNumber half = [&](uint32_t i) { return (rays.of(i, rays_per_triangle) + 1) / 2; };
    const RayNumber all = [&](uint32_t i) {
        return std::max(rays.of(i, rays_per_triangle), rays.sides(i) * kRaysBesideSeen);
    };
    see(rays, dark, none, half, seen, job);
    const std::vector<uint32_t> welded = weld(mesh);
    std::vector<uint8_t> bright(mesh.positions.size(), 0);
    const auto any_bright = [&](const Triangle& t) {
        return (bright[welded[t.x]] | bright[welded[t.y]] | bright[welded[t.z]]) != 0;
    };
    const auto light_up = [&](uint32_t index) {
        for (int corner = 0; corner < 3; ++corner)
            bright[welded[mesh.triangles[index][corner]]] = 1;
    };
    for (uint32_t i = 0; i < seen.size(); ++i) {
        if (seen[i] != 0)
            light_up(i);
    }
    std::erase_if(dark, [&](uint32_t i) { return seen[i] != 0; });
    for (std::vector<uint32_t> beside; !dark.empty(); beside.clear()) {
        const auto edge = std::stable_partition(
            dark.begin(), dark.end(), [&](uint32_t i) { return !any_bright(mesh.triangles[i]); });
        beside.assign(edge, dark.end());
        dark.erase(edge, dark.end());
        if (beside.empty())
            break;
        see(rays, beside, half, all, seen, job);
        for (const uint32_t i : beside) {
            if (seen[i] != 0)
                light_up(i);
        }
    }
    return seen;
}

}  // namespace lodestone::measure
