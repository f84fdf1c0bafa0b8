// SPDX-License-Identifier: GPL-3.0-or-later
// PcgRandom: seeded random numbers, the same sequence on every machine.
// PCG32 (O'Neill 2014, XSH-RR 64/32), in its reference form. Our own although the standard library
// has engines: its distributions differ between libraries, and std::mt19937 carries 2.5 kB of
// state, where a short sequence for every triangle is wanted.
#pragma once

#include <cstdint>

namespace lodestone {

/// A sequence of random numbers; streams of one seed are different sequences.
class PcgRandom {
public:
    explicit PcgRandom(uint64_t seed, uint64_t stream = 0) : step_((stream << 1u) | 1u) {
        next();
        state_ += seed;
        next();
    }

    uint32_t next() {
        const uint64_t old = state_;
        state_ = old * 6364136223846793005u + step_;
        const auto shifted = static_cast<uint32_t>(((old >> 18u) ^ old) >> 27u);
        const auto turn = static_cast<uint32_t>(old >> 59u);
        return (shifted >> turn) | (shifted << ((32u - turn) & 31u));
    }

    /// A number uniform in [0, 1).
    double uniform() { return next() * 0x1p-32; }

private:
    uint64_t state_ = 0;
    uint64_t step_;
};

}  // namespace lodestone
