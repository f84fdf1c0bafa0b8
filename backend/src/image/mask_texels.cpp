// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/mask_texels.h"

#include "image/image.h"
#include "image/texture_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone::image {
namespace {

/// The most blocks along a side of a picture.
/// Taste: a larger value tells more exactly what a surface shows, for longer counting.
constexpr int kMostBlocks = 256;

uint8_t step_of(double alpha) {
    return static_cast<uint8_t>(std::lround(255 * std::clamp(alpha, 0.0, 1.0)));
}

/// The first texel of `count` that the one at `index` of a smaller picture covers.
int first_of(int index, int small, int count) {
    return static_cast<int>(static_cast<int64_t>(index) * count / small);
}

// Law: below 0.1, in steps of 255.
constexpr unsigned kClear = 25;
// Law: above 0.9, in steps of 255.
constexpr unsigned kFull = 230;

bool is_sure(uint8_t alpha) {
    return alpha <= kClear || alpha >= kFull;
}

/// Whether one of the texels around is sure.
bool near_sure(const MaskTexels& texels, int x, int y) {
    // Taste: edges are blurred over two texels and needles as thin; more lets blends be masks.
    constexpr int kNear = 2;
    for (int v = std::max(0, y - kNear); v <= std::min(texels.height - 1, y + kNear); ++v) {
        const uint8_t* row =
            texels.alpha.data() + static_cast<size_t>(v) * static_cast<size_t>(texels.width);
        if (std::any_of(row + std::max(0, x - kNear),
                        row + std::min(texels.width - 1, x + kNear) + 1, is_sure))
            return true;
    }
    return false;
}

bool is_edge(const MaskTexels& texels, int x, int y) {
    const size_t at = static_cast<size_t>(y) * static_cast<size_t>(texels.width);
    return !is_sure(texels.alpha[at + static_cast<size_t>(x)]) && near_sure(texels, x, y);
}

}  // namespace

MaskTexels mask_texels(const Texture& texture) {
    const PackedPtr image = packed(*texture.picture);
    const TexelMap map = number_map(texture, [](double number) {
        return static_cast<float>(std::isfinite(number) ? step_of(number) : uint8_t{0});
    });
    const TexelRows rows(*image, texture.picture->space, map);
    MaskTexels out;
    out.width = image->width;
    out.height = image->height;
    out.alpha.reserve(image->size());
    std::vector<float> row(4 * static_cast<size_t>(image->width));
    for (int y = 0; y < image->height; ++y) {
        rows.read(y, row.data());
        for (size_t i = 0; i < row.size(); i += 4)
            out.alpha.push_back(static_cast<uint8_t>(row[i]));
    }
    out.edges.reserve(out.size());
    for (int y = 0; y < out.height; ++y) {
        for (int x = 0; x < out.width; ++x)
            out.edges.push_back(is_edge(out, x, y) ? 1 : 0);
    }
    return out;
}

SeenTexels unseen_texels(int width, int height) {
    SeenTexels out;
    while ((int64_t{std::max(width, height)} + out.side - 1) / out.side > kMostBlocks)
        out.side *= 2;
    const auto blocks = [&out](int texels) {
        return static_cast<int>((int64_t{texels} + out.side - 1) / out.side);
    };
    out.columns = blocks(width);
    out.rows = blocks(height);
    out.blocks.resize(static_cast<size_t>(out.columns) * static_cast<size_t>(out.rows));
    return out;
}

bool MaskCount::is_mask() const {
    // The least spread of a mask with blurred edges.
    // Fitted: to the eleven alpha textures of a scene of leaves, water and smoke (SuperTuxKart's
    // zengarden): masks have 0.77 to 0.89, blends 0.21 at most.
    constexpr double kLeastSpread = 0.6;
    // The alpha by which those that are quite clear or there may be off.
    // Taste: five steps of 8 bits; a larger value makes films and panes opaque.
    constexpr double kOff = 0.02;
    const size_t full = sure - clear;
    const bool two_sides = clear * 20 >= seen && full * 20 >= seen;
    const bool earnest = clear_mean <= kOff && full_mean >= 1 - kOff;
    return seen > 0 && (two_sides || earnest) &&
           (sure * 20 >= seen * 19 || ((sure + edge) * 5 >= seen * 4 && spread >= kLeastSpread));
}

