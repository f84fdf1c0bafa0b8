// SPDX-License-Identifier: GPL-3.0-or-later
// LooseParts: makes a group of a mesh whose parts lie far apart (kit-bashed scenes, joined rocks).
#pragma once

#include "base/job.h"
#include "group/loose_surfaces.h"
#include "model/model.h"

#include <span>
#include <vector>

namespace lodestone::group {

/// The choices of a designer for loose parts.
struct LooseOptions {
    bool always = false;  // true: split also where it hardly pays
    // The least number of triangles of a cluster of parts: a larger value makes fewer clusters,
    // which are built sooner; a smaller one keeps less of the far parts as fine as the near ones.
    size_t fewest_triangles = 8192;
    /// Clusters of a mesh, in the mean: more triangles make larger ones.
    size_t most_clusters = 128;
};

/// The result of splitting.
struct LooseReport {
    size_t split = 0;  // meshes that became groups
    size_t parts = 0;  // loose parts that these meshes had
    size_t made = 0;   // objects that were made: clusters of parts, and groups of these
};

/// Turns leaves with a mesh of many loose parts into groups of clusters of neighboring parts, in
/// place: the object keeps its index, uid and name, Object::made_of_parts is set, and it is one
/// occurrence as before. Every cluster has its triangles, normals, texture coordinates, colors and
/// materials exactly as they were, in the frame and order they had.
///
/// Without `always` this is done to meshes of more than 50,000 triangles in more than 64 parts,
/// when at least half of the triangles are in parts no larger than an eighth of the whole. A mesh
/// that deforms, refracts (a ray in one part of it is in all of it), has one part only, or is not
/// resident is never split.
///
/// The same mesh gives the same clusters, on any number of threads; uids come from the object's and
/// from the content of a cluster. Throws Error(InvalidArgument) for an index out of range;
/// Error(Cancelled), then the model is as it was. cost: about n log n in triangles.
LooseReport split_loose_parts(Model& model, std::span<const ObjectIndex> leaves,
                              const LooseOptions& options, const Job& job);

/// The leaves below the model's root, or all leaves without a root.
std::vector<ObjectIndex> leaves_of(const Model& model);

}  // namespace lodestone::group
