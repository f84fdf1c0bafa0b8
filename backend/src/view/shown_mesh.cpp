// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/shown_mesh.h"

namespace lodestone::view {

uint64_t shown_triangles(const RepresentationSummary& summary) {
    return row_of(summary.kind).viewer_triangles.value_or(summary.cost.triangles);
}

Mesh shown_mesh(const Representation& representation) {
    return tessellated(representation, row_of(representation.summary.kind).viewer_subdivisions);
}

}  // namespace lodestone::view
