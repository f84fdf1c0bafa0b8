// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/composite.h"

#include "measure/principal_axes.h"
#include "measure/visible.h"
#include "measure/visible_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace lodestone::approximate {
namespace {

constexpr uint32_t kRays = 8192;
constexpr std::array<size_t, 4> kCounts{4, 8, 16, 32};
constexpr size_t kFewestSamples = 16;  // of a cluster
// Black and white are as far apart as points at this many radii of gyration.
constexpr double kColorDistance = 0.5;
constexpr int kMeans = 12;  // rounds of 2-means
constexpr int kScalings = 3;
constexpr double kMostScale = 2;

/// A visible point with all that clusters are told apart by.
struct Sample {
    glm::dvec3 point{0.0};
    glm::dvec3 normal{0.0};
    ray::Shown shown;
};

struct Sampled {
    std::vector<Sample> samples;
    double area = 0;  // visible, of one
};

Sampled sampled(const Mesh& mesh, const ray::Scene& scene, const ray::SkinPtr& skin,
                uint64_t seed) {
    Sampled out;
    const measure::VisibleSampler sampler(mesh, scene, seed);
    if (sampler.empty())
        return out;
    uint32_t hits = 0;
    std::array<measure::VisiblePoint, 2> points;
    for (uint32_t ray = 0; ray < kRays; ++ray) {
        const int count = sampler.cast(ray, points);
        hits += count > 0 ? 1 : 0;
        for (int i = 0; i < count; ++i) {
            const measure::VisiblePoint& at = points[static_cast<size_t>(i)];
            Sample sample;
            sample.point = at.point;
            const glm::dvec3 normal = area_vector(mesh, at.triangle);
            const double length = glm::length(normal);
            sample.normal = length > 0 ? normal / length : glm::dvec3(0, 0, 1);
            if (skin)
                sample.shown = skin->at(mesh, at.triangle, at.u, at.v);
            out.samples.push_back(sample);
        }
    }
    if (!out.samples.empty())
        out.area =
            sampler.reference_area() * hits / kRays / static_cast<double>(out.samples.size());
    return out;
}

/// Of the samples of a cluster, of which each stands for `area`.
Attributes attributes_of(const std::vector<Sample>& samples, const std::vector<uint32_t>& cluster,
                         double area) {
    Attributes out;
    const auto count = static_cast<double>(cluster.size());
    measure::NormalMoments normals;
    out.color = glm::dvec3(0.0);
    out.roughness = out.metallic = out.specular = 0;
    for (const uint32_t i : cluster) {
        const Sample& sample = samples[i];
        out.centroid += sample.point / count;
        out.color += sample.shown.color / count;
        out.emission += sample.shown.emission / count;
        out.roughness += sample.shown.roughness / count;
        out.metallic += sample.shown.metallic / count;
        out.specular += sample.shown.specular / count;
        normals.add(sample.normal, 1);
    }
    for (const uint32_t i : cluster) {
        const glm::dvec3 arm = samples[i].point - out.centroid;
        out.moments += area * glm::outerProduct(arm, arm);
    }
    out.visible_area = out.surface_area = area * count;
    out.axes = measure::principal_axes(out.moments, normals);
    out.normal_moment = normals.in_frame(out.axes);
    return out;
}

struct Cluster {
    uint32_t number = 0;
    std::vector<uint32_t> samples;
    Attributes attributes;

