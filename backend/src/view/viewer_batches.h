// SPDX-License-Identifier: GPL-3.0-or-later
// Viewer batches: the drawing of a cut in portions, for a viewer that keeps them. A portion that
// shows the same in the next cut has the same key there, so that little is made and uploaded anew
// while the eye moves.
#pragma once

#include "choose/cut.h"

#include <array>

namespace lodestone::view {

/// A part of the drawing of one of cut.chosen. A mesh with more triangles than a batch holds is
/// divided.
struct BatchPiece {
    uint32_t choice = 0;
    uint64_t first = 0;  // its first triangle
    uint64_t count = 0;
};

struct ViewerBatch {
    Hash key = 0;  // the hash of everything it shows, its colors included; never 0
    uint64_t triangles = 0;
    std::vector<BatchPiece> pieces;  // in the order of cut.chosen
};

/// The most triangles of one batch; composites, whose triangles are not known before, may exceed
/// it.
/// Taste: larger batches are fewer calls to draw and change more often.
inline constexpr uint64_t kMostInBatch = 200'000;

/// Everything of a cut that cameras see, each triangle in exactly one batch. `colors`: linear, by
/// choice, in place of the materials' colors; empty: none. cost: O(nodes).
std::vector<ViewerBatch> batches_of(const Model& model, const choose::Cut& cut,
                                    const std::vector<glm::dvec3>& colors = {});

/// A batch as arrays for a graphics card.
struct BatchMesh {
    std::vector<glm::vec3> positions;  // in the world
    /// The unit normals times 32767; zero where a mesh has none (flat). The fourth number: how much
    /// of the color is emitted, 0 or 32767.
    std::vector<std::array<int16_t, 4>> normals;
    /// The base color (for textures their mean) or the emitted color, in sRGB; the fourth number is
    /// the share of light that it stops.
    std::vector<std::array<uint8_t, 4>> colors;
    std::vector<Triangle> triangles;
};

/// The meshes of the batch's choices must be resident. Throws Error(Internal) for one that is not,
/// Error(Cancelled).
BatchMesh mesh_of(const Model& model, const choose::Cut& cut, const ViewerBatch& batch,
                  const std::vector<glm::dvec3>& colors = {}, const Job& job = {});

}  // namespace lodestone::view
