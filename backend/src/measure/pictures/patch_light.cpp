// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/pictures/patch_light.h"

#include "measure/pictures/cube_views.h"
#include "measure/pictures/glass_rays.h"
#include "measure/pictures/patch_grid.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::measure {
namespace {

// A surface shows one color when the root of the mean square of its colors' differences, over the
// mean color, is less than this.
// Taste: a larger value paints fewer boxes with several colors.
constexpr double kOneColor = 0.1;

ray::SurfaceAppearance shown_at(const Mesh& mesh, const ray::MeshSkin& skin,
                                const ray::RayHit& hit) {
    const uint16_t slot = mesh.slot(hit.triangle);
    return skin.varies(mesh, slot) ? skin.at(mesh, hit.triangle, hit.u, hit.v) : skin.mean(slot);
}

/// The light on a surface, over that on a surface facing the lamp; `facing` is the cosine.
double light_of(double facing) {
    return kSkyShare + (1 - kSkyShare) * facing;
}

glm::dvec3 light_at(const Mesh& mesh, const ray::MeshSkin& skin, const ray::RayHit& hit,
                    const glm::dvec3& towards) {
    const ray::SurfaceAppearance shown = shown_at(mesh, skin, hit);
    const double facing = std::abs(glm::dot(normal_at(mesh, hit, towards), towards));
    return light_of(facing) * shown.color + shown.emission;
}

/// The direction to a sun obliquely beside the eye, around it by the golden angle, not below it.
glm::dvec3 sun_beside(const glm::dvec3& towards, size_t number) {
    const double turn = kGoldenAngle * static_cast<double>(number);
    const glm::dvec3 other = std::abs(towards.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(other, towards));
    const glm::dvec3 up = glm::cross(towards, right);
    return glm::normalize(towards + std::cos(turn) * right + std::abs(std::sin(turn)) * up);
}

}  // namespace

LightPatches::LightPatches(const Mesh& finest, const VisibleSampler& sampler,
                           const ray::MeshSkin& skin, std::span<const CastPoints> cast)
    : radius_(radius_of(finest)) {
    // The points of the finest that are kept at most.
    // Taste: a larger value resolves smaller patches, for a ray each and stand-in.
    constexpr size_t kMost = 2048;
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    for (size_t i = 0; i < cast.size() && seen_.size() < kMost; ++i) {
        for (int k = 0; k < cast[i].count; ++k) {
            const VisiblePoint& at = cast[i].points[static_cast<size_t>(k)];
            const glm::dvec3 towards = sampler.towards_eye(static_cast<uint32_t>(i), at);
            const ray::RayHit hit{true, at.triangle, at.u, at.v, 0, at.point};
            seen_.push_back({0, at.point, towards, normal_at(finest, hit, towards),
                             shown_at(finest, skin, hit), light_at(finest, skin, hit, towards)});
            low = glm::min(low, at.point);
            mean_ += seen_.back().light;
        }
    }
    glm::dvec3 color(0.0);
    for (const PatchSample& seen : seen_)
        color += seen.shown.color / static_cast<double>(seen_.size());
    double off = 0;
    for (const PatchSample& seen : seen_) {
        const glm::dvec3 from_mean = seen.shown.color - color;
        off += glm::dot(from_mean, from_mean) / static_cast<double>(seen_.size());
    }
    colored_ = off > kOneColor * kOneColor * glm::dot(color, color);
    for (PatchSample& seen : seen_)
        seen.patch = PatchGrid::patch_of(seen.towards, (seen.point - low) / (2 * radius_));
    std::stable_sort(seen_.begin(), seen_.end(),
                     [](const PatchSample& a, const PatchSample& b) { return a.patch < b.patch; });
    mean_ /= static_cast<double>(std::max<size_t>(seen_.size(), 1));
}

double LightPatches::largest_unlike_patch(const Mesh& stand_in, const ray::MeshScene& scene,
                                          const ray::MeshSkin& skin, bool matched,
                                          double least) const {
    // The brightness that is made up for, as a factor.
    // Taste: a larger value forgives darker stand-ins, which are made as bright only up to their
    // colors' range.
    constexpr double kMostBrighter = 2;
    // Patches as large as the bound count as so many times farther at most, as pictures do.
    // Fitted: bench_street.py on the street, far camera, 2 px; 8 took a third more triangles for
    // less SSIM.
    constexpr double kMostFarther = 2;
    // The share of the rays that must not be alone in their patch.
    // Taste: a larger value ends the search at larger patches, a smaller one trusts few rays.
    constexpr double kLeastKnown = 0.5;
    if (!(glm::length(mean_) > 0) || !(2 * radius_ > least))
        return 0;
    const ray::FlushDenormals burst;
    std::vector<glm::dvec3> off(seen_.size(), glm::dvec3(0.0));
    glm::dvec3 theirs(0.0);
    for (size_t i = 0; i < seen_.size(); ++i) {
        const PatchSample& seen = seen_[i];
        const ray::RayHit hit =
            scene.first_hit(seen.point + 4 * radius_ * seen.towards, -seen.towards);
        if (hit.hit)
            off[i] = light_at(stand_in, skin, hit, seen.towards);
        theirs += off[i] / static_cast<double>(seen_.size());
    }
    glm::dvec3 brighter(1.0);
    for (int i = 0; i < 3; ++i) {
        if (matched && theirs[i] > 0)
            brighter[i] = std::clamp(mean_[i] / theirs[i], 1 / kMostBrighter, kMostBrighter);
    }
    for (size_t i = 0; i < seen_.size(); ++i)
        off[i] = brighter * off[i] - seen_[i].light;
    std::vector<uint64_t> patches;
    for (const PatchSample& seen : seen_)
        patches.push_back(seen.patch);
    const double most = kMostOff * glm::length(mean_);
    double side = 2 * radius_;
    for (int halvings = 0; halvings <= PatchGrid::kHalvings && side > least;
         ++halvings, side /= 2) {
        const PatchGrid::PatchDifference found = PatchGrid::difference(patches, off, halvings);
        if (found.known < kLeastKnown)
            break;
        if (found.off > most)
            return side * (halvings == 0 ? std::min(found.off / most, kMostFarther) : 1);
    }
    return 0;
}

