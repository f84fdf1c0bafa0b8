// SPDX-License-Identifier: GPL-3.0-or-later
// Surface level: a level of a large surface (terrain, scan, hull), with the chunks that a picture
// may take from it. Levels of one surface come from one simplification, in which vertices on
// borders of chunks never move, but vanish into others there: so borders of coarse levels are
// subsets of finer ones. source: dissertation 3.2.2.
#pragma once

#include "model/mesh.h"

#include <memory>
#include <vector>

namespace lodestone {

/// The most cuts from a whole surface to one of its chunks.
/// Law: chunks are counted in 16 bits.
inline constexpr uint32_t kDeepestSurface = 15;

/// A plane across an axis that parts a region of a surface in two.
struct SurfacePlane {
    uint32_t axis = 0;
    /// Triangles whose corners' sum along the axis is less are in the first half.
    double sum = 0;
};

/// The chunks of a large surface: the leaves of a complete binary tree, numbered from left to
/// right. Nodes above them are numbered likewise: that of a leaf is (leaf >> shift).
struct SurfaceTree {
    uint32_t depth = 0;                // 2^depth chunks
    std::vector<SurfacePlane> planes;  // 2^depth - 1; below plane i are 2 i + 1 and 2 i + 2
    std::vector<Box3> boxes;           // of the original's triangles in each chunk; may be empty
    Hash hash = 0;                     // of the original and of the settings it was parted with

    uint32_t chunks() const { return 1u << depth; }
    /// The chunk of a triangle of the original.
    uint32_t chunk_of(const Mesh& mesh, size_t triangle) const;
};

/// A vertex on borders of chunks, in one level.
struct BorderPoint {
    uint32_t source = 0;  // its number in all levels of the surface
    uint32_t dies = 0;    // the first step at which it is gone, or kLasts
    uint32_t heir = 0;    // the border point of this level that it moves to then
    uint32_t touch = 0;   // the first of the chunks around it, in SurfaceLevel::touches
    /// It lasts as long as a border runs through it.
    static constexpr uint32_t kLasts = ~uint32_t{0};
};

/// A vertex of a level's mesh that lies at a border point.
struct BorderCorner {
    uint32_t vertex = 0;
    uint32_t point = 0;
};

struct SurfaceLevel {
    std::shared_ptr<const SurfaceTree> tree;
    uint32_t step = 0;   // the place in the simplification: 0 is the original, larger is coarser
    uint32_t shift = 0;  // its nodes are those (leaf >> shift)
    /// The triangles of the nodes before each node, and of all. Triangles of a simpler level lie in
    /// the order of nodes; those of the original in its own.
    std::vector<uint32_t> before;
    /// The error of each node, metres; empty: the level's own counts everywhere. A level's error is
    /// that of nearly all of it: single nodes may have larger ones.
    std::vector<double> errors;
    std::vector<BorderPoint> points;
    std::vector<uint16_t> touches;      // rising for each point
    std::vector<BorderCorner> corners;  // by rising vertex
    Hash hash = 0;                      // of all of it

    uint32_t nodes() const { return tree->chunks() >> shift; }
    uint32_t triangles_of(uint32_t node) const { return before[node + 1] - before[node]; }
    /// The error of a node of a level whose own is `whole`.
    double error_of(uint32_t node, double whole) const {
        return errors.empty() ? whole : errors[node];
    }
};

/// The hash of all that a level holds but its hash.
Hash hash_of(const SurfaceLevel& level);

/// Throws Error(BadFile) for a level that cannot be one of a mesh of so many vertices and
/// triangles.
void check(const SurfaceLevel& level, size_t vertices, size_t triangles);

}  // namespace lodestone
