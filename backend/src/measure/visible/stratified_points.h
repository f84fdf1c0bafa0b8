// SPDX-License-Identifier: GPL-3.0-or-later
// StratifiedPoints: random points of [0, 1)^4 in pairs, each pair in a cell of its own. The two of
// a pair differ only by what happens inside their cell, which is all the variance there is.
#pragma once

#include "measure/visible/sobol_points.h"

namespace lodestone::measure {

class StratifiedPoints {
public:
    /// The number of points is a multiple of this.
    /// Law: two points for each of the 2 x 4 x 4 cells that a layer of the first coordinate has.
    static constexpr uint32_t kStep = 64;

    /// Makes `count` points, a multiple of kStep. Each is uniform over the seeds.
    StratifiedPoints(uint64_t seed, uint32_t count)
        : seed_(scramble(seed)), layers_(count / kStep) {}

    /// The point of that number; points 2 i and 2 i + 1 share a cell. Layers of the first
    /// coordinate, which runs along a whole surface, are finer the more points there are.
    std::array<double, 4> point(uint32_t number) const {
        const uint32_t cell = number / 2;
        const uint64_t a = scramble(seed_ + number);
        const uint64_t b = scramble(a ^ seed_);
        const auto at = [](uint64_t bits, uint32_t index, double count) {
            return (index + static_cast<double>(bits & 0xffffffffu) * 0x1p-32) / count;
        };
        return {at(a >> 32u, cell / 32, layers_), at(a, cell & 3u, 4),
                at(b >> 32u, (cell >> 4u) & 1u, 2), at(b, (cell >> 2u) & 3u, 4)};
    }

private:
    uint64_t seed_;
    uint32_t layers_;
};

}  // namespace lodestone::measure