    double spread() const {
        return attributes.moments[0][0] + attributes.moments[1][1] + attributes.moments[2][2];
    }
};

/// In two by place and color; the first half stays, the second comes back. Nothing when one of them
/// would be too small.
std::optional<std::vector<uint32_t>> split(Cluster& cluster, const std::vector<Sample>& samples) {
    const double unit =
        kColorDistance * std::sqrt(cluster.spread() / cluster.attributes.visible_area);
    struct Mean {
        glm::dvec3 point{0.0};
        glm::dvec3 color{0.0};
    };
    const glm::dvec3 reach =
        cluster.attributes.axes[0] * std::sqrt(cluster.spread() / cluster.attributes.visible_area);
    std::array<Mean, 2> means;
    for (size_t side = 0; side < 2; ++side)
        means[side] = {cluster.attributes.centroid + (side == 0 ? -0.5 : 0.5) * reach,
                       cluster.attributes.color};
    std::vector<uint8_t> sides(cluster.samples.size(), 0);
    std::array<size_t, 2> counts{};
    for (int round = 0; round < kMeans; ++round) {
        std::array<Mean, 2> sums;
        counts = {};
        for (size_t i = 0; i < sides.size(); ++i) {
            const Sample& sample = samples[cluster.samples[i]];
            std::array<double, 2> off{};
            for (size_t side = 0; side < 2; ++side) {
                const glm::dvec3 arm = sample.point - means[side].point;
                const glm::dvec3 shade = unit * (sample.shown.color - means[side].color);
                off[side] = glm::dot(arm, arm) + glm::dot(shade, shade);
            }
            const size_t side = off[1] < off[0] ? 1 : 0;
            sides[i] = static_cast<uint8_t>(side);
            sums[side].point += sample.point;
            sums[side].color += sample.shown.color;
            ++counts[side];
        }
        if (std::min(counts[0], counts[1]) < kFewestSamples)
            return std::nullopt;
        for (size_t side = 0; side < 2; ++side) {
            const auto count = static_cast<double>(counts[side]);
            means[side] = {sums[side].point / count, sums[side].color / count};
        }
    }
    std::vector<uint32_t> first;
    std::vector<uint32_t> second;
    for (size_t i = 0; i < sides.size(); ++i)
        (sides[i] == 0 ? first : second).push_back(cluster.samples[i]);
    cluster.samples = std::move(first);
    return second;
}

/// A cluster is a patch of surface: neither sparse nor in two heaps by what it is part of, so what
/// refuses one kind of solid gets the other, or the ball of its area.
Solid solid_of(const Cluster& cluster) {
    Solid out;
    const bool preferred = boxlike(cluster.attributes);
    for (const bool box : {preferred, !preferred}) {
        const auto found =
            box ? fit_box(cluster.attributes, Bound{}) : fit_ellipsoid(cluster.attributes, Bound{});
        if (!found)
            continue;
        out.box = box;
        out.primitive = *found;
        return out;
    }
    const double square = cluster.attributes.visible_area / (4 * std::numbers::pi);
    out.primitive = {cluster.attributes.centroid, cluster.attributes.axes,
                     glm::dvec3(std::sqrt(square))};
    return out;
}

/// All parts alike, until the whole shows the area wanted.
void scale_to(Composite& composite, double area, uint64_t seed, const Job& job) {
    double scale = 1;
    for (int i = 0; i < kScalings; ++i) {
        const Mesh mesh = tessellate(composite, 3);
        measure::VisibleOptions options;
        options.rays = kRays;
        options.seed = seed;
        const double now =
            measure::measure_visible(mesh, ray::Scene(mesh), nullptr, options, {}, job)
                .attributes.visible_area;
        if (!(now > 0))
            return;
        const double step =
            std::clamp(std::sqrt(area / now), 1 / kMostScale / scale, kMostScale / scale);
        for (Solid& solid : composite.solids)
            solid.primitive.half_size *= step;
        scale *= step;
    }
}

}  // namespace

std::vector<Clustered> composites(const Mesh& mesh, const ray::SkinPtr& skin, uint64_t seed,
                                  const Job& job) {
    std::vector<Clustered> out;
    const Sampled found = sampled(mesh, ray::Scene(mesh, skin), skin, seed);
    if (found.samples.size() < kFewestSamples || !(found.area > 0))
        return out;
    std::vector<Cluster> clusters(1);
    for (uint32_t i = 0; i < found.samples.size(); ++i)
        clusters[0].samples.push_back(i);
    clusters[0].attributes = attributes_of(found.samples, clusters[0].samples, found.area);
    const double all = clusters[0].attributes.visible_area;
    uint32_t numbers = 1;
    std::vector<uint8_t> whole;  // clusters that cannot be split
    whole.push_back(0);
    for (const size_t count : kCounts) {
        while (clusters.size() < count) {
            job.check();
            size_t largest = clusters.size();
            for (size_t i = 0; i < clusters.size(); ++i) {
                if (whole[i] == 0 && (largest == clusters.size() ||
                                      clusters[i].spread() > clusters[largest].spread()))
                    largest = i;
            }
            if (largest == clusters.size())
                break;
            std::optional<std::vector<uint32_t>> second = split(clusters[largest], found.samples);
            if (!second) {
                whole[largest] = 1;
                continue;
            }
            Cluster other;
            other.samples = std::move(*second);
            for (Cluster* cluster : {&clusters[largest], &other}) {
                cluster->number = numbers++;
                cluster->attributes = attributes_of(found.samples, cluster->samples, found.area);
            }
            clusters.push_back(std::move(other));
            whole.push_back(0);
        }
        if (clusters.size() < 2 || (!out.empty() && out.back().clusters.size() == clusters.size()))
            break;
        Clustered level;
        for (const Cluster& cluster : clusters) {
            level.composite.solids.push_back(solid_of(cluster));
            level.composite.solids.back().slot = static_cast<uint16_t>(level.clusters.size());
            level.attributes.push_back(cluster.attributes);
            level.clusters.push_back(cluster.number);
        }
        scale_to(level.composite, all, seed, job);
        out.push_back(std::move(level));
    }
    return out;
}

}  // namespace lodestone::approximate
