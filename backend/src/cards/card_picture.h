// SPDX-License-Identifier: GPL-3.0-or-later
// CardPicture: one picture of all cards of a thing, side by side.
#pragma once

#include "base/job.h"
#include "cards/card_planes.h"
#include "model/texture.h"
#include "ray/mesh_scene.h"

#include <glm/vec4.hpp>

#include <array>
#include <span>
#include <vector>

namespace lodestone::cards {

/// The alpha from which on a card is there.
/// Law: half of a texel covered.
inline constexpr float kCardCutoff = 0.5F;

/// The texels of one card within the picture, from the picture's upper left corner.
struct CardPatch {
    int left = 0;
    int top = 0;
    int width = 0;
    int height = 0;
};

/// The shading normals that are seen of a thing, as a linear function of the place on a card.
class SeenNormals {
public:
    /// At (x, y), each -1...1 from border to border.
    void add(const glm::dvec2& at, const glm::dvec3& normal);
    void add(const SeenNormals& other);
    /// The sum of least squares; zero where nothing was seen.
    glm::dvec3 at(const glm::dvec2& place) const;

private:
    glm::dmat3 squares_{0.0};  // of (1, x, y)
    glm::dmat3 sums_{0.0};     // columns: of normals times 1, x, y
};

struct CardPicture {
    int width = 0;
    int height = 0;
    std::vector<CardPatch> patches;                   // by plane
    std::vector<std::array<SeenNormals, 2>> normals;  // by plane, seen from its front and its back
    std::vector<glm::vec4> texels;  // top row first: linear color, straight; share that is covered

    size_t index(int column, int row) const {
        return static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column);
    }
};

/// An empty picture with a place for each plane, in a row, with clear texels around each. The
/// longest side of a plane has `texels` of them, fewer where the picture would be larger than what
/// measuring looks at (image::TexelCache).
CardPicture picture_of_cards(std::span<const CardPlane> planes, int texels);

/// Fills it with what is seen of a mesh along the planes' normals, in the mean from both sides, in
/// base color. `scene` holds the mesh in `skin`. The bits are the same on any number of threads.
void cast_picture(CardPicture& picture, std::span<const CardPlane> planes, const Mesh& mesh,
                  const ray::MeshScene& scene, const ray::MeshSkin& skin, uint64_t seed,
                  const Job& job);

/// Gives texels that nothing covers the color of those around them, for interpolation and shrinking
/// mix these in.
void fill_clear(CardPicture& picture);

/// The texture that shows the picture's colors: a PNG of 8 bits whose brightest channel is 1, and
/// what it is to be multiplied with, at most 1: files of others cannot say more.
Texture texture_of(const CardPicture& picture);

}  // namespace lodestone::cards
