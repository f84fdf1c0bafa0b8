// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse/adjacency.h"

namespace lodestone::simplify {

void Adjacency::build(const CollapseMesh& mesh) {
    first.assign(mesh.points.size() + 1, 0);
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (mesh.dead(i))
            continue;
        for (int corner = 0; corner < 3; ++corner)
            ++first[mesh.triangles[i][corner] + 1];
    }
    for (size_t v = 0; v < mesh.points.size(); ++v)
        first[v + 1] += first[v];
    triangles.resize(first.back());
    // The starts are shifted by one: filling moves the start of v, kept at v + 1, to where v ends.
    for (size_t v = mesh.points.size(); v > 0; --v)
        first[v] = first[v - 1];
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (mesh.dead(i))
            continue;
        for (int corner = 0; corner < 3; ++corner)
            triangles[first[mesh.triangles[i][corner] + 1]++] = static_cast<uint32_t>(i);
    }
}

}  // namespace lodestone::simplify
