// SPDX-License-Identifier: GPL-3.0-or-later
#include "solids/sample_clusters.h"

#include "measure/visible/principal_axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace lodestone::solids {
namespace {

// The distance between black and white, in radii of gyration of points.
// Taste: a larger one splits by color rather than by place.
constexpr double kColorDistance = 0.5;
// The rounds of 2-means.
// Taste: more change hardly anything; it mostly ends sooner.
constexpr int kMeans = 12;

/// The attributes of a cluster's samples, each of which stands for `area`.
Attributes attributes_of(const std::vector<ClusterSample>& samples,
                         const std::vector<uint32_t>& cluster, double area) {
    Attributes out;
    const auto count = static_cast<double>(cluster.size());
    measure::NormalMoments normals;
    out.color = glm::dvec3(0.0);
    std::map<uint16_t, std::pair<double, SolidFinish>> slots;  // the number of samples, the finish
    for (const uint32_t i : cluster) {
        const ClusterSample& sample = samples[i];
        out.centroid += sample.point / count;
        out.color += sample.shown.color / count;
        out.emission += sample.shown.emission / count;
        auto& [own, finish] = slots[sample.slot];
        own += 1;
        finish = sample.finish;
        normals.add(sample.normal, 1);
    }
    SolidFinish mean;
    for (const auto& [slot, one] : slots) {
        const double share = one.first / count;
        out.shares.push_back({slot, share});
        mean.roughness += share * one.second.roughness;
        mean.metallic += share * one.second.metallic;
        mean.specular += share * one.second.specular;
    }
    set_finish(out, mean);
    for (const uint32_t i : cluster) {
        const glm::dvec3 arm = samples[i].point - out.centroid;
        out.moments += area * glm::outerProduct(arm, arm);
    }
    out.visible_area = out.surface_area = area * count;
    out.axes = measure::principal_axes(out.moments, normals);
    out.normal_moment = normals.in_frame(out.axes);
    return out;
}

}  // namespace

SampleClusters::SampleClusters(ClusterSamples samples)
    : samples_(std::move(samples)), clusters_(1), whole_(1, 0) {
    for (uint32_t i = 0; i < samples_.points.size(); ++i)
        clusters_[0].samples.push_back(i);
    clusters_[0].attributes = attributes_of(samples_.points, clusters_[0].samples, samples_.area);
}

void SampleClusters::split_to(size_t count, const Job& job) {
    while (clusters_.size() < count) {
        job.check();
        size_t largest = clusters_.size();
        for (size_t i = 0; i < clusters_.size(); ++i) {
            if (whole_[i] == 0 && (largest == clusters_.size() ||
                                   clusters_[i].spread() > clusters_[largest].spread()))
                largest = i;
        }
        if (largest == clusters_.size())
            return;
        std::optional<std::vector<uint32_t>> second = split(clusters_[largest]);
        if (!second) {
            whole_[largest] = 1;
            continue;
        }
        SampleCluster other;
        other.samples = std::move(*second);
        for (SampleCluster* cluster : {&clusters_[largest], &other}) {
            cluster->number = numbers_++;
            cluster->attributes = attributes_of(samples_.points, cluster->samples, samples_.area);
        }
        clusters_.push_back(std::move(other));
        whole_.push_back(0);
    }
}

std::optional<std::vector<uint32_t>> SampleClusters::split(SampleCluster& cluster) const {
    const std::vector<ClusterSample>& samples = samples_.points;
    const double unit =
        kColorDistance * std::sqrt(cluster.spread() / cluster.attributes.visible_area);
    struct ClusterMean {
        glm::dvec3 point{0.0};
        glm::dvec3 color{0.0};
    };
    const glm::dvec3 reach =
        cluster.attributes.axes[0] * std::sqrt(cluster.spread() / cluster.attributes.visible_area);
    std::array<ClusterMean, 2> means;
    for (size_t side = 0; side < 2; ++side)
        means[side] = {cluster.attributes.centroid + (side == 0 ? -0.5 : 0.5) * reach,
                       cluster.attributes.color};
    std::vector<uint8_t> sides(cluster.samples.size(), 0);
    std::array<size_t, 2> counts{};
    for (int round = 0; round < kMeans; ++round) {
        std::array<ClusterMean, 2> sums;
        counts = {};
        for (size_t i = 0; i < sides.size(); ++i) {
            const ClusterSample& sample = samples[cluster.samples[i]];
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

}  // namespace lodestone::solids
