// SPDX-License-Identifier: GPL-3.0-or-later
// Composite replacement: a surface as 4 to 32 boxes and ellipsoids, one for each cluster of its
// visible parts.
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
    std::vector<Attributes> attributes;  // those of the clusters, in the order of the solids
    std::vector<uint32_t> clusters;      // levels share the clusters with equal numbers
    std::vector<double> opacities;       // those of the solids; 1: not clear (see surface_alpha)
};

struct CompositeOptions {
    uint64_t seed = 1;
    uint32_t rays = 32768;  // in the last rounds of matching; an eighth in the rounds before
    bool boxes = false;     // boxes alone, where there is one for a cluster
    bool shape = true;      // match centroid and variances of the whole, too, not only its area
    int rounds = 12;        // the most rounds of matching
    /// The rays by which settle_composite() measures mesh and solids, with `shape`; 0: it is not
    /// called.
    uint32_t settled = 262144;
    size_t least = 4;  // the fewest parts of a level
    size_t most = 32;
    uint32_t samples = 8192;  // the rays that find the clustered points
};

/// Composites of at most 4, 8, 16, 32, 64 and 128 parts, those within `least` and `most` (fewer
/// levels where clusters cannot be split). They are nested: one cluster of each level is split into
/// two for the next part. The largest cluster (area times variance) is split in two by place and
/// color (2-means). Parts hide parts of each other, so each level is matched again as a whole, by
/// rays: visible area, centroid and variances are the mesh's (`wanted`), or where no sizes give all
/// of these (plates around a closed body) the ratios of the variances. No solid reaches below the
/// lowest point of the mesh. Empty where nothing can be seen. Any number of threads gives the same
/// bits.
std::vector<ClusteredComposite> composites(const Mesh& mesh, const ray::SkinPtr& skin,
                                           const Attributes& wanted,
                                           const CompositeOptions& options, const Job& job = {});

/// The composites of a surface with much air between its parts (foliage, crowds): clusters of all
/// of its surface, hidden or not, each as opaque as it is alone, in a shell around its surface. All
/// shells are made more or less opaque by the same factor until the whole shows as much as the
/// mesh. `parts`: empty, or for each triangle the number of its part, where parts are not details
/// of one body (leaves; see Crowd::part_of). A cluster that fills its shell and does not have many
/// parts is a solid. Empty where nothing is clear. source: 4.3.3, 4.36, 4.37 for each cluster;
/// differs: shells are a fifth larger than the variances ask for, because there would be gaps
/// between clusters.
std::vector<ClusteredComposite> clear_composites(const Mesh& mesh, const ray::SkinPtr& skin,
                                                 std::span<const uint32_t> parts,
                                                 const Attributes& wanted,
                                                 const CompositeOptions& options,
                                                 const Job& job = {});

/// The composite for rays: few triangles for each ellipsoid, with the area of the ellipsoid.
Mesh as_large_triangles(const Composite& composite);

}  // namespace lodestone::solids
