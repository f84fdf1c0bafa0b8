// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/visible.h"

#include "base/parallel.h"
#include "base/random.h"
#include "measure/principal_axes.h"
#include "measure/visible_sampler.h"

#include <algorithm>
#include <cmath>

namespace lodestone::measure {
namespace {

constexpr uint32_t kBlock = 256;                 // rays a thread casts at a time
constexpr uint64_t kBatch = uint64_t{1} << 16u;  // rays between two serial sums
constexpr double kConfidence = 1.96;             // 95 % of a normal distribution
constexpr uint64_t kFirstBatch = 512;
constexpr uint64_t kFewestHits = 64;  // before the estimated error is believed
constexpr uint32_t kMostTags = uint32_t{1} << 24u;
constexpr double kMostRaysTimes = 64;

/// Sums of what is shown.
struct ShownSums {
    glm::dvec3 color{0.0};
    glm::dvec3 emission{0.0};
    double roughness = 0;
    double metallic = 0;
    double specular = 0;

    void add(const ray::Shown& shown, double weight) {
        color += weight * shown.color;
        emission += weight * shown.emission;
        roughness += weight * shown.roughness;
        metallic += weight * shown.metallic;
        specular += weight * shown.specular;
    }
};

/// A mesh's skin where triangles show more than one thing.
class Varied {
public:
    Varied(const Mesh& mesh, const ray::Skin* skin) : mesh_(mesh), skin_(skin) {
        uint16_t most = 0;
        for (const uint16_t slot : mesh.slots)
            most = std::max(most, slot);
        varies_.resize(size_t{most} + 1, 0);
        for (size_t slot = 0; skin != nullptr && slot < varies_.size(); ++slot)
            varies_[slot] = skin->varies(mesh, static_cast<uint16_t>(slot)) ? 1 : 0;
    }

    bool slot(size_t index) const { return varies_[index] != 0; }
    void add(const VisiblePoint& at, ShownSums& sums) const {
        if (slot(mesh_.slot(at.triangle)))
            sums.add(skin_->at(mesh_, at.triangle, at.u, at.v), 1);
    }

private:
    const Mesh& mesh_;
    const ray::Skin* skin_;
    std::vector<uint8_t> varies_;  // by slot
};

/// Sums over visible points, about a fixed point near them.
struct Tally {
    glm::dvec3 origin{0.0};
    uint64_t rays = 0;
    uint64_t hits = 0;    // rays with a point
    uint64_t points = 0;  // all of equal weight
    glm::dvec3 first{0.0};
    glm::dmat3 second{0.0};
    std::vector<uint32_t> by_triangle;
    ShownSums varied;  // of the points in slots that vary

    void add(const VisiblePoint& at) {
        const glm::dvec3 arm = at.point - origin;
        ++points;
        first += arm;
        second += glm::outerProduct(arm, arm);
        ++by_triangle[at.triangle];
    }

