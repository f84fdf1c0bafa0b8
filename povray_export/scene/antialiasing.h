// SPDX-License-Identifier: GPL-3.0-or-later
// Antialiasing: the samples of a pixel, a soft shadow and a blurred depth.
#pragma once

#include <cstdint>

namespace lodestone::povray {

/// One setting for every picture that is compared with another. Nothing in it is random.
enum class Antialiasing : uint8_t {
    Off = 0,        // one sample a pixel, one ray a light: drafts
    Final = 1,      // 9 more where neighbors differ by 0.1: +A0.1 +AM1 +R3, no jitter
    Reference = 2,  // 16 more in every pixel: +A0.0 +AM1 +R4, no jitter
};

}  // namespace lodestone::povray
