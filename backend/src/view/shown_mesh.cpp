// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/shown_mesh.h"

#include "model/composite.h"

namespace lodestone::view {
namespace {

constexpr int kEllipsoidSubdivisions = 1;
constexpr uint64_t kEllipsoidTriangles = 80;
constexpr int kCompositeSubdivisions = 0;
constexpr uint64_t kCompositeTriangles = 640;  // 32 ellipsoids

}  // namespace

uint64_t shown_triangles(const RepresentationSummary& summary) {
    switch (summary.kind) {
        case Kind::Mesh:
            return summary.cost.triangles;
        case Kind::Box:
            return kBoxTriangles;
        case Kind::Ellipsoid:
            return kEllipsoidTriangles;
        case Kind::Composite:
            return kCompositeTriangles;
        case Kind::Assembly:
            break;
    }
    return 0;
}

Mesh shown_mesh(const Representation& representation) {
    const bool composite = representation.summary.kind == Kind::Composite;
    return tessellated(representation, composite ? kCompositeSubdivisions : kEllipsoidSubdivisions);
}

}  // namespace lodestone::view