    /// Of the estimated area, 95 %. Two hits and two misses are added (Agresti and Coull 1998), so
    /// that nothing is certain only because no ray has missed.
    double relative_error() const {
        const double n = static_cast<double>(rays) + 4;
        const double p = (static_cast<double>(hits) + 2) / n;
        return kConfidence * std::sqrt((1 - p) / (p * n));
    }
};

/// Casts rays [first, first + count) on all threads and adds what they found in their order.
void cast(const VisibleSampler& sampler, const Varied& varied, uint64_t first, uint64_t count,
          Tally& tally, const Job& job) {
    struct Found {
        std::array<VisiblePoint, 2> points;
        int count = 0;
    };
    std::vector<Found> found(count);
    parallel_for((count + kBlock - 1) / kBlock, [&](size_t block) {
        job.check();
        const uint64_t end = std::min<uint64_t>(count, (block + 1) * kBlock);
        for (uint64_t i = block * kBlock; i < end; ++i)
            found[i].count = sampler.cast(static_cast<uint32_t>(first + i), found[i].points);
    });
    for (const Found& ray : found) {
        for (int i = 0; i < ray.count; ++i) {
            tally.add(ray.points[static_cast<size_t>(i)]);
            varied.add(ray.points[static_cast<size_t>(i)], tally.varied);
        }
        tally.hits += ray.count > 0 ? 1 : 0;
    }
    tally.rays += count;
}

Tally sample(const Mesh& mesh, const VisibleSampler& sampler, const Varied& varied,
             const VisibleOptions& options, const Job& job) {
    Tally tally;
    tally.origin = glm::dvec3(mesh.positions[mesh.triangles[0].x]);
    tally.by_triangle.resize(mesh.triangles.size(), 0);
    const bool adaptive = options.relative_error > 0;
    const uint64_t most = std::min<uint64_t>(adaptive ? options.most_rays : options.rays, ~0u);
    // Growing by a half each time, the rays cast after the goal was reached are a third at most.
    uint64_t next = adaptive ? kFirstBatch : most;
    while (tally.rays < most) {
        next = std::min({next, kBatch, most - tally.rays});
        cast(sampler, varied, tally.rays, next, tally, job);
        job.progress(static_cast<double>(tally.rays) / static_cast<double>(most));
        if (adaptive && tally.hits >= kFewestHits &&
            tally.relative_error() <= options.relative_error)
            break;
        next = adaptive ? tally.rays / 2 : most;
    }
    return tally;
}

void add_surface(const Mesh& mesh, const ray::Skin* skin, const Varied& varied, const Tally& tally,
                 Attributes& out) {
    std::vector<uint64_t> by_slot;
    for (size_t i = 0; i < tally.by_triangle.size(); ++i) {
        const size_t slot = mesh.slot(i);
        if (by_slot.size() <= slot)
            by_slot.resize(slot + 1, 0);
        by_slot[slot] += tally.by_triangle[i];
    }
    const auto points = static_cast<double>(tally.points);
    ShownSums sums;
    for (size_t slot = 0; slot < by_slot.size(); ++slot) {
        if (by_slot[slot] == 0 || varied.slot(slot))
            continue;
        const double share = static_cast<double>(by_slot[slot]) / points;
        sums.add(skin != nullptr ? skin->mean(static_cast<uint16_t>(slot)) : ray::Shown{}, share);
    }
    out.color = sums.color + tally.varied.color / points;
    out.emission = sums.emission + tally.varied.emission / points;
    out.roughness = sums.roughness + tally.varied.roughness / points;
    out.metallic = sums.metallic + tally.varied.metallic / points;
    out.specular = sums.specular + tally.varied.specular / points;
}

}  // namespace

Visible measure_visible(const Mesh& mesh, std::span<const Material> materials,
                        const VisibleOptions& options, std::span<const uint32_t> tags,
                        const Job& job) {
    image::TexelCache texels;
    const auto skin = std::make_shared<const ray::Skin>(materials, texels);
    return measure_visible(mesh, ray::Scene(mesh, skin), skin, options, tags, job);
}

Visible measure_visible(const Mesh& mesh, const ray::Scene& scene, const ray::SkinPtr& skin,
                        const VisibleOptions& options, std::span<const uint32_t> tags,
                        const Job& job) {
    if (!tags.empty() && tags.size() != mesh.triangles.size())
        fail(Status::InvalidArgument, tags.size(), " tags for ", mesh.triangles.size(),
             " triangles");
    Visible out;
    for (const uint32_t tag : tags) {
        if (tag >= kMostTags)
            fail(Status::InvalidArgument, "tag ", tag, " is not below ", kMostTags);
        if (tag >= out.hits_by_tag.size())
            out.hits_by_tag.resize(tag + 1, 0);
    }
    const VisibleSampler sampler(mesh, scene, options.seed);
    Attributes& attributes = out.attributes;
    attributes.surface_area = sampler.possible_area();
    if (sampler.empty())
        return out;
    const Varied varied(mesh, skin.get());
    const Tally tally = sample(mesh, sampler, varied, options, job);
    attributes.rays = tally.rays;
    attributes.relative_error = tally.relative_error();
    if (tally.points == 0)
        return out;
    const auto points = static_cast<double>(tally.points);
    attributes.visible_area = sampler.reference_area() * static_cast<double>(tally.hits) /
                              static_cast<double>(tally.rays);
    const glm::dvec3 mean = tally.first / points;
    attributes.centroid = tally.origin + mean;
    attributes.moments =
        attributes.visible_area * (tally.second / points - glm::outerProduct(mean, mean));
    NormalMoments normals;
    for (size_t i = 0; i < tally.by_triangle.size(); ++i) {
        const glm::dvec3 area = area_vector(mesh, i);
        const double length = glm::length(area);
        if (tally.by_triangle[i] > 0 && length > 0)
            normals.add(area / length, tally.by_triangle[i]);
    }
    attributes.axes = principal_axes(attributes.moments, normals);
    attributes.normal_moment = normals.in_frame(attributes.axes);
    add_surface(mesh, skin.get(), varied, tally, attributes);
    for (size_t i = 0; i < tags.size(); ++i)
        out.hits_by_tag[tags[i]] += tally.by_triangle[i];
    return out;
}

std::vector<uint8_t> seen_from_outside(const Mesh& mesh, const ray::Scene& scene,
                                       int rays_per_triangle, uint64_t seed, const Job& job) {
    if (scene.triangles() != mesh.triangles.size())
        fail(Status::InvalidArgument, "a scene of ", scene.triangles(),
             " triangles does not hold a mesh of ", mesh.triangles.size());
    std::vector<uint8_t> seen(mesh.triangles.size(), 0);
    if (mesh.empty())
        return seen;
    const Sides sides = sides_of(mesh, scene);
    const double lift = ray_lift(radius_of(mesh));
    double mean = 0;
    for (size_t i = 0; i < seen.size(); ++i)
        mean += glm::length(area_vector(mesh, i)) / static_cast<double>(seen.size());
    // A board of two triangles is as large as the thousand tiles on it, and seen between them.
    const auto rays_of = [&](double area) {
        const double share = area > mean ? std::min(area / mean, kMostRaysTimes) : 1;
        return static_cast<int>(std::ceil(share * rays_per_triangle));
    };
    const auto see = [&](size_t index) {
        const glm::dvec3 area = area_vector(mesh, index);
        const double length = glm::length(area);
        if (!(length > 0))
            return true;
        const glm::dvec3 normal = area / length;
        const Triangle& t = mesh.triangles[index];
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 ab = glm::dvec3(mesh.positions[t.y]) - a;
        const glm::dvec3 ac = glm::dvec3(mesh.positions[t.z]) - a;
        Random random(scramble(seed) + index, index);
        const int rays = rays_of(length);
        for (int i = 0; i < rays; ++i) {
            const bool back = sides.open ? (i & 1) != 0 : sides.turned[index] != 0;
            const glm::dvec3 outward = back ? -normal : normal;
            const double u[4] = {random.uniform(), random.uniform(), random.uniform(),
                                 random.uniform()};
            const glm::dvec2 weights = uniform_in_triangle(u[0], u[1]);
            const glm::dvec3 origin = a + weights.x * ab + weights.y * ac + lift * outward;
            if (!scene.occluded(origin, cosine_direction(outward, u[2], u[3])))
                return true;
        }
        return false;
    };
    parallel_for((seen.size() + kBlock - 1) / kBlock, [&](size_t block) {
        job.check();
        const size_t end = std::min<size_t>(seen.size(), (block + 1) * kBlock);
        for (size_t i = block * kBlock; i < end; ++i)
            seen[i] = see(i) ? 1 : 0;
    });
    return seen;
}

}  // namespace lodestone::measure