std::vector<glm::dvec4> LightPatches::fitted_vertex_colors(const Mesh& stand_in,
                                                           const ray::MeshScene& finest) const {
    // Rounds of the fit below.
    // Taste: more would take steps (dark trousers under a bright shirt) for slopes that go on.
    constexpr int kRounds = 2;
    // The weight of eyes below the horizon.
    // Taste: a larger value lights boxes more for views from below, which are rare.
    constexpr double kFromBelow = 0.125;
    struct PaintSample {
        std::array<uint32_t, 3> vertices;  // vertices of the stand-in
        glm::dvec3 near;                   // how near to each vertex, 1 in all
        glm::dvec3 wanted;                 // light of the finest
        double light;                      // light on the stand-in
        double weight;
    };
    std::vector<glm::dvec4> out(stand_in.positions.size(), glm::dvec4(0.0));
    if (!colored_)
        return out;
    const ray::FlushDenormals burst;
    const ray::MeshScene scene(stand_in);
    const double lift = ray_lift(radius_);
    std::vector<PaintSample> samples;
    glm::dvec4 all(0.0);
    glm::dvec4 both(0.0);  // where the stand-in is seen, too
    for (size_t i = 0; i < seen_.size(); ++i) {
        const PatchSample& seen = seen_[i];
        const glm::dvec3 sun = sun_beside(seen.towards, i);
        double facing = std::max(0.0, glm::dot(seen.normal, sun));
        if (facing > 0 && finest.occluded(seen.point + lift * seen.normal, sun))
            facing = 0;
        const glm::dvec3 wanted = light_of(facing) * seen.shown.color;
        const double weight = seen.towards.z >= 0 ? 1 : kFromBelow;
        all += glm::dvec4(weight * wanted, weight);
        const ray::RayHit hit =
            scene.first_hit(seen.point + 4 * radius_ * seen.towards, -seen.towards);
        if (!hit.hit)
            continue;
        both += glm::dvec4(weight * wanted, weight);
        const Triangle& t = stand_in.triangles[hit.triangle];
        const double on_it = glm::dot(normal_at(stand_in, hit, seen.towards), sun);
        samples.push_back({{t.x, t.y, t.z},
                           {1 - hit.u - hit.v, hit.u, hit.v},
                           wanted,
                           light_of(std::max(0.0, on_it)),
                           weight});
    }
    // Points that are seen beside the stand-in count in the mean of all.
    glm::dvec3 more(1.0);
    for (int i = 0; i < 3; ++i) {
        if (both[i] > 0)
            more[i] = all[i] / all.w / (both[i] / both.w);
    }
    // Likeliest colors by expectation and maximization (Richardson 1972, Lucy 1974): none gets
    // below 0, and all light together is right in each round.
    std::fill(out.begin(), out.end(), glm::dvec4(1.0));
    for (int round = 0; round < kRounds; ++round) {
        std::vector<glm::dvec4> sums(out.size(), glm::dvec4(0.0));
        for (const PaintSample& sample : samples) {
            glm::dvec3 color(0.0);
            for (int k = 0; k < 3; ++k)
                color += sample.near[k] * glm::dvec3(out[sample.vertices[k]]);
            const glm::dvec3 ratio = sample.wanted / glm::max(color, glm::dvec3(1e-9));
            for (int k = 0; k < 3; ++k)
                sums[sample.vertices[k]] +=
                    sample.weight * sample.near[k] * glm::dvec4(ratio, sample.light);
        }
        for (size_t i = 0; i < out.size(); ++i) {
            const double light = sums[i].w;
            out[i] = light > 0 ? glm::dvec4(glm::dvec3(out[i]) * glm::dvec3(sums[i]) / light, light)
                               : glm::dvec4(0.0);
        }
    }
    for (glm::dvec4& one : out)
        one = glm::dvec4(more * glm::dvec3(one), one.w);
    return out;
}

}  // namespace lodestone::measure
