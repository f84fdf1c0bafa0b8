// SPDX-License-Identifier: GPL-3.0-or-later
// Sample clusters: points of a surface in groups by place and color, split in two again and again.
#pragma once

#include "base/job.h"
#include "model/attributes.h"
#include "ray/mesh_skin.h"

#include <optional>
#include <vector>

namespace lodestone::solids {

/// A point of a surface with all that clusters are told apart by.
struct ClusterSample {
    glm::dvec3 point{0.0};
    glm::dvec3 normal{0.0};
    ray::SurfaceAppearance shown;
    uint32_t triangle = 0;
};

/// Of which each stands for the same area.
struct ClusterSamples {
    std::vector<ClusterSample> points;
    double area = 0;  // of one
};

struct SampleCluster {
    uint32_t number = 0;  // of its own: what is split is another one
    std::vector<uint32_t> samples;
    Attributes attributes;  // of the samples alone

    /// Area times variance.
    double spread() const {
        return attributes.moments[0][0] + attributes.moments[1][1] + attributes.moments[2][2];
    }
};

/// One cluster of all samples, then the one of the largest spread split in two by place and color
/// (2-means), as long as both halves are large enough.
class SampleClusters {
public:
    static constexpr size_t kFewestSamples = 16;

    /// Keeps the samples, of which there are kFewestSamples at least.
    explicit SampleClusters(ClusterSamples samples);

    /// Splits until there are so many, or nothing can be split any more.
    void split_to(size_t count, const Job& job);

    const std::vector<SampleCluster>& all() const { return clusters_; }
    const ClusterSamples& samples() const { return samples_; }

private:
    /// The second half, where there are two; the first one stays.
    std::optional<std::vector<uint32_t>> split(SampleCluster& cluster) const;

    ClusterSamples samples_;
    std::vector<SampleCluster> clusters_;
    std::vector<uint8_t> whole_;  // cannot be split
    uint32_t numbers_ = 1;
};

}  // namespace lodestone::solids
