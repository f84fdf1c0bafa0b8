// SPDX-License-Identifier: GPL-3.0-or-later
// PixelMisses: how much two sets of pictures differ at one size of their pixels.
#pragma once

#include "measure/pictures/picture_agreement.h"

#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lodestone::measure {

/// Differences between pixels of one size, with the noise of their samples and without.
struct PixelDifference {
    double sum = 0;       // sum of magnitudes
    double squares = 0;   // sum of squares
    double products = 0;  // sum of products of the differences of both halves of the samples

    void add(double first, double second) {
        const double both = 0.5 * (first + second);
        sum += std::abs(both);
        squares += both * both;
        products += first * second;
    }
    /// The mean of `count` magnitudes, as pictures of very many samples would have it: noise is
    /// independent between the halves, so their products know what it added to the squares.
    double mean(double count) const {
        const double real = squares > 0 ? std::clamp(products / squares, 0.0, 1.0) : 0;
        return sum / count * std::sqrt(real);
    }
};

/// The differences of all pixels of one size.
struct PixelMisses {
    size_t covered = 0;  // pixels that either picture covers
    PixelDifference coverage;
    PixelDifference light;    // three colors a pixel
    double finest_light = 0;  // sum of the finest's light over covered pixels

    /// The difference of coverage over what is allowed: above 1 the pictures do not agree.
    double coverage_off() const {
        return covered == 0 ? 0 : coverage.mean(static_cast<double>(covered)) / kMostCoverageOff;
    }
    /// The same of light.
    double light_off() const {
        if (covered == 0 || !(finest_light > 0))
            return 0;
        const double count = 3 * static_cast<double>(covered);
        return light.mean(count) * count / finest_light / kMostLightOff;
    }
    /// The larger of both.
    double worst() const { return std::max(coverage_off(), light_off()); }
};

/// The part of a picture where either shows something: from `low` to below `high` (column, row).
struct PictureRect {
    glm::ivec2 low{0};
    glm::ivec2 high{0};
};

/// The part of each view where either picture shows something. The pictures have `side` by `side`
/// samples a view (light, coverage).
std::vector<PictureRect> picture_rects(const std::vector<glm::vec4>& a,
                                       const std::vector<glm::vec4>& b, size_t views, int side);

/// The differences of such pictures, in pixels of `pixel` by `pixel` samples; `pixel` divides the
/// side. `a` is the finest's; `parts` are the rectangles of both.
PixelMisses pixel_misses(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b,
                         const std::vector<PictureRect>& parts, int side, int pixel);

}  // namespace lodestone::measure
