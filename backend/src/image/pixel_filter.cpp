// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/pixel_filter.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace lodestone::image {
namespace {

/// The share of a pixel that goes to each of its two neighbors in one pass: twice as much is the
/// variance of the pass.
/// Law: 1, 2, 1: more makes single pixels darker than what is around them.
constexpr double kMostShare = 0.25;

/// The variance of a Blackman-Harris window over -1/2 ... 1/2.
/// source: A. H. Nuttall, Some windows with very good sidelobe behavior (1981): its coefficients.
double variance_of_window() {
    // Law: the window's coefficients.
    constexpr double kTerms[] = {0.35875, 0.48829, 0.14128, 0.01168};
    double sum = kTerms[0] / 12;
    for (int k = 1; k < 4; ++k) {
        // The integral of x^2 cos(2 pi k x), whose sign makes the window's alternating terms equal.
        const double second = 1 / (2 * std::numbers::pi * std::numbers::pi * k * k);
        sum += kTerms[k] * (k % 2 == 0 ? second : -second);
    }
    return sum / kTerms[0];
}

/// One pass over `count` lines, `stride` floats apart, of `breadth` floats side by side.
void spread_lines(float* line, size_t count, size_t stride, size_t breadth, float share) {
    std::vector<float> before(line, line + breadth);
    for (size_t i = 0; i < count; ++i, line += stride) {
        const float* const after = i + 1 < count ? line + stride : line;
        for (size_t c = 0; c < breadth; ++c) {
            const float own = line[c];
            line[c] = own + share * ((before[c] - own) + (after[c] - own));
            before[c] = own;
        }
    }
}

}  // namespace

double missing_spread(double filter_size, int samples_along_side) {
    if (!(filter_size > 0))
        return 0;
    const double support = 2 * std::min(filter_size, kMostFilterSize);
    const double side = std::max(samples_along_side, 1);
    const double sampled = (1 - 1 / (side * side)) / 12;
    return std::max(0.0, support * support * variance_of_window() - sampled);
}

int spread_reach(double variance) {
    return variance > 0 ? static_cast<int>(std::ceil(variance / (2 * kMostShare))) : 0;
}

void spread_pixels(Image& image, double variance, const ImageRegion& part) {
    if (part.left < 0 || part.top < 0 || part.width < 1 || part.height < 1 ||
        int64_t{part.left} + part.width > image.width ||
        int64_t{part.top} + part.height > image.height || image.pixels.size() != 4 * image.size())
        fail(Status::InvalidArgument, "a picture of ", image.width, " x ", image.height,
             " has no part of ", part.width, " x ", part.height, " at ", part.left, ", ", part.top);
    if (!(variance > 0))
        return;
    const auto width = static_cast<size_t>(part.width);
    const auto height = static_cast<size_t>(part.height);
    const size_t row = 4 * static_cast<size_t>(image.width);
    float* const first = image.pixels.data() + row * static_cast<size_t>(part.top) +
                         4 * static_cast<size_t>(part.left);
    for (size_t y = 0; y < height; ++y) {
        float* const line = first + y * row;
        std::replace_if(
            line, line + 4 * width, [](float value) { return !std::isfinite(value); }, 0.0f);
    }
    const int passes = spread_reach(variance);  // each reaches a pixel farther
    const auto share = static_cast<float>(variance / (2 * passes));
    for (int pass = 0; pass < passes; ++pass) {
        for (size_t y = 0; y < height; ++y)
            spread_lines(first + y * row, width, 4, 4, share);
        spread_lines(first, height, row, 4 * width, share);
    }
}

}  // namespace lodestone::image
