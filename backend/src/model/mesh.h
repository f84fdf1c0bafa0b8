// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh: triangles with optional normals, texture coordinates and material slots.
#pragma once

#include "base/error.h"
#include "base/hash.h"
#include "base/maths.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace lodestone {

using Triangle = glm::uvec3;

/// A vertex is one (position, normal, uv, color); a seam or sharp edge splits it. Metres, object's
/// frame.
struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;  // empty (flat shaded), or unit, one a vertex
    std::vector<glm::vec2> uvs;      // empty, or one a vertex
    std::vector<glm::vec4> colors;   // empty (white), or one a vertex: linear RGBA, straight
    std::vector<Triangle> triangles;
    std::vector<uint16_t> slots;  // empty (all in slot 0), or one a triangle

    bool empty() const { return triangles.empty(); }
    uint16_t slot(size_t triangle) const { return slots.empty() ? uint16_t{0} : slots[triangle]; }
};

/// Twice the area of a triangle times its unit normal.
glm::dvec3 area_vector(const Mesh& mesh, size_t triangle);
double surface_area(const Mesh& mesh);
Hash hash_of(const Mesh& mesh);

/// Checks the caller's side: array sizes fit, every index < vertex count, at most 2^31 of each.
/// Throws Error(InvalidArgument): "triangle 0 uses vertex 7 of 3".
void check(const Mesh& mesh);

/// Mends the user's side: drops triangles that use a non-finite vertex, replaces non-finite or zero
/// normals by the face's, non-finite uvs by 0 and colors by white, drops vertices nothing uses.
/// Zero-area triangles stay (they draw nothing). Adds one problem per cause, naming `object`.
void repair(Mesh& mesh, const std::string& object, Problems& problems);

/// Appends `part`, transformed, with its slots raised by `first_slot`. Mirrored parts are turned so
/// that their outside stays outside. A side that lacks normals while the other has them gets flat
/// ones (vertices split); missing uvs become 0, missing colors white.
void append(Mesh& mesh, const Mesh& part, const Affine& transform, uint16_t first_slot = 0);

/// Only the triangles with keep[i] != 0, and the vertices they use.
Mesh subset(const Mesh& mesh, const std::vector<uint8_t>& keep);

/// For each vertex the lowest vertex at the same position (+0 and -0 are the same).
std::vector<uint32_t> weld(const Mesh& mesh);

/// True when every welded edge is used exactly twice, in opposite directions (then only the outer
/// side of the surface can be seen from outside).
bool closed(const Mesh& mesh);

}  // namespace lodestone
