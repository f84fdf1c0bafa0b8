// SPDX-License-Identifier: GPL-3.0-or-later
// Crossed cards: a few rectangles with pictures of a thing that is cut out of masks, as a tree is.
#pragma once

#include "base/job.h"
#include "cards/card_picture.h"
#include "model/attributes.h"
#include "model/material.h"
#include "ray/mesh_scene.h"

#include <optional>

namespace lodestone::cards {

/// The triangles of all cards of one thing.
/// Law: a quad for each side of three upright planes and two level ones.
inline constexpr size_t kCardTriangles = 20;

/// How cards are made.
struct CardOptions {
    uint64_t seed = 1;
    /// Texels along the longest side of a card.
    /// Taste: about three a pixel where cards are used at a Pixel Error of 1; with a third fewer
    /// crowns are visibly coarser in pictures, with twice as many errors are the same.
    int texels = 48;
};

/// Cards and the one material that all of them show. Their picture holds base colors and what is
/// there; the scene lights them.
struct CrossedCards {
    Mesh mesh;
    Material material;
    CardPicture picture;  // as it was before it was packed
};

/// The bytes that the picture of a mesh's cards takes in a renderer's memory, before it is made; 0
/// where there are none.
double picture_bytes(const Mesh& mesh, const glm::dvec3& middle, const CardOptions& options);

/// Cards with pictures of a mesh. `scene` holds the mesh in `skin`. Nothing where the mesh has no
/// extent or nothing of it is seen. The bits are the same on any number of threads.
std::optional<CrossedCards> crossed_cards(const Mesh& mesh, const ray::MeshScene& scene,
                                          const ray::MeshSkin& skin, const Attributes& attributes,
                                          const CardOptions& options, const Job& job);

}  // namespace lodestone::cards
