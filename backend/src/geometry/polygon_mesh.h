// SPDX-License-Identifier: GPL-3.0-or-later
// Polygon mesh: a mesh of polygons as modelers keep it, on its way to triangles.
#pragma once

#include "model/mesh.h"

#include <span>

namespace lodestone {

/// Views into the caller's memory. A corner is one vertex of one face; the corners of a face follow
/// each other around it, those of the next face come behind them.
struct PolygonMesh {
    const float* positions = nullptr;  // [vertex_count][3]
    size_t vertex_count = 0;
    std::span<const uint32_t> vertices;  // [corner]
    std::span<const uint32_t> starts;    // [face] its first corner; empty: all faces have three
    /// [triangle][3] corners, in the order of the faces; empty: faces of three and four corners are
    /// split here
    std::span<const uint32_t> triangles;
    std::span<const uint8_t> smooth;       // [face]; empty: all flat
    std::span<const int32_t> slots;        // [face]; empty: all 0
    const float* normals = nullptr;        // [corner][3]; null: made from the faces
    const float* uvs = nullptr;            // [corner][2]
    const float* colors = nullptr;         // [corner][4]
    const float* vertex_colors = nullptr;  // [vertex][4], where corners have no colors

    size_t count() const { return starts.empty() ? vertices.size() / 3 : starts.size(); }
    size_t begin(size_t face) const { return starts.empty() ? 3 * face : starts[face]; }
    size_t end(size_t face) const {
        return face + 1 == count() ? vertices.size() : begin(face + 1);
    }
};

/// Throws Error(InvalidArgument) for lengths that do not fit, indices out of range, faces that do
/// not follow each other, and a face of more than four corners without `triangles`.
void check(const PolygonMesh& faces);

/// The most corners of one face; 0: there are no faces or they do not follow each other.
size_t largest_face(std::span<const uint32_t> starts, size_t corner_count);

/// The triangles of faces, in the order of the faces: three corners each, and the face. A face of
/// four corners is split between its first and third corner, or between the others where that line
/// leaves it.
struct FaceTriangles {
    std::vector<Triangle> corners;
    std::vector<uint32_t> faces;
};
FaceTriangles triangulated(const PolygonMesh& faces);

/// The mesh with one vertex for every distinct (position, normal, uv, color). Without given normals
/// a smooth face has at each vertex the mean of the normals of all faces there, weighted by their
/// angles; a mesh without smooth faces has no normals. Given normals that equal these but for
/// rounding become these: Blender adds them up in another order each time it opens a file, and the
/// hash of a mesh must not follow that. `slot_count` > 0: slots outside become the nearest one.
Mesh mesh_of(const PolygonMesh& faces, size_t slot_count);

}  // namespace lodestone
