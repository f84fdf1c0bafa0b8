// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/compare_shown.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>

namespace lodestone::image {
namespace {

/// The steps of a channel of an identity.
/// Law: eight bits a channel, 2^24 things; half floats hold such fractions exactly.
constexpr double kSteps = 256;

void check_sizes(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height || a.pixels.size() != b.pixels.size() ||
        a.pixels.size() != 4 * a.size())
        fail(Status::InvalidArgument, "a picture of ", b.width, " x ", b.height,
             " pixels cannot be compared with one of ", a.width, " x ", a.height);
}

/// The differences |a - b| of R, G, B of a pixel of encoded pictures, over black.
std::array<float, 3> apart(const Image& a, const Image& b, size_t pixel) {
    const float* left = a.pixels.data() + 4 * pixel;
    const float* right = b.pixels.data() + 4 * pixel;
    std::array<float, 3> out{};
    for (size_t channel = 0; channel < 3; ++channel)
        out[channel] = std::abs(left[channel] * left[3] - right[channel] * right[3]);
    return out;
}

}  // namespace

std::array<double, 3> identity_color(uint32_t i) {
    const uint32_t number = i + 1;
    return {static_cast<double>(number & 255u) / kSteps,
            static_cast<double>((number >> 8u) & 255u) / kSteps,
            static_cast<double>((number >> 16u) & 255u) / kSteps};
}

std::vector<uint32_t> identities(const Image& marked) {
    if (!marked.linear)
        fail(Status::InvalidArgument, "a picture of identities must be linear");
    std::vector<uint32_t> out(marked.size(), kNothing);
    for (size_t i = 0; i < out.size(); ++i) {
        const float* pixel = marked.pixels.data() + 4 * i;
        if (!(pixel[3] > 0.5f))
            continue;
        for (size_t channel = 3; channel-- > 0;) {
            const double value = std::clamp(static_cast<double>(pixel[channel]), 0.0, 1.0);
            const double step = std::min(255.0, std::round(value * kSteps));
            out[i] = out[i] * 256u + static_cast<uint32_t>(step);
        }
    }
    return out;
}

void add_differences(const Image& a, const Image& b, const std::vector<uint32_t>& shown,
                     std::span<double> sums) {
    check_sizes(a, b);
    if (shown.size() != a.size())
        fail(Status::InvalidArgument, "identities of ", shown.size(), " pixels for a picture of ",
             a.size());
    const Image left = encoded(a);
    const Image right = encoded(b);
    for (size_t i = 0; i < shown.size(); ++i) {
        if (shown[i] == kNothing || shown[i] > sums.size())
            continue;
        const std::array<float, 3> by = apart(left, right, i);
        sums[shown[i] - 1] +=
            (static_cast<double>(by[0]) + static_cast<double>(by[1]) + static_cast<double>(by[2])) /
            3;
    }
}

std::array<float, 3> difference_color(float difference) {
    struct ColorStop {
        float at;
        std::array<float, 3> color;
    };
    // The colors of differences.
    // Taste: steps of about twice the difference, from what nobody sees to what everybody does.
    static constexpr std::array<ColorStop, 5> kStops{{{0, {0, 0, 0}},
                                                      {0.02f, {0.02f, 0.06f, 0.6f}},
                                                      {0.05f, {0.02f, 0.5f, 0.15f}},
                                                      {0.1f, {0.9f, 0.8f, 0.05f}},
                                                      {0.25f, {0.85f, 0.03f, 0.02f}}}};
    const float value = std::isfinite(difference) ? std::clamp(difference, 0.0f, 0.25f) : 0.25f;
    for (size_t i = 1; i < kStops.size(); ++i) {
        if (value > kStops[i].at)
            continue;
        const float share = (value - kStops[i - 1].at) / (kStops[i].at - kStops[i - 1].at);
        std::array<float, 3> out{};
        for (size_t channel = 0; channel < 3; ++channel)
            out[channel] = std::lerp(kStops[i - 1].color[channel], kStops[i].color[channel], share);
        return out;
    }
    return kStops.back().color;
}

Image difference_picture(const Image& a, const Image& b) {
    check_sizes(a, b);
    const Image left = encoded(a);
    const Image right = encoded(b);
    Image out;
    out.width = a.width;
    out.height = a.height;
    out.linear = true;
    out.pixels.resize(a.pixels.size());
    for (size_t i = 0; i < a.size(); ++i) {
        const std::array<float, 3> by = apart(left, right, i);
        const std::array<float, 3> color = difference_color(std::max({by[0], by[1], by[2]}));
        std::copy(color.begin(), color.end(), out.pixels.begin() + static_cast<ptrdiff_t>(4 * i));
        out.pixels[4 * i + 3] = 1;
    }
    return out;
}

}  // namespace lodestone::image
