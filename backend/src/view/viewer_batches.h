// SPDX-License-Identifier: GPL-3.0-or-later
// Batches: what a cut draws, in portions for a viewer that keeps them. A portion that shows the
// same in the next cut has the same key there, so that little is made and uploaded anew while the
// eye moves.
#pragma once

#include "choose/cut.h"

#include <array>

namespace lodestone::view {

/// A part of what one of cut.chosen draws. A mesh with more triangles than a batch has is cut up.
struct BatchPiece {
    uint32_t choice = 0;
    uint64_t first = 0;  // triangle
    uint64_t count = 0;
};

struct ViewerBatch {
    Hash key = 0;  // of everything it shows, its colors included; never 0
    uint64_t triangles = 0;
    std::vector<BatchPiece> pieces;  // in the order of cut.chosen
};

/// Most triangles of one batch; composites, which do not tell theirs before, may exceed it.
inline constexpr uint64_t kMostInBatch = 200'000;

/// Whatever cameras see of a cut, each triangle in exactly one batch. `colors`: linear, by choice,
/// in place of the materials'; empty: none. cost: O(nodes).
std::vector<ViewerBatch> batches_of(const Model& model, const choose::Cut& cut,
                                    const std::vector<glm::dvec3>& colors = {});

/// Ready for a graphics card.
struct BatchMesh {
    std::vector<glm::vec3> positions;  // in the world
    /// Unit normals times 32767; zero where a mesh has none (flat). The fourth: how much of the
    /// color is emitted, 0 or 32767.
    std::vector<std::array<int16_t, 4>> normals;
    /// sRGB of the base color (means of textures) or of what is emitted; the fourth is the share of
    /// light that it stops.
    std::vector<std::array<uint8_t, 4>> colors;
    std::vector<Triangle> triangles;
};

/// The meshes of its choices must be resident. Throws Error(Internal) for one that is not,
/// Error(Cancelled).
BatchMesh mesh_of(const Model& model, const choose::Cut& cut, const ViewerBatch& batch,
                  const std::vector<glm::dvec3>& colors = {}, const Job& job = {});

}  // namespace lodestone::view
