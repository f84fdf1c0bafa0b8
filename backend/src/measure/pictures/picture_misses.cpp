// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/pictures/picture_misses.h"

#include <glm/common.hpp>

#include <array>
#include <utility>

namespace lodestone::measure {
namespace {

/// The means over a pixel: over every other sample, and over those between.
struct HalvedPixel {
    std::array<glm::dvec4, 2> halves;

    HalvedPixel(const glm::vec4* corner, int stride, int side, bool odd) {
        using Two = double __attribute__((vector_size(16)));
        struct HalfSum {
            Two low{};
            Two high{};

            void add(const glm::vec4& sample) {
                low += Two{static_cast<double>(sample.x), static_cast<double>(sample.y)};
                high += Two{static_cast<double>(sample.z), static_cast<double>(sample.w)};
            }
            glm::dvec4 mean(int count) const {
                return glm::dvec4(low[0], low[1], high[0], high[1]) / static_cast<double>(count);
            }
        };
        HalfSum first;  // the half that the row begins with
        HalfSum second;
        for (int y = 0; y < side; ++y) {
            const glm::vec4* const row = corner + static_cast<ptrdiff_t>(y) * stride;
            for (int x = 0; x < side; x += 2)
                first.add(row[x]);
            for (int x = 1; x < side; x += 2)
                second.add(row[x]);
            std::swap(first, second);
        }
        if (side % 2 != 0)
            std::swap(first, second);
        const int count = side * side / 2;
        halves[odd ? 1 : 0] = first.mean(side * side - count);
        halves[odd ? 0 : 1] = second.mean(count);
    }
};

}  // namespace

std::vector<PictureRect> picture_rects(const std::vector<glm::vec4>& a,
                                       const std::vector<glm::vec4>& b, size_t views, int side) {
    std::vector<PictureRect> out(views, {glm::ivec2(side), glm::ivec2(0)});
    size_t at = 0;
    for (PictureRect& part : out) {
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column, ++at) {
                if (!(a[at].w > 0 || b[at].w > 0))
                    continue;
                const glm::ivec2 here(column, row);
                part.low = glm::min(part.low, here);
                part.high = glm::max(part.high, here + 1);
            }
        }
    }
    return out;
}

PixelMisses pixel_misses(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b,
                         const std::vector<PictureRect>& parts, int side, int pixel) {
    // Law: the smallest alpha of 8 bits that is not 0; compare() covers pixels by the same.
    constexpr double kCovered = 1.0 / 255;
    PixelMisses out;
    for (size_t view = 0; view < parts.size(); ++view) {
        const glm::ivec2 low = parts[view].low / pixel * pixel;
        for (int row = low.y; row < parts[view].high.y; row += pixel) {
            for (int column = low.x; column < parts[view].high.x; column += pixel) {
                const size_t at = (view * static_cast<size_t>(side) + static_cast<size_t>(row)) *
                                      static_cast<size_t>(side) +
                                  static_cast<size_t>(column);
                const bool odd = (row / pixel + column / pixel) % 2 != 0;
                const HalvedPixel first(&a[at], side, pixel, odd);
                const HalvedPixel second(&b[at], side, pixel, odd);
                if (std::max(first.halves[0].w + first.halves[1].w,
                             second.halves[0].w + second.halves[1].w) <= 2 * kCovered)
                    continue;
                ++out.covered;
                const std::array<glm::dvec4, 2> off{first.halves[0] - second.halves[0],
                                                    first.halves[1] - second.halves[1]};
                out.coverage.add(off[0].w, off[1].w);
                for (int i = 0; i < 3; ++i)
                    out.light.add(off[0][i], off[1][i]);
                for (const glm::dvec4& half : first.halves)
                    out.finest_light += 0.5 * (half.x + half.y + half.z);
            }
        }
    }
    return out;
}

}  // namespace lodestone::measure
