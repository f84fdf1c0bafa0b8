// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/shown_mesh.h"

#include "model/composite.h"

namespace lodestone::view {
namespace {

// The subdivisions of an ellipsoid.
// Taste: more are rounder and four times the triangles each.
constexpr int kEllipsoidSubdivisions = 1;
// Law: an icosahedron's 20 triangles, each divided into four once.
constexpr uint64_t kEllipsoidTriangles = 80;
// The subdivisions of a composite's ellipsoids.
// Taste: more are rounder and four times the triangles each.
constexpr int kCompositeSubdivisions = 0;
// The triangles of a composite, at most.
// Law: 32 ellipsoids of 20 triangles.
constexpr uint64_t kCompositeTriangles = 640;

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
