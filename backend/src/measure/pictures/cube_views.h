// SPDX-License-Identifier: GPL-3.0-or-later
// Cube views: the directions from which pictures of a thing are taken and lit, and the frames of
// these.
#pragma once

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace lodestone::measure {

/// The unit directions from a cube's middle to its 26 faces, edges and corners. The opposite of
/// number i is number 25 - i.
inline std::vector<glm::dvec3> cube_directions() {
    std::vector<glm::dvec3> out;
    for (int number = 0; number < 27; ++number) {
        const glm::dvec3 along(number / 9 - 1, number / 3 % 3 - 1, number % 3 - 1);
        if (along != glm::dvec3(0.0))
            out.push_back(glm::normalize(along));
    }
    return out;
}

/// The share of the sky in the light on a surface that faces the sun or lamp of a picture. Nothing
/// shades the sky: pictures show it so, as one ambient light.
/// Taste: as on a clear day; a larger value tells less of the shape. At 0.35 and 0.5 trees came out
/// darker.
inline constexpr double kSkyShare = 0.25;

/// The unit direction of that number of any many that fill the half sphere above evenly: the
/// sequence R2 (Roberts 2018).
inline glm::dvec3 sky_direction(size_t number) {
    // Law: 1 / g, where g^3 = g + 1.
    constexpr double kFirst = 0.7548776662466927;
    // Law: 1 / g^2.
    constexpr double kSecond = 0.5698402909980532;
    const double n = static_cast<double>(number) + 0.5;
    const double z = std::fmod(kFirst * n, 1.0);
    const double turn = 2 * std::numbers::pi * std::fmod(kSecond * n, 1.0);
    const double across = std::sqrt(1 - z * z);
    return {across * std::cos(turn), across * std::sin(turn), z};
}

/// The frame of a picture that is seen from the unit direction `towards`. Its columns: right, up,
/// towards the viewer.
inline glm::dmat3 picture_frame(const glm::dvec3& towards) {
    const glm::dvec3 other = std::abs(towards.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(other, towards));
    return {right, glm::cross(towards, right), towards};
}

}  // namespace lodestone::measure
