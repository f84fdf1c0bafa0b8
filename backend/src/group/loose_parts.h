// SPDX-License-Identifier: GPL-3.0-or-later
// Loose parts: makes a group of a mesh whose parts lie far apart (kit-bashed scenes, joined rocks).
#pragma once

#include "base/job.h"
#include "group/loose_surfaces.h"
#include "model/model.h"

#include <span>
#include <vector>

namespace lodestone::group {

struct LooseOptions {
    bool always = false;  // also where it hardly pays
    // Triangles of a cluster of parts, at least: a larger number makes fewer clusters, which are
    // built sooner; a smaller one keeps less of what is far as fine as what is near it.
    size_t fewest_triangles = 8192;
    size_t most_clusters = 128;  // of one mesh, in the mean: more triangles make larger ones
};

struct LooseReport {
    size_t split = 0;  // meshes that became groups
    size_t parts = 0;  // loose parts these had
    size_t made = 0;   // objects that were made: clusters of parts, and groups of these
};

/// Turns leaves with a mesh of many loose parts into groups of clusters of neighboring parts, in
/// place: the object keeps its index, uid and name, Object::made_of_parts is set, and it is one
/// occurrence as before. Every cluster has its triangles, normals, texture coordinates, colors and
/// materials exactly as they were, in the frame and order they had.
///
/// Without `always` this is done to more than 50,000 triangles in more than 64 parts, when at least
/// half of the triangles are in parts no larger than an eighth of the whole. What deforms, and what
/// refracts (a ray in one part of it is in all of it), is never split, nor is what is one part, or
/// not resident.
///
/// The same mesh gives the same clusters, on any number of threads; uids come from the object's and
/// from what is in a cluster. Throws Error(InvalidArgument) for an index out of range;
/// Error(Cancelled), then the model is as it was. cost: about n log n in triangles.
LooseReport split_loose_parts(Model& model, std::span<const ObjectIndex> leaves,
                              const LooseOptions& options, const Job& job);

/// The leaves below the model's root, or all without one.
std::vector<ObjectIndex> leaves_of(const Model& model);

}  // namespace lodestone::group
