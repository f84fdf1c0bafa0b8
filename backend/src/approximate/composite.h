// SPDX-License-Identifier: GPL-3.0-or-later
// Composite: a surface as 4 to 32 boxes and ellipsoids, one for each cluster of what can be seen.
#pragma once

#include "approximate/replace.h"
#include "base/job.h"
#include "model/composite.h"
#include "ray/scene.h"

#include <vector>

namespace lodestone::approximate {

/// One level: a solid for each cluster, with a slot of its own.
struct Clustered {
    Composite composite;
    std::vector<Attributes> attributes;  // of the clusters, in the order of the solids
    std::vector<uint32_t> clusters;      // levels share what has the same number
};

/// Composites of at most 4, 8, 16 and 32 parts (fewer levels where clusters cannot be split), nested:
/// one cluster of each level is split into two for the next part. Clusters are split where they are
/// largest (area times variance), in two by place and color (2-means). As a whole each level shows
/// as much area as the mesh: parts hide parts of each other, so all are scaled alike. Empty where
/// nothing can be seen. The same bits on any number of threads.
std::vector<Clustered> composites(const Mesh& mesh, const ray::SkinPtr& skin, uint64_t seed,
                                  const Job& job = {});

}  // namespace lodestone::approximate
