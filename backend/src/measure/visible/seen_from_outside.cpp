// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/visible/seen_from_outside.h"

#include "base/parallel.h"
#include "base/random.h"
#include "measure/visible/convex_bound.h"
#include "measure/visible/sobol_points.h"
#include "measure/visible/visible_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone::measure {
namespace {

/// The rays of a large triangle, over those of a mean one, at most.
/// Taste: a larger value finds large triangles that are seen through narrower gaps, for more rays.
constexpr double kMostRaysTimes = 64;

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
    const double lift = ray_lift(radius_of(mesh));
    double mean = 0;
    for (size_t i = 0; i < seen.size(); ++i)
        mean += glm::length(area_vector(mesh, i)) / static_cast<double>(seen.size());
    // A board of two triangles is as large as the thousand tiles on it, and seen between them.
    const auto rays_of = [&](double area) {
        const double share = area > mean ? std::min(area / mean, kMostRaysTimes) : 1;
        return static_cast<int>(std::ceil(share * rays_per_triangle));
    };
    const auto see = [&](size_t index, int first, int end, ray::RecentBlockers& blockers) {
        const glm::dvec3 area = area_vector(mesh, index);
        const double length = glm::length(area);
        if (!(length > 0))
            return true;
        const glm::dvec3 normal = area / length;
        const Triangle& t = mesh.triangles[index];
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 ab = glm::dvec3(mesh.positions[t.y]) - a;
        const glm::dvec3 ac = glm::dvec3(mesh.positions[t.z]) - a;
        PcgRandom random(scramble(seed + static_cast<uint64_t>(first)) + index, index);
        for (int i = first; i < end; ++i) {
            const bool back =
                sides.both(index) ? (i & 1) != 0 : sides.of[index] == VisibleSide::Back;
            const glm::dvec3 outward = back ? -normal : normal;
            const double u[4] = {random.uniform(), random.uniform(), random.uniform(),
                                 random.uniform()};
            const glm::dvec2 weights = uniform_in_triangle(u[0], u[1]);
            const glm::dvec3 origin = a + weights.x * ab + weights.y * ac + lift * outward;
            if (!scene.occluded(origin, cosine_direction(outward, u[2], u[3]), blockers))
                return true;
        }
        return false;
    };
    // Half of the rays come first. A triangle that they do not find, with no found triangle at its
    // corners, lies in the dark with everything around it.
    std::vector<uint8_t> bright(mesh.positions.size(), 0);
    const std::vector<uint32_t> welded = weld(mesh);
    const auto corners_of = [&](size_t index) {
        const Triangle& t = mesh.triangles[index];
        return std::array<uint32_t, 3>{welded[t.x], welded[t.y], welded[t.z]};
    };
    const auto may_be_bright = [&](size_t index) {
        const std::array<uint32_t, 3> at = corners_of(index);
        return std::any_of(at.begin(), at.end(),
                           [&](uint32_t corner) { return bright[corner] != 0; });
    };
    const auto visit = [&](bool again) {
        parallel_for((seen.size() + kBlock - 1) / kBlock, [&](size_t block) {
            job.check();
            const ray::FlushDenormals burst;
            ray::RecentBlockers blockers;
            const size_t end = std::min<size_t>(seen.size(), (block + 1) * kBlock);
            for (size_t i = block * kBlock; i < end; ++i) {
                const int rays = rays_of(glm::length(area_vector(mesh, i)));
                const int half = (rays + 1) / 2;
                if (!again)
                    seen[i] = see(i, 0, half, blockers) ? 1 : 0;
                else if (seen[i] == 0 && half < rays && may_be_bright(i))
                    seen[i] = see(i, half, rays, blockers) ? 1 : 0;
            }
        });
    };
    visit(false);
    for (size_t i = 0; i < seen.size(); ++i) {
        for (const uint32_t corner : corners_of(i)) {
            if (seen[i] != 0)
                bright[corner] = 1;
        }
    }
    visit(true);
    return seen;
}

}  // namespace lodestone::measure