MaskCount count(const MaskTexels& texels, const SeenTexels& seen) {
    MaskCount out;
    std::array<uint64_t, 256> counts{};  // by alpha
    const bool known = !texels.edges.empty();
    for (int y = 0; y < texels.height; ++y) {
        const size_t first = static_cast<size_t>(y) * static_cast<size_t>(texels.width);
        const uint8_t* row = texels.alpha.data() + first;
        const uint8_t* edges = known ? texels.edges.data() + first : nullptr;
        const uint8_t* flags = seen.blocks.data() + static_cast<size_t>(y / seen.side) *
                                                        static_cast<size_t>(seen.columns);
        for (int column = 0; column < seen.columns; ++column) {
            if (flags[column] == 0)
                continue;
            const int end = std::min((column + 1) * seen.side, texels.width);
            for (int x = column * seen.side; x < end; ++x) {
                ++counts[row[x]];
                out.edge += known ? edges[x] : (is_edge(texels, x, y) ? 1u : 0u);
            }
        }
    }
    uint64_t sum = 0;
    uint64_t squares = 0;
    uint64_t clear = 0;
    uint64_t full = 0;
    for (size_t alpha = 0; alpha < counts.size(); ++alpha) {
        const uint64_t some = counts[alpha];
        const uint64_t times = alpha * some;
        out.seen += some;
        out.sure += is_sure(static_cast<uint8_t>(alpha)) ? some : 0;
        out.clear += alpha <= kClear ? some : 0;
        clear += alpha <= kClear ? times : 0;
        full += alpha >= kFull ? times : 0;
        sum += times;
        squares += alpha * times;
    }
    if (out.seen == 0)
        return out;
    const auto seen_count = static_cast<double>(out.seen);
    out.mean = static_cast<double>(sum) / 255 / seen_count;
    if (out.clear > 0)
        out.clear_mean = static_cast<double>(clear) / 255 / static_cast<double>(out.clear);
    if (out.sure > out.clear)
        out.full_mean = static_cast<double>(full) / 255 / static_cast<double>(out.sure - out.clear);
    const double most = out.mean * (1 - out.mean);
    out.spread =
        most > 0
            ? (static_cast<double>(squares) / (255.0 * 255) / seen_count - out.mean * out.mean) /
                  most
            : 1;
    return out;
}

MaskNumbers halved(const MaskTexels& texels, int halvings, std::optional<double> cutoff) {
    MaskNumbers out;
    out.width = std::max(1, texels.width >> halvings);
    out.height = std::max(1, texels.height >> halvings);
    out.alpha.resize(static_cast<size_t>(out.width) * static_cast<size_t>(out.height));
    float values[256];
    for (int i = 0; i < 256; ++i)
        values[i] = cutoff ? (i >= 255 * *cutoff ? 1.0f : 0.0f) : static_cast<float>(i) / 255;
    for (int y = 0; y < out.height; ++y) {
        const int top = first_of(y, out.height, texels.height);
        const int bottom = first_of(y + 1, out.height, texels.height);
        for (int x = 0; x < out.width; ++x) {
            const int left = first_of(x, out.width, texels.width);
            const int right = first_of(x + 1, out.width, texels.width);
            float sum = 0;
            for (int v = top; v < bottom; ++v) {
                for (int u = left; u < right; ++u)
                    sum += values[texels.alpha[static_cast<size_t>(v) *
                                                   static_cast<size_t>(texels.width) +
                                               static_cast<size_t>(u)]];
            }
            out.alpha[static_cast<size_t>(y) * static_cast<size_t>(out.width) +
                      static_cast<size_t>(x)] =
                sum / static_cast<float>((bottom - top) * (right - left));
        }
    }
    return out;
}

std::vector<uint8_t> seen_of(const SeenTexels& seen, const MaskTexels& texels, int width,
                             int height) {
    std::vector<uint8_t> out(static_cast<size_t>(width) * static_cast<size_t>(height));
    const auto block = [&](int index, int small, int size) {
        return (first_of(index, small, size) + first_of(index + 1, small, size)) / 2 / seen.side;
    };
    for (int y = 0; y < height; ++y) {
        const auto row =
            static_cast<size_t>(std::min(block(y, height, texels.height), seen.rows - 1));
        for (int x = 0; x < width; ++x) {
            const auto column =
                static_cast<size_t>(std::min(block(x, width, texels.width), seen.columns - 1));
            out[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)] =
                seen.blocks[row * static_cast<size_t>(seen.columns) + column];
        }
    }
    return out;
}

}  // namespace lodestone::image
