// SPDX-License-Identifier: GPL-3.0-or-later
// Corner wedges: the normals, texture coordinates and colors of corners, carried through collapses.
#pragma once

#include "simplify/collapse/adjacency.h"

namespace lodestone::simplify {

/// Makes the wedges of `mesh`, which hold the source's vertices before: corners of one vertex whose
/// attributes agree (normals within 1 degree) share a wedge.
void make_wedges(CollapseMesh& mesh, const Mesh& source);

/// True when (almost) every triangle shows its own face normal and neighbors differ: flat shading,
/// written as split normals. Such normals are made anew, not carried.
bool shows_faces(const CollapseMesh& mesh, const Mesh& source);

/// The changes that one collapse makes to the wedges around the two ends of an edge.
class WedgeMerge {
public:
    /// Plans the collapse of a and b to `point`; must be called before anything is changed. Wedges
    /// that a triangle on the edge joins become one; its value is taken from the old surface at the
    /// place nearest to `point`. False: two wedges of one end would be joined, which smears a seam
    /// (`join_seams` keeps them apart and allows it).
    bool plan(const CollapseMesh& mesh, const Adjacency& adjacency, uint32_t a, uint32_t b,
              const glm::dvec3& point, bool join_seams);
    /// Writes the planned values.
    void apply(CollapseMesh& mesh);
    uint32_t wedge_of(uint32_t old_wedge) const;

private:
    struct WedgeMember {
        uint32_t wedge;
        uint32_t group;  // the index of the member that stands for it
        bool at_a;
    };
    struct WedgeValue {
        glm::dvec3 normal{0.0};
        glm::dvec2 uv{0.0};
        glm::dvec4 color{0.0};
        double square = 0;
    };
    uint32_t find_or_add(uint32_t wedge, bool at_a);
    std::vector<WedgeMember> members_;
    std::vector<WedgeValue> values_;
};

}  // namespace lodestone::simplify
