// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/environment/environment_sky.h"

#include "base/color.h"
#include "base/maths.h"
#include "image/texture_sampler.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::light {
namespace {

// The width in texels to which pictures are reduced.
// Taste: more texels keep smaller suns apart and take longer; 128 are 2.8 degrees each.
constexpr int kWidth = 128;
// Law: an equirectangular picture is half as high as wide.
constexpr int kHeight = 64;
// The sides of the blocks of texels whose darkest one is the uniform sky.
// Taste: larger blocks find less of the light in the uniform sky.
constexpr int kSquare = 8;
// The largest radiance that counts.
// Taste: a larger one is a mistake of the picture's maker.
constexpr double kMost = 1e9;
// The times of the mean brightness from which on there is a peak.
// Taste: rays that find what places see of the sky tell of less in less than a hundred of them; a
// smaller value makes more lights, with hard shadows.
constexpr double kPeak = 8;
constexpr int kPeakRounds = 4;  // Taste: the mean is that without peaks, and stands still after few

/// The means of the picture's pixels that the texels of row y of a sky of that size cover.
std::vector<glm::dvec3> means_of(const image::TexelRows& picture, int y, int width, int height) {
    const auto begin = [](int at, int count, int size) {
        return static_cast<int>(static_cast<int64_t>(at) * size / count);
    };
    std::vector<glm::dvec3> sums(static_cast<size_t>(width), glm::dvec3(0.0));
    std::vector<double> counts(sums.size(), 0.0);
    std::vector<float> pixels(4 * static_cast<size_t>(picture.width()));
    for (int row = begin(y, height, picture.height()); row < begin(y + 1, height, picture.height());
         ++row) {
        picture.read(row, pixels.data());
        for (int x = 0; x < width; ++x) {
            glm::dvec3& sum = sums[static_cast<size_t>(x)];
            for (int column = begin(x, width, picture.width());
                 column < begin(x + 1, width, picture.width()); ++column) {
                const float* pixel = pixels.data() + 4 * static_cast<size_t>(column);
                for (int c = 0; c < 3; ++c) {
                    const auto value = static_cast<double>(pixel[c]);
                    sum[c] += value > 0 ? std::min(value, kMost) : 0.0;  // false for a nan
                }
                ++counts[static_cast<size_t>(x)];
            }
        }
    }
    for (size_t x = 0; x < sums.size(); ++x)
        sums[x] /= std::max(counts[x], 1.0);
    return sums;
}

}  // namespace

glm::dvec3 equirectangular_direction(double u, double v) {
    const double turn = kPi * (1 - 2 * u);
    const double height = kPi * (v - 0.5);
    return {std::cos(height) * std::cos(turn), std::cos(height) * std::sin(turn), std::sin(height)};
}

glm::dvec2 equirectangular_place(const glm::dvec3& direction) {
    return {0.5 - std::atan2(direction.y, direction.x) / (2 * kPi),
            0.5 + std::atan2(direction.z, std::hypot(direction.x, direction.y)) / kPi};
}

EnvironmentSky::EnvironmentSky(const World& world) : width_(kWidth), height_(kHeight) {
    const image::PackedPtr packed = image::packed(*world.environment);
    const image::TexelRows picture(*packed, world.environment->space);
    width_ = std::min(kWidth, picture.width());
    height_ = std::min(kHeight, picture.height());
    if (std::abs(glm::determinant(world.environment_turn)) > 1e-12)
        to_picture_ = world.environment_turn;
    const glm::dmat3 to_world = glm::inverse(to_picture_);
    texels_.resize(static_cast<size_t>(width_) * static_cast<size_t>(height_));
    size_t next = 0;
    for (int y = 0; y < height_; ++y) {
        const double low = kPi * y / height_;  // the angle from the zenith
        const double high = kPi * (y + 1) / height_;
        const std::vector<glm::dvec3> means = means_of(picture, y, width_, height_);
        for (int x = 0; x < width_; ++x) {
            SkyTexel& texel = texels_[next++];
            const glm::dvec3 own =
                equirectangular_direction((x + 0.5) / width_, 1 - (y + 0.5) / height_);
            texel.direction = glm::normalize(to_world * own);
            texel.solid_angle = (std::cos(low) - std::cos(high)) * 2 * kPi / width_;
            texel.radiance = means[static_cast<size_t>(x)] * world.environment_strength;
        }
    }
}

glm::dvec3 EnvironmentSky::take_uniform() {
    glm::dvec3 least(kMost);
    for (int top = 0; top < height_; top += kSquare) {
        for (int left = 0; left < width_; left += kSquare) {
            glm::dvec3 sum(0.0);
            double weight = 0;
            for (int y = top; y < std::min(top + kSquare, height_); ++y) {
                for (int x = left; x < std::min(left + kSquare, width_); ++x) {
                    sum += at(x, y).power();
                    weight += at(x, y).solid_angle;
                }
            }
            least = glm::min(least, sum / weight);
        }
    }
    for (SkyTexel& texel : texels_)
        texel.base = least;
    return least;
}

void EnvironmentSky::take_below_peaks() {
    double most = kInfinity;
    for (int round = 0; round < kPeakRounds; ++round) {
        double sum = 0;
        double weight = 0;
        for (const SkyTexel& texel : texels_) {
            sum += std::min(luminance(texel.radiance), most) * texel.solid_angle;
            weight += texel.solid_angle;
        }
        most = kPeak * sum / weight;
    }
    for (SkyTexel& texel : texels_) {
        const double own = luminance(texel.radiance);
        texel.base = own > most ? texel.radiance * (most / own) : texel.radiance;
    }
}

}  // namespace lodestone::light
