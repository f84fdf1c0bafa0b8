// SPDX-License-Identifier: GPL-3.0-or-later
// BakedImage: a new picture whose every texel is computed from other pictures' texels.
#pragma once

#include "base/job.h"
#include "image/image.h"
#include "model/texture.h"

#include <glm/vec4.hpp>

#include <vector>

namespace lodestone::image {

/// The operation of a step on the results a, b, c of earlier steps; by channel unless said
/// otherwise.
enum class BakeOp : uint8_t {
    Constant = 0,  // value
    /// The texel of texture args[0]: its picture's color and alpha; scale, offset and channel are
    /// unused.
    Texel = 1,
    Channel = 2,  // a's channel value.x (0...3), in all channels
    Luma = 3,     // the luma of a, in all channels
    Combine = 4,  // red of a, green of b, blue of c
    Add = 5,
    Subtract = 6,
    Multiply = 7,
    Divide = 8,  // 0 where b is 0
    Power = 9,   // 0 where it has no real value
    Minimum = 10,
    Maximum = 11,
    Mix = 12,      // a + c (b - a)
    Greater = 13,  // 1 where a > b, else 0
    Absolute = 14,
    Floor = 15,
    Modulo = 16,    // with a's sign; 0 where b is 0
    Ramp = 17,      // the table's RGBA at a's red, 0...1
    Curves = 18,    // each channel c of a, 0...1, to the table's channel c
    ToHsv = 19,     // hue, saturation and value 0...1
    FromHsv = 20,   // hue wraps
    ToSrgb = 21,    // display-encodes linear color
    FromSrgb = 22,  // decodes display-encoded color
};

/// One step: an operation, the numbers of the steps it takes, and its constants.
struct BakeStep {
    BakeOp op = BakeOp::Constant;
    std::array<uint32_t, 3> args{0, 0, 0};
    glm::dvec4 value{0.0};
    std::vector<glm::vec4> table;  // Ramp, Curves: evenly spaced over 0...1, linear between
};

/// The most steps of a baked picture.
/// Taste: a larger value bakes longer node graphs, for more time a texel.
inline constexpr size_t kMostBakeSteps = 256;
/// The most texels along a side of a baked picture, and of the pictures that are read for it.
/// Taste: a larger value keeps more detail, for memory and time that grow with its square.
inline constexpr int kMostBakeSide = 4096;

/// The picture of the last step's color for each texel of a picture of that size that fills 0...1 x
/// 0...1; alpha is 1. A value that is not a number counts as 0. Throws Error(InvalidArgument) when
/// a step uses a later one, or a texture or table that is not there.
Image bake(const std::vector<BakeStep>& steps, const std::vector<Texture>& textures, int width,
           int height, const Job& job = {});

/// The baked picture as an 8-bit PNG, display-encoded for Srgb, else the numbers as they are. The
/// newest pictures (256 MiB) are remembered for the life of the process: an animation bakes once.
/// May be called from any thread.
PicturePtr bake_picture(const std::vector<BakeStep>& steps, const std::vector<Texture>& textures,
                        int width, int height, ColorSpace space, const std::string& name,
                        const Job& job = {});

}  // namespace lodestone::image
