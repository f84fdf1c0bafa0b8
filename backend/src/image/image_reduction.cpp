// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/image_reduction.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cstdint>

namespace lodestone::image {
namespace {

/// The first texel of `count` that the one at `index` of a smaller picture covers.
int begin_of(int index, int small, int count) {
    return static_cast<int>(static_cast<int64_t>(index) * count / small);
}

}  // namespace

Image reduced(const Image& from, int width, int height) {
    Image to;
    to.width = std::clamp(width, 1, std::max(1, from.width));
    to.height = std::clamp(height, 1, std::max(1, from.height));
    to.linear = from.linear;
    to.pixels.resize(from.pixels.empty() ? 0 : 4 * to.size());
    float* out = to.pixels.data();
    for (int y = 0; y < to.height && !to.pixels.empty(); ++y) {
        const int top = begin_of(y, to.height, from.height);
        const int bottom = begin_of(y + 1, to.height, from.height);
        for (int x = 0; x < to.width; ++x, out += 4) {
            const int left = begin_of(x, to.width, from.width);
            const int right = begin_of(x + 1, to.width, from.width);
            glm::dvec4 sum(0.0);
            glm::dvec3 plain(0.0);
            for (int v = top; v < bottom; ++v) {
                const float* at = from.pixels.data() +
                                  4 * (static_cast<size_t>(v) * static_cast<size_t>(from.width) +
                                       static_cast<size_t>(left));
                for (int u = left; u < right; ++u, at += 4) {
                    const glm::dvec3 color(at[0], at[1], at[2]);
                    const auto alpha = static_cast<double>(at[3]);
                    sum += glm::dvec4(alpha * color, alpha);
                    plain += color;
                }
            }
            const double count = static_cast<double>(bottom - top) * (right - left);
            const glm::dvec3 color = sum.w > 0 ? glm::dvec3(sum) / sum.w : plain / count;
            for (int c = 0; c < 3; ++c)
                out[c] = static_cast<float>(color[c]);
            out[3] = static_cast<float>(sum.w / count);
        }
    }
    return to;
}

void spread_into_clear(Image& image) {
    // The alpha from which on a texel's own color is known.
    // Taste: what is fainter is often rounded, or the background's; a larger value blurs edges.
    constexpr float kKnown = 0.1f;
    bool clear = false;
    for (size_t i = 3; i < image.pixels.size(); i += 4) {
        if (image.pixels[i] >= kKnown)
            continue;
        image.pixels[i] = 0;
        clear = true;
    }
    if (!clear || image.size() <= 1)
        return;
    Image small = reduced(image, (image.width + 1) / 2, (image.height + 1) / 2);
    for (size_t i = 3; i < small.pixels.size(); i += 4)
        small.pixels[i] = small.pixels[i] > 0 ? 1.0f : 0.0f;
    spread_into_clear(small);
    float* at = image.pixels.data();
    for (int y = 0; y < image.height; ++y) {
        const auto row = static_cast<size_t>(static_cast<int64_t>(y) * small.height / image.height);
        for (int x = 0; x < image.width; ++x, at += 4) {
            if (at[3] > 0)
                continue;
            const auto column =
                static_cast<size_t>(static_cast<int64_t>(x) * small.width / image.width);
            const size_t around = 4 * (row * static_cast<size_t>(small.width) + column);
            std::copy_n(small.pixels.begin() + static_cast<ptrdiff_t>(around), 3, at);
        }
    }
}

}  // namespace lodestone::image
