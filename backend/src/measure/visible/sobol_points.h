// SPDX-License-Identifier: GPL-3.0-or-later
// SobolPoints: Sobol points in four dimensions, shifted by a seed. They are evener than random
// ones, and any of them can be had by its number, so that threads need not share anything.
// Our own although libraries exist: four dimensions fit in one table made by the compiler, every
// point is asked by its number and not in turn, and stores depend on these very numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lodestone::measure {

/// Spreads a number over 64 bits, so that neighboring seeds and numbers have nothing in common: a
/// mixer of the form of SplitMix64 (Steele, Lea and Flood 2014) with other factors.
constexpr uint64_t scramble(uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 32u)) * 0xd6e8feb86659fd93u;
    x = (x ^ (x >> 29u)) * 0xa0761d6478bd642fu;
    return x ^ (x >> 32u);
}

/// The place of a sample in its cell, each coordinate in [0, 1). Points of a sequence that fills
/// space evenly would lie in one half of all cells of even columns and in the other half of the odd
/// ones, and miss what lies between.
inline std::array<double, 2> jitter(uint64_t seed, uint64_t number) {
    // Law: 2^-32, which maps 32 bits to [0, 1).
    constexpr double kUnit = 1.0 / 4294967296.0;
    const uint64_t bits = scramble(scramble(seed) + number);
    return {kUnit * static_cast<double>(bits >> 32u),
            kUnit * static_cast<double>(bits & 0xffffffffu)};
}

using SobolDirections = std::array<std::array<uint32_t, 4>, 32>;

/// Direction numbers: the plain radical inverse, then the primitive polynomials 1 + x,
/// 1 + x + x^2 and 1 + x + x^3 (Sobol 1967; starting values of Joe and Kuo 2008).
constexpr SobolDirections sobol_directions() {
    SobolDirections out{};
    for (size_t bit = 0; bit < 32; ++bit)
        out[bit][0] = uint32_t{1} << (31 - bit);
    /// Law: the degrees of the primitive polynomials 1 + x, 1 + x + x^2 and 1 + x + x^3 (Joe and
    /// Kuo 2008).
    constexpr std::array<uint32_t, 3> kDegree{1, 2, 3};
    /// Law: the coefficients of these polynomials without the first and last term (Joe and Kuo
    /// 2008).
    constexpr std::array<uint32_t, 3> kPolynomial{0, 1, 1};
    /// Law: the starting direction numbers of Joe and Kuo 2008, dimensions 2 to 4.
    constexpr std::array<std::array<uint32_t, 3>, 3> kStart{{{1, 0, 0}, {1, 3, 0}, {1, 3, 1}}};
    for (size_t i = 0; i < 3; ++i) {
        const size_t degree = kDegree[i];
        for (size_t bit = 0; bit < 32; ++bit) {
            if (bit < degree) {
                out[bit][i + 1] = kStart[i][bit] << (31 - bit);
                continue;
            }
            const uint32_t oldest = out[bit - degree][i + 1];
            uint32_t value = oldest ^ (oldest >> degree);
            for (size_t k = 1; k < degree; ++k) {
                if (((kPolynomial[i] >> (degree - 1 - k)) & 1u) != 0)
                    value ^= out[bit - k][i + 1];
            }
            out[bit][i + 1] = value;
        }
    }
    return out;
}

/// Law: the direction numbers by bit and dimension, as sobol_directions() derives them.
inline constexpr SobolDirections kSobolDirections = sobol_directions();

/// Points of [0, 1)^4. Each is uniform over the seeds; together they fill the space evenly.
class SobolPoints {
public:
    explicit SobolPoints(uint64_t seed) {
        for (size_t i = 0; i < shift_.size(); ++i)
            shift_[i] = static_cast<uint32_t>(scramble(scramble(seed) + i) >> 32u);
    }

    /// The point of that number, from any thread.
    std::array<double, 4> point(uint32_t number) const {
        std::array<uint32_t, 4> bits = shift_;
        for (size_t bit = 0; number != 0; ++bit, number >>= 1u) {
            if ((number & 1u) == 0)
                continue;
            for (size_t i = 0; i < 4; ++i)
                bits[i] ^= kSobolDirections[bit][i];
        }
        return {bits[0] * 0x1p-32, bits[1] * 0x1p-32, bits[2] * 0x1p-32, bits[3] * 0x1p-32};
    }

private:
    std::array<uint32_t, 4> shift_{};
};

}  // namespace lodestone::measure
