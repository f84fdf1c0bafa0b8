// SPDX-License-Identifier: GPL-3.0-or-later
// Composite: a surface as 4 to 32 boxes and ellipsoids, one for each cluster of what can be seen.
#pragma once

#include "base/job.h"
#include "model/composite.h"
#include "ray/mesh_scene.h"
#include "solids/solid_replacement.h"

#include <span>
#include <vector>

namespace lodestone::solids {

/// One level: a solid for each cluster, with a slot of its own.
struct ClusteredComposite {
    Composite composite;
    std::vector<Attributes> attributes;  // of the clusters, in the order of the solids
    std::vector<uint32_t> clusters;      // levels share what has the same number
    std::vector<double> opacities;       // of the solids, 1: not clear (see surface_alpha)
};

struct CompositeOptions {
    uint64_t seed = 1;
    uint32_t rays = 32768;  // of the last rounds of matching; an eighth before
    bool shape = true;      // match centroid and variances of the whole, not its area alone
    int rounds = 12;        // of matching, at most
    uint32_t settled =
        262144;        // rays that see mesh and solids for settle_composite(), with `shape`; 0: not
    size_t least = 4;  // parts
    size_t most = 32;
    uint32_t samples = 8192;  // rays that find what is clustered
};

/// Composites of at most 4, 8, 16 and 32 parts, those within `least` and `most` (fewer levels where
/// clusters cannot be split), nested:
/// one cluster of each level is split into two for the next part. Clusters are split where they are
/// largest (area times variance), in two by place and color (2-means). Parts hide parts of each
/// other, so each level is matched again as a whole, by rays: visible area, centroid and variances
/// are the mesh's (`wanted`), or where no sizes give all of these (plates around a closed body) the
/// ratios of the variances. No solid reaches below the lowest point of the mesh. Empty where
/// nothing can be seen. The same bits on any number of threads.
std::vector<ClusteredComposite> composites(const Mesh& mesh, const ray::SkinPtr& skin,
                                           const Attributes& wanted,
                                           const CompositeOptions& options, const Job& job = {});

/// Likewise of what has much air between its parts (foliage, crowds): clusters of all of its
/// surface, hidden or not, each as opaque as it is alone, in a shell around its surface. All shells
/// are made more or less opaque alike until the whole shows as much as the mesh. `parts`: empty, or
/// one number a triangle of what are no details of one body (leaves; see Crowd::part_of). A cluster
/// that fills its shell and is not of many parts is a solid. Nothing where nothing is clear.
/// source: 4.3.3, 4.36, 4.37 for each cluster; differs: shells are a fifth larger than the
/// variances ask for, which would leave gaps between clusters.
std::vector<ClusteredComposite> clear_composites(const Mesh& mesh, const ray::SkinPtr& skin,
                                                 std::span<const uint32_t> parts,
                                                 const Attributes& wanted,
                                                 const CompositeOptions& options,
                                                 const Job& job = {});

/// For rays: few triangles an ellipsoid, with its area.
Mesh as_large_triangles(const Composite& composite);

}  // namespace lodestone::solids
