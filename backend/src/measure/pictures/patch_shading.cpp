// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/pictures/patch_shading.h"

#include "measure/pictures/glass_rays.h"
#include "measure/pictures/patch_grid.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace lodestone::measure {
namespace {

// The samples kept of simple meshes; finer ones have one for each triangle.
// Taste: more resolve smaller patches, for a ray each and stand-in.
constexpr size_t kFewest = 2048;
// The samples kept at most.
// Taste: more resolve smaller patches of fine meshes, for a ray each and stand-in.
constexpr size_t kMost = 131072;
// The share of the samples that must not be alone in their patch.
// Taste: a larger value ends the search at larger patches, a smaller one trusts few rays.
constexpr double kLeastKnown = 0.5;
// The mean square cosine between normals of one patch, below which it is foliage.
// Taste: anything is 1/3, slopes of 30 degrees are 0.75; a larger value compares fewer rough ones.
constexpr double kLeastAlike = 0.6;

/// A cube, and the normal of a sample there.
using CubeNormal = std::pair<uint64_t, glm::dvec3>;

/// The mean square cosine between two normals of one cube, of the smallest cubes that have two;
/// which way they face along it does not matter.
double likeness(std::vector<CubeNormal>& normals) {
    std::stable_sort(normals.begin(), normals.end(),
                     [](const CubeNormal& a, const CubeNormal& b) { return a.first < b.first; });
    for (int shift = 0; shift <= 3 * PatchGrid::kHalvings; shift += 3) {
        double squares = 0;
        double count = 0;
        for (size_t begin = 0, end = 0; begin < normals.size(); begin = end) {
            glm::dmat3 sum(0.0);
            for (end = begin; end < normals.size() &&
                              normals[end].first >> shift == normals[begin].first >> shift;
                 ++end)
                sum += glm::outerProduct(normals[end].second, normals[end].second);
            const auto samples = static_cast<double>(end - begin);
            if (samples < 2)
                continue;
            double square = 0;
            for (int axis = 0; axis < 3; ++axis)
                square += glm::dot(sum[axis], sum[axis]);
            squares += (square - samples) / (samples - 1);
            count += samples;
        }
        if (count >= kLeastKnown * static_cast<double>(normals.size()))
            return squares / std::max(count, 1.0);
    }
    return 1;
}

}  // namespace

ShadedPatches::ShadedPatches(const Mesh& finest, const VisibleSampler& sampler,
                             std::span<const CastPoints> cast, double visible_area)
    : radius_(radius_of(finest)), visible_area_(visible_area) {
    const size_t wanted = std::clamp(finest.triangles.size(), kFewest, kMost);
    const ray::FlushDenormals burst;
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    const size_t most_rays = sampler.empty() ? 0 : std::max(cast.size(), 2 * wanted);
    for (size_t i = 0; i < most_rays && seen_.size() < wanted; ++i) {
        CastPoints found;
        if (i < cast.size())
            found = cast[i];
        else if (wanted > kFewest)
            found.count = sampler.cast(static_cast<uint32_t>(i), found.points);
        else
            break;
        for (int k = 0; k < found.count; ++k) {
            const VisiblePoint& at = found.points[static_cast<size_t>(k)];
            const glm::dvec3 towards = sampler.towards_eye(static_cast<uint32_t>(i), at);
            const ray::RayHit hit{true, at.triangle, at.u, at.v, 0, at.point};
            seen_.push_back({0, at.triangle, at.point, towards, normal_at(finest, hit, towards)});
            low = glm::min(low, at.point);
        }
    }
    std::vector<CubeNormal> normals;
    for (ShadedSample& seen : seen_) {
        seen.cube = PatchGrid::cube_of((seen.point - low) / (2 * radius_));
        normals.emplace_back(seen.cube, seen.normal);
    }
    is_surface_ = likeness(normals) > kLeastAlike;
}

void ShadedPatches::meet(const ShadedSample& seen, const Mesh& stand_in,
                         const ray::MeshScene& scene, double near,
                         std::vector<MetSample>& out) const {
    const ray::RayHit hit = scene.first_hit(seen.point + 4 * radius_ * seen.towards, -seen.towards);
    if (!hit.hit || glm::distance(hit.point, seen.point) > near)
        return;
    const glm::dvec3 normal = normal_at(stand_in, hit, seen.towards);
    out.push_back(
        {PatchGrid::on_side(normal, seen.cube), seen.point, normal, seen.normal - normal});
}

