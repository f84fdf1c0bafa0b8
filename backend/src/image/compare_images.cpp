// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/compare_images.h"

#include "base/color.h"
#include "base/error.h"
#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone::image {
namespace {

/// The smallest alpha that counts as covered.
/// Law: the smallest alpha of 8 bits that is not 0.
constexpr float kCovered = 1.0f / 255.0f;
/// The radius of the Gaussian window in pixels: it is 11 x 11.
/// Law: Wang et al. 2004, section III.C.
constexpr int kRadius = 5;
/// The constant of luma: (K1 L)^2 with K1 = 0.01.
/// Law: Wang et al. 2004, section III.C, for values 0...1.
constexpr double kC1 = 0.01 * 0.01;
/// The constant of contrast: (K2 L)^2 with K2 = 0.03.
/// Law: Wang et al. 2004, section III.C.
constexpr double kC2 = 0.03 * 0.03;

using Plane = std::vector<double>;

void check_size(const Image& image, const Image& like) {
    if (image.width != like.width || image.height != like.height)
        fail(Status::InvalidArgument, "a picture of ", image.width, " x ", image.height,
             " pixels cannot be compared with one of ", like.width, " x ", like.height);
    if (image.width < 0 || image.height < 0 || image.pixels.size() != 4 * image.size())
        fail(Status::InvalidArgument, "a picture of ", image.width, " x ", image.height,
             " pixels has ", image.pixels.size(), " values");
}

/// The picture's encoded color times alpha.
Image over_black(const Image& image) {
    Image out = encoded(image);
    for (size_t i = 0; i < out.pixels.size(); i += 4) {
        for (size_t channel = 0; channel < 3; ++channel)
            out.pixels[i + channel] *= out.pixels[i + 3];
    }
    return out;
}

std::vector<uint8_t> covered_pixels(const Image& a, const Image& b, const Image* mask) {
    std::vector<uint8_t> covered(a.size(), 0);
    bool opaque = mask != nullptr;
    for (size_t i = 0; i < covered.size(); ++i) {
        const size_t at = 4 * i + 3;
        if (mask != nullptr) {
            covered[i] = mask->pixels[at] > kCovered;
            opaque = opaque && mask->pixels[at] >= 1;
        } else {
            covered[i] = a.pixels[at] > kCovered || b.pixels[at] > kCovered;
        }
    }
    if (opaque)
        std::fill(covered.begin(), covered.end(), uint8_t{1});
    return covered;
}

Plane luma(const Image& image) {
    Plane out(image.size());
    for (size_t i = 0; i < out.size(); ++i) {
        const float* pixel = image.pixels.data() + 4 * i;
        out[i] = luminance(glm::dvec3(pixel[0], pixel[1], pixel[2]));
    }
    return out;
}

std::array<double, 2 * kRadius + 1> gaussian() {
    std::array<double, 2 * kRadius + 1> weights{};
    for (size_t i = 0; i < weights.size(); ++i) {
        const double away = static_cast<double>(i) - kRadius;
        weights[i] = std::exp(-away * away / (2 * 1.5 * 1.5));
    }
    return weights;
}

/// The weighted mean along one axis; `stride` is a step along it, `length` its number of values.
double blurred_at(const double* line, int64_t stride, int64_t length, int64_t at) {
    // Law: a Gaussian of sigma 1.5 (Wang et al. 2004, section III.C).
    static const std::array<double, 2 * kRadius + 1> kWeights = gaussian();
    double sum = 0;
    double total = 0;
    for (int64_t i = -kRadius; i <= kRadius; ++i) {
        if (at + i < 0 || at + i >= length)
            continue;
        const double weight = kWeights[static_cast<size_t>(i + kRadius)];
        sum += weight * line[(at + i) * stride];
        total += weight;
    }
    return sum / total;
}

Plane blurred(const Plane& plane, int64_t width, int64_t height) {
    Plane rows(plane.size());
    Plane out(plane.size());
    parallel_for(static_cast<size_t>(height), [&](size_t y) {
        const double* line = plane.data() + y * static_cast<size_t>(width);
        for (int64_t x = 0; x < width; ++x)
            rows[y * static_cast<size_t>(width) + static_cast<size_t>(x)] =
                blurred_at(line, 1, width, x);
    });
    parallel_for(static_cast<size_t>(height), [&](size_t y) {
        for (int64_t x = 0; x < width; ++x)
            out[y * static_cast<size_t>(width) + static_cast<size_t>(x)] =
                blurred_at(rows.data() + x, width, height, static_cast<int64_t>(y));
    });
    return out;
}

double mean_ssim(const Image& a, const Image& b, const std::vector<uint8_t>& covered,
                 size_t pixels) {
    const Plane x = luma(a);
    const Plane y = luma(b);
    Plane xx(x.size());
    Plane yy(x.size());
    Plane xy(x.size());
    for (size_t i = 0; i < x.size(); ++i) {
        xx[i] = x[i] * x[i];
        yy[i] = y[i] * y[i];
        xy[i] = x[i] * y[i];
    }
    const Plane mean_x = blurred(x, a.width, a.height);
    const Plane mean_y = blurred(y, a.width, a.height);
    xx = blurred(xx, a.width, a.height);
    yy = blurred(yy, a.width, a.height);
    xy = blurred(xy, a.width, a.height);
    double sum = 0;
    for (size_t i = 0; i < x.size(); ++i) {
        if (!covered[i])
            continue;
        const double mx = mean_x[i];
        const double my = mean_y[i];
        const double vx = std::max(0.0, xx[i] - mx * mx);
        const double vy = std::max(0.0, yy[i] - my * my);
        const double cov = xy[i] - mx * my;
        sum +=
            (2 * mx * my + kC1) * (2 * cov + kC2) / ((mx * mx + my * my + kC1) * (vx + vy + kC2));
    }
    return sum / static_cast<double>(pixels);
}

}  // namespace

ImageDifference compare(const Image& a, const Image& b, const Image* mask) {
    check_size(a, a);
    check_size(b, a);
    if (mask != nullptr)
        check_size(*mask, a);
    const Image left = over_black(a);
    const Image right = over_black(b);
    const std::vector<uint8_t> covered = covered_pixels(left, right, mask);
    ImageDifference out;
    std::vector<float> largest;
    double sum = 0;
    for (size_t i = 0; i < covered.size(); ++i) {
        if (!covered[i])
            continue;
        float worst = 0;
        double total = 0;
        for (size_t channel = 0; channel < 3; ++channel) {
            const float apart =
                std::abs(left.pixels[4 * i + channel] - right.pixels[4 * i + channel]);
            worst = std::max(worst, apart);
            total += static_cast<double>(apart);
        }
        sum += total / 3;
        largest.push_back(worst);
    }
    out.pixels = largest.size();
    if (out.pixels == 0)
        return out;
    out.mean = sum / static_cast<double>(out.pixels);
    out.ssim = mean_ssim(left, right, covered, out.pixels);
    const size_t rank = std::max<size_t>(1, (999 * out.pixels + 999) / 1000) - 1;
    std::nth_element(largest.begin(), largest.begin() + static_cast<ptrdiff_t>(rank),
                     largest.end());
    out.p999 = static_cast<double>(largest[rank]);
    out.max = static_cast<double>(*std::max_element(largest.begin(), largest.end()));
    return out;
}

}  // namespace lodestone::image
