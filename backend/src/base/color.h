// SPDX-License-Identifier: GPL-3.0-or-later
// Color formulas: the sRGB transfer function, both ways, and the luminance of linear light.
// source: IEC 61966-2-1 (sRGB), ITU-R BT.709 (primaries)
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <concepts>

namespace lodestone {

// The transfer function is a straight line near black and scale * x^(1 / power) - offset above.
inline constexpr double kSrgbLinearEnd = 0.0031308;  // Law: IEC 61966-2-1, the line's end, linear
inline constexpr double kSrgbEncodedEnd = 0.04045;   // Law: IEC 61966-2-1, the same end, encoded
inline constexpr double kSrgbSlope = 12.92;          // Law: IEC 61966-2-1
inline constexpr double kSrgbScale = 1.055;          // Law: IEC 61966-2-1
inline constexpr double kSrgbOffset = 0.055;         // Law: IEC 61966-2-1
inline constexpr double kSrgbPower = 2.4;            // Law: IEC 61966-2-1

/// Law: the luminance of the three primaries of ITU-R BT.709, which sRGB shares.
inline constexpr glm::dvec3 kLuminanceWeights{0.2126, 0.7152, 0.0722};

/// The sRGB-encoded value of a linear one, which may be negative or larger than 1. Pictures are
/// encoded in float, materials and lights in double: the precision is the argument's.
template <std::floating_point T>
T encode_srgb(T linear) {
    if (linear <= static_cast<T>(kSrgbLinearEnd))
        return static_cast<T>(kSrgbSlope) * linear;
    return static_cast<T>(kSrgbScale) * std::pow(linear, 1 / static_cast<T>(kSrgbPower)) -
           static_cast<T>(kSrgbOffset);
}

/// The linear value of an sRGB-encoded one.
template <std::floating_point T>
T decode_srgb(T encoded) {
    if (encoded <= static_cast<T>(kSrgbEncodedEnd))
        return encoded / static_cast<T>(kSrgbSlope);
    return std::pow((encoded + static_cast<T>(kSrgbOffset)) / static_cast<T>(kSrgbScale),
                    static_cast<T>(kSrgbPower));
}

/// The brightness of a linear color: its luminance, relative to that of white. Of an encoded color
/// this is its luma.
inline double luminance(const glm::dvec3& color) {
    return glm::dot(color, kLuminanceWeights);
}

}  // namespace lodestone
