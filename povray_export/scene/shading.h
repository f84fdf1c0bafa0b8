// SPDX-License-Identifier: GPL-3.0-or-later
// Shading: how finely a picture is lit and sampled, so that a rough model is also shaded roughly.
#pragma once

#include "model/view.h"
#include "povray_export/lamp/light_writer.h"

#include <cstdint>

namespace lodestone::povray {

/// One setting for every picture that is compared with another. Nothing in it is random.
enum class Antialiasing : uint8_t {
    Off = 0,        // one sample a pixel, one ray a light: drafts
    Final = 1,      // 9 more where neighbors differ by 0.1: +A0.1 +AM1 +R3, no jitter
    Reference = 2,  // 16 more in every pixel: +A0.0 +AM1 +R4, no jitter
};

/// The designer's controls below Pixel Error (Figure 2.20), each with its value. A count or
/// threshold of 0 is the one its setting of antialiasing stands for.
struct Shading {
    double threshold = 0;     // Final: neighbors that differ by more (0 ... 1) get more samples
    int depth = 0;            // Final: its square is how many
    int trace_depth = 0;      // mirrors or bodies of glass, one behind the other
    int area_samples = 0;     // rays along the edge of a lamp, made 2^n + 1; 1: sharp shadows
    int sky_lights = 0;       // the most lights that stand for an environment image; below 0: none
    int sky_rays = 0;         // rays by which corners find their share of the sky; below 0: none
    double shadow_error = 0;  // pixels; narrower penumbrae are sharp. 0: the Pixel Error
    double reflection_error = 0;  // 255ths; rays that add less are not followed. 0: 1
    double texture_error = 0;     // pixels; what a picture may be blurred by. 0: what samples miss
    int bounces = 0;              // bounces of light from surface to surface; 0: direct light only
    int bounce_rays = 0;          // rays by which light of other surfaces is gathered
    double bounce_error = 0;      // how far gathered light is used again, 0 ... 1
};

/// The shading with every count and threshold filled in.
Shading filled_up(const Shading& shading, Antialiasing antialiasing, double pixel_error);

/// The rays of a light's size in a picture. Where depths are blurred each of 37 samples of a pixel or
/// more casts its rays to every lamp, so that half of them along an edge are as good.
LightSampling light_sampling(const Shading& filled_up, Antialiasing antialiasing,
                             const Camera& camera);

/// How many samples a pixel has along a side, where it has the most.
int samples_along_side(const Shading& filled_up, Antialiasing antialiasing);

}  // namespace lodestone::povray
