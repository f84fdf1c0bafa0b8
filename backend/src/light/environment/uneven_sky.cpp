// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/environment/uneven_sky.h"

#include "base/color.h"
#include "base/maths.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::light {
namespace {

// The heights and turns of surfaces for which what they receive is known; between them it is blended.
// Law: what matte surfaces receive changes slowly with where they face; 7.5 degrees tell it within
// a two-hundredth.
constexpr int kRows = 24;
constexpr int kColumns = 48;  // Law: as kRows
// The heights of which means are kept.
// Taste: 3 degrees each near the horizon; more have fewer parts of a small picture each.
constexpr int kHeights = 40;
// The difference of colors, in parts of them, from which on hues are not the same.
// Taste: two steps of a display in the middle of its range.
constexpr double kOtherHue = 0.03;

/// The direction in which the surface of a row and column faces.
glm::dvec3 facing(int row, int column) {
    return equirectangular_direction((column + 0.5) / kColumns, 1 - (row + 0.5) / kRows);
}

size_t height_at(double sine) {
    return static_cast<size_t>(limited((sine + 1) / 2 * kHeights, 0, kHeights - 1));
}

}  // namespace

UnevenSky::UnevenSky(const EnvironmentSky& sky)
    : width_(sky.width()), height_(sky.height()), to_picture_(sky.to_picture()) {
    find_received(sky);
    find_color();
    if (color_ == glm::dvec3(0.0))
        return;
    std::vector<glm::dvec3> sums(kHeights, glm::dvec3(0.0));
    std::vector<double> solid_angles(kHeights, 0.0);
    values_.reserve(sky.texels().size());
    const auto in_parts = [this](const glm::dvec3& color) {
        glm::dvec3 out(0.0);
        for (int i = 0; i < 3; ++i)
            out[i] = color_[i] > 0 ? color[i] / color_[i] : 0;
        return out;
    };
    for (glm::dvec3& one : received_)
        one = in_parts(one);
    for (const SkyTexel& texel : sky.texels()) {
        const glm::dvec3 value = in_parts(texel.base);
        values_.emplace_back(value);
        sums[height_at(texel.direction.z)] += value * texel.solid_angle;
        solid_angles[height_at(texel.direction.z)] += texel.solid_angle;
    }
    for (size_t i = 0; i < sums.size(); ++i) {
        // A height without a texel is as the one below it: pictures may have few pixels.
        const glm::vec3 before = by_height_.empty() ? glm::vec3(0.0f) : by_height_.back();
        by_height_.push_back(solid_angles[i] > 0 ? glm::vec3(sums[i] / solid_angles[i]) : before);
    }
    find_hash();
}

void UnevenSky::find_received(const EnvironmentSky& sky) {
    received_.reserve(static_cast<size_t>(kRows) * kColumns);
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            const glm::dvec3 normal = facing(row, column);
            glm::dvec3 sum(0.0);
            for (const SkyTexel& texel : sky.texels())
                sum += texel.base *
                       (texel.solid_angle / kPi * std::max(0.0, glm::dot(normal, texel.direction)));
            received_.push_back(sum);
        }
    }
}

const glm::dvec3& UnevenSky::received_at(int row, int column) const {
    return received_[static_cast<size_t>(row) * kColumns + static_cast<size_t>(column)];
}

void UnevenSky::find_color() {
    glm::dvec3 on_ground(0.0);  // and on what faces up
    double most = 0;
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            const glm::dvec3& sum = received_at(row, column);
            const double height = facing(row, column).z;
            most = std::max(most, luminance(sum));
            on_ground += sum * std::max(0.0, height) * std::sqrt(1 - height * height);
        }
    }
    if (!(most > 0))
        return;
    if (!(luminance(on_ground) > 0))
        on_ground = glm::dvec3(1.0);
    color_ = on_ground * (most / luminance(on_ground));
    weights_ = kLuminanceWeights * color_ / most;
    for (const glm::dvec3& sum : received_) {
        const glm::dvec3 off = glm::abs(sum - color_ * (luminance(sum) / most));
        if (std::max({off.x, off.y, off.z}) > kOtherHue * most)
            one_hue_ = false;
    }
}

void UnevenSky::find_hash() {
    Hasher hasher;
    hasher.value(width_).value(height_).value(one_hue_);
    hasher.array(std::span<const glm::vec3>(values_));
    for (int i = 0; i < 3; ++i)
        hasher.value(static_cast<float>(color_[i] / luminance(color_)));
    for (int i = 0; i < 3; ++i)
        hasher.value(to_picture_[i].x).value(to_picture_[i].y).value(to_picture_[i].z);
    hash_ = hasher.result();
}

glm::dvec3 UnevenSky::toward(const glm::dvec3& direction) const {
    if (values_.empty())
        return glm::dvec3(0.0);
    const glm::dvec2 place = equirectangular_place(to_picture_ * direction);
    const auto column = static_cast<size_t>(limited(place.x * width_, 0, width_ - 1));
    const auto row = static_cast<size_t>(limited((1 - place.y) * height_, 0, height_ - 1));
    return glm::dvec3(values_[row * static_cast<size_t>(width_) + column]);
}

glm::dvec3 UnevenSky::at_height(double sine) const {
    return by_height_.empty() ? glm::dvec3(0.0) : glm::dvec3(by_height_[height_at(sine)]);
}

glm::dvec3 UnevenSky::received(const glm::dvec3& normal) const {
    const glm::dvec2 place = equirectangular_place(normal);
    const double row = limited((1 - place.y) * kRows - 0.5, 0, kRows - 1);
    const double column = place.x * kColumns - 0.5;
    const auto at = [this](double y, double x) -> const glm::dvec3& {
        const int around = (static_cast<int>(x) + kColumns) % kColumns;
        return received_at(static_cast<int>(y), around);
    };
    const double left = std::floor(column);
    const double up = std::min(std::floor(row), kRows - 2.0);
    const auto in_row = [&](double y) {
        return glm::mix(at(y, left), at(y, left + 1), column - left);
    };
    return glm::mix(in_row(up), in_row(up + 1), row - up);
}

double UnevenSky::mean(double below) const {
    double sum = 0;
    for (size_t i = 0; i < by_height_.size(); ++i)
        sum += share_of(glm::dvec3(by_height_[i])) * (2 * i < by_height_.size() ? below : 1);
    return by_height_.empty() ? 0 : sum / static_cast<double>(by_height_.size());
}

}  // namespace lodestone::light
