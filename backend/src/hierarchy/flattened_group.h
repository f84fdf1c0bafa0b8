// SPDX-License-Identifier: GPL-3.0-or-later
// Flatten: a group as one mesh, its children at the detail asked for.
#pragma once

#include "hierarchy/mesh_source.h"
#include "hierarchy/opened_group.h"

namespace lodestone::hierarchy {

struct FlattenedGroup {
    Mesh mesh;                            // in the group's frame
    std::vector<Material> materials;      // by slot
    std::vector<SourceMaterial> sources;  // likewise, where these are from
    std::vector<uint32_t> occurrence;     // a triangle: which of the drawn things it is of
    size_t occurrences = 0;
    std::vector<uint32_t> placement;   // an occurrence: which of the group's it is below
    std::vector<uint8_t> environment;  // likewise: whether it is, or is below, what is marked so
    double child_error = 0;  // the largest error of a child drawn, after its stretch; metres
};

/// Children are drawn by their cheapest representation within `error` metres (0: the finest);
/// primitives as triangles.
FlattenedGroup flatten_group(OpenedGroup& group, double error, const MeshSource& source,
                             const Job& job);

/// At which error to flatten a group: much below that of the finest stand-in that could cost less
/// than the children do at its error, and at most an eighth of the size. Flat meshes of what its
/// children share with other groups are dear: the less a group can save, the coarser its reference
/// may be. Coarser only to have at most `wanted` triangles, or little more than at an error that is
/// still fine (1/32 of the size); and then where those would be more than `most`.
double error_to_flatten(OpenedGroup& group, uint64_t wanted, uint64_t most, const Job& job);

}  // namespace lodestone::hierarchy
