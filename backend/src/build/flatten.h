// SPDX-License-Identifier: GPL-3.0-or-later
// Flatten: a group as one mesh, its children at the detail asked for.
#pragma once

#include "build/stand_ins.h"

namespace lodestone::build {

struct Flat {
    Mesh mesh;                         // in the group's frame
    std::vector<Material> materials;   // by slot
    std::vector<uint32_t> occurrence;  // a triangle: which of the drawn things it is of
    size_t occurrences = 0;
    std::vector<uint32_t> placement;   // an occurrence: which of the group's it is below
    std::vector<uint8_t> environment;  // likewise: whether it is, or is below, what is marked so
    double child_error = 0;  // the largest error of a child drawn, after its stretch; metres
};

/// Children are drawn by their cheapest representation within `error` metres (0: the finest);
/// primitives as triangles.
Flat flatten(const Model& model, ObjectIndex group, double error, const MeshSource& source,
             const Job& job);

/// What an occurrence of the group's children is within an error.
struct Drawn {
    uint64_t triangles = 0;  // of the flat mesh
    double bytes = 0;        // in POV-Ray
    double alone = 0;        // likewise, with all of each representation's: as the cut counts
};

/// Bytes: a share of every representation (its bytes over its object's uses, for all occurrences
/// share it) and the occurrences themselves. The group's own stand-ins do not count.
Drawn drawn_within(const Model& model, ObjectIndex group, double error,
                   const std::vector<uint64_t>& uses, const Job& job);

/// At which error to flatten a group: much below that of the finest stand-in that could cost less
/// than the children do at its error, and at most a sixteenth of the size. Flat meshes of what its
/// children share with other groups are dear: the less a group can save, the coarser its reference
/// may be. Coarser only to have at most `wanted` triangles, or little more than at an error that is
/// still fine (1/32 of the size); and then where those would be more than `most`.
double error_to_flatten(const Model& model, ObjectIndex group, uint64_t wanted, uint64_t most,
                        const std::vector<uint64_t>& uses, const Job& job);

}  // namespace lodestone::build