double ShadedPatches::largest_of(std::vector<MetSample>& met, size_t samples, double widest,
                                 double least) const {
    // The share of a patch's square that counts as all of it: surfaces cut cubes anyhow.
    // Taste: a larger value forgives how thin things are shaded, and what ends in a cube.
    constexpr double kLeastCovered = 0.25;
    // The largest of smaller patches may count as so many times their size.
    // Taste: samples are hardly dense enough for smaller ones; a smaller number looks at fewer sizes.
    constexpr double kMostTimes = 8;
    // Chance makes patches differ by more than the least with one in 40.
    // Law: two standard deviations.
    constexpr double kSure = 2;
    std::stable_sort(met.begin(), met.end(),
                     [](const MetSample& a, const MetSample& b) { return a.patch < b.patch; });
    std::vector<uint64_t> patches;
    std::vector<glm::dvec3> normals;
    std::vector<glm::dvec3> off;
    for (const MetSample& one : met) {
        patches.push_back(one.patch);
        normals.push_back(one.normal);
        off.push_back(one.off);
    }
    const double per_area = kLeastCovered * static_cast<double>(samples) / visible_area_;
    // Between two sizes differences follow a power of the size, nearly.
    double side = 2 * radius_;
    double larger = 0;
    double largest = 0;
    for (int halvings = 0; halvings <= PatchGrid::kHalvings && kMostTimes * side > least;
         ++halvings, side /= 2) {
        if (side > widest)
            continue;
        const PatchGrid::PatchDifference turned =
            PatchGrid::difference(patches, off, halvings, side * side * per_area, normals);
        if (turned.known < kLeastKnown)
            break;
        const double sure =
            std::sqrt(std::max(0.0, turned.off * turned.off - kSure * turned.noise));
        if (sure > kMostTurned) {
            const double part =
                larger > 0 ? std::log(sure / kMostTurned) / std::log(sure / larger) : 0;
            if (largest == 0)
                largest = side * std::exp2(part);
            largest = std::max(largest, side * sure / kMostTurned);
        }
        larger = sure;
    }
    return largest > least ? largest : 0;
}

double ShadedPatches::largest_unlike_patch(const Mesh& stand_in, const ray::MeshScene& scene,
                                           double least) const {
    // The samples of a patch of the least size, in the mean, on a ball.
    // Taste: more tell smaller differences, for a ray each.
    constexpr double kSamplesEach = 6;
    if (!is_surface_ || !(2 * radius_ > least) || !(least > 0) || !(visible_area_ > 0))
        return 0;
    const double width = 2 * radius_ / least;
    const double wanted = kSamplesEach * std::numbers::pi * width * width;
    const size_t most =
        wanted < static_cast<double>(seen_.size())
            ? std::min(seen_.size(), std::max(kFewest / 2, static_cast<size_t>(wanted)))
            : seen_.size();
    const ray::FlushDenormals burst;
    std::vector<MetSample> met;
    for (const ShadedSample& seen : std::span(seen_).first(most))
        meet(seen, stand_in, scene, least, met);
    return largest_of(met, most, 2 * radius_, least);
}

std::vector<double> ShadedPatches::largest_unlike_patches(
    const Mesh& stand_in, const ray::MeshScene& scene,
    const std::function<uint32_t(uint32_t triangle)>& part_of,
    std::span<const double> least) const {
    std::vector<double> out(least.size(), 0);
    if (!is_surface_ || !(visible_area_ > 0))
        return out;
    std::vector<std::vector<MetSample>> met(out.size());
    const ray::FlushDenormals burst;
    for (const ShadedSample& seen : seen_) {
        const uint32_t part = part_of(seen.triangle);
        meet(seen, stand_in, scene, least[part], met[part]);
    }
    for (size_t part = 0; part < out.size(); ++part) {
        glm::dvec3 low(std::numeric_limits<double>::infinity());
        glm::dvec3 high(-low);
        for (const MetSample& one : met[part]) {
            low = glm::min(low, one.point);
            high = glm::max(high, one.point);
        }
        const glm::dvec3 size = high - low;
        out[part] =
            largest_of(met[part], seen_.size(), std::max({size.x, size.y, size.z}), least[part]);
    }
    return out;
}

}  // namespace lodestone::measure
