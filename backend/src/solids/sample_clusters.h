// SPDX-License-Identifier: GPL-3.0-or-later
// Sample clusters: points of a surface in groups by place and color, split in two again and again.
#pragma once

#include "base/job.h"
#include "model/finish.h"
#include "ray/mesh_skin.h"

#include <optional>
#include <vector>

namespace lodestone::solids {

/// A point of a surface with all that distinguishes clusters.
struct ClusterSample {
    glm::dvec3 point{0.0};
    glm::dvec3 normal{0.0};
    ray::SurfaceAppearance shown;
    SolidFinish finish;  // the mean of its slot's material
    uint16_t slot = 0;
    uint32_t triangle = 0;
};

/// Samples, each of which stands for the same area.
struct ClusterSamples {
    std::vector<ClusterSample> points;
    double area = 0;  // the area of one sample
};

struct SampleCluster {
    uint32_t number = 0;  // its own number: after a split, both halves have new ones
    std::vector<uint32_t> samples;
    Attributes attributes;  // those of its samples alone

    /// The area times the variance.
    double spread() const {
        return attributes.moments[0][0] + attributes.moments[1][1] + attributes.moments[2][2];
    }
};

/// One cluster of all samples, then the cluster with the largest spread split in two by place and
/// color (2-means), as long as both halves are large enough.
class SampleClusters {
public:
    /// The fewest samples of a cluster.
    /// Taste: fewer give smaller clusters, whose solids are more by chance.
    static constexpr size_t kFewestSamples = 16;

    /// Keeps the samples, which must be kFewestSamples at least.
    explicit SampleClusters(ClusterSamples samples);

    /// Splits until there are `count` clusters, or none can be split any more.
    void split_to(size_t count, const Job& job);

    const std::vector<SampleCluster>& all() const { return clusters_; }
    const ClusterSamples& samples() const { return samples_; }

private:
    /// The second half, if the cluster can be split; the first one stays.
    std::optional<std::vector<uint32_t>> split(SampleCluster& cluster) const;

    ClusterSamples samples_;
    std::vector<SampleCluster> clusters_;
    std::vector<uint8_t> whole_;  // by cluster: it cannot be split
    uint32_t numbers_ = 1;
};

}  // namespace lodestone::solids
