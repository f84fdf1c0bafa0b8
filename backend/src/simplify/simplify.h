// SPDX-License-Identifier: GPL-3.0-or-later
// Simplify: the same surface with fewer triangles, by collapsing edges.
#pragma once

#include "base/job.h"
#include "model/mesh.h"

#include <span>
#include <utility>
#include <vector>

namespace lodestone::simplify {

/// The mode. Fast: collapses and one fit to the original. Best: each level of mode fast, fitted
/// longer, vertex by vertex where that is nearer to the original, so that no error it measures is
/// larger than in mode fast: mostly a twentieth less, for three to nine times the time.
enum class SimplifyMode : uint8_t { Fast, Best };

/// The defaults are tuned on scans, CAD parts and terrain; most callers need no other values.
struct SimplifyOptions {
    SimplifyMode mode = SimplifyMode::Fast;
    /// How many times more it costs to move the border between two material slots than to move the
    /// surface; for open borders a seventh of it counts. A larger value keeps outlines and paint
    /// lines longer and spends the triangles there; 0 lets them shrink.
    double boundary_weight = 8;
    /// The same for texture seams and sharp (split-normal) edges. 0 lets textures slide at seams.
    double seam_weight = 1;
    /// A triangle may turn by at most this angle in one collapse, degrees in (0, 90). A larger one
    /// reaches coarse targets with less error but may fold thin parts over.
    double max_turn = 70;
    /// Removing a separate part of the mesh costs at least this many times what squeezing it to a
    /// point would; one that stands alone costs more. A larger value keeps screws and leaves
    /// longer, at the cost of the large parts' shape.
    double part_weight = 4;
    /// Every part, hole, handle and border stays, and no edge becomes non-manifold. Targets that
    /// this does not allow are missed. Otherwise the small ones close or vanish where a target
    /// needs it.
    bool keep_topology = false;
};

/// Simplifies in one pass and returns the mesh at each of `targets` (triangle counts, strictly
/// falling, > 0). A target not below the input's count returns the input itself; else a result has
/// at most its target, and at least one triangle if the input has any. Fewer results come back when
/// nothing more can be collapsed. Results keep slots, and have normals, uvs and colors if the input
/// has. Separate parts too small for a target disappear as a whole, the smallest first. Any input
/// is accepted: non-manifold edges are kept as curves, triangles with non-finite vertices are left
/// out. Throws Error(InvalidArgument) as check(mesh) does, or for targets that do not fall, or for
/// options out of range. Any number of threads gives the same bits. Memory: 100 bytes a triangle
/// above the input, more where few triangles are removed, because the fit then has many samples.
/// source: Lindstrom & Turk 1999 (memoryless quadrics, volume constraint), in batches; then Hoppe
/// et al. 1993 (vertices fitted to the original).
std::vector<Mesh> simplify_chain(const Mesh& mesh, std::span<const size_t> targets,
                                 const SimplifyOptions& options = {}, const Job& job = {});

/// A level, with what became of its input's vertices.
struct TracedLevel {
    Mesh mesh;
    std::vector<uint32_t> places;  // the place of each of its vertices: split ones share one
    /// The pair (place, input vertex) for each input vertex that ended up there, ascending; of
    /// vertices at one position the lowest. A vertex that vanished with its part is in no pair.
    std::vector<std::pair<uint32_t, uint32_t>> origins;
};

/// The same for a mesh that deforms: the collapses suit the mesh and `others` together, which are
/// the positions of its vertices in other frames (each has as many, all finite). The levels are
/// those of the mesh; a mesh without extent has none. Memory: 60 bytes a triangle more for each of
/// the others. source: Mohr & Gleicher 2003 (deformation sensitive decimation), with memoryless
/// quadrics.
std::vector<TracedLevel> simplify_traced(const Mesh& mesh,
                                         std::span<const std::vector<glm::vec3>> others,
                                         std::span<const size_t> targets,
                                         const SimplifyOptions& options = {}, const Job& job = {});

/// The mesh at one target; the coarsest that can be reached when that is still above it.
Mesh simplify_mesh(const Mesh& mesh, size_t triangles, const SimplifyOptions& options = {},
                   const Job& job = {});

}  // namespace lodestone::simplify
