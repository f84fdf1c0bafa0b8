// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene/shading.h"

#include "povray_export/scene/camera_writer.h"

#include <algorithm>
#include <bit>

namespace lodestone::povray {
namespace {

// The next seven are limits of the controls.
//
// Samples of a pixel, as the square root of their number.
// Law: POV-Ray's Antialias_Depth ends there.
constexpr int kMostDepth = 9;
/// Mirrors or glass one behind the other.
/// Taste: more is beyond what anybody waits for.
constexpr int kMostTraceDepth = 100;
/// Rays along the edge of a lamp.
/// Taste: more is beyond what anybody waits for; the number is 2^7 + 1.
constexpr int kMostAreaSamples = 129;
/// Lights of an environment image.
/// Taste: more is beyond what anybody waits for.
constexpr int kMostSkyLights = 1024;
/// Rays by which a corner finds its share of the sky.
/// Taste: more change nothing that shows.
constexpr int kMostSkyRays = 1024;
/// Bounces of light.
/// Taste: more adds light that nobody sees.
constexpr int kMostHandings = 8;
/// Rays that gather light.
/// Law: POV-Ray's radiosity takes no more.
constexpr int kMostBounceRays = 1600;

int sky_lights_of(Antialiasing antialiasing) {
    switch (antialiasing) {
        case Antialiasing::Off:
            return 12;
        case Antialiasing::Final:
            return 24;
        case Antialiasing::Reference:
            break;
    }
    return 64;
}

struct GatheringQuality {
    int rays;
    double error;
};
GatheringQuality gathering_of(Antialiasing antialiasing) {
    switch (antialiasing) {
        case Antialiasing::Off:
            return {60, 1};
        case Antialiasing::Final:
            return {200, 0.6};
        case Antialiasing::Reference:
            break;
    }
    return {800, 0.4};
}

/// The number of samples, made 2^n + 1, for POV-Ray refines by halving.
int halving(int samples) {
    if (samples <= 1)
        return 1;
    const auto parts = static_cast<unsigned>(std::clamp(samples, 3, kMostAreaSamples) - 1);
    return static_cast<int>(std::bit_ceil(parts)) + 1;
}

}  // namespace

Shading filled_up(const Shading& shading, Antialiasing antialiasing, double pixel_error) {
    Shading out = shading;
    out.threshold = shading.threshold > 0 ? std::min(shading.threshold, 3.0) : 0.1;
    out.depth = shading.depth > 0 ? std::min(shading.depth, kMostDepth) : 3;
    out.trace_depth = shading.trace_depth > 0 ? std::min(shading.trace_depth, kMostTraceDepth) : 5;
    const int usual = antialiasing == Antialiasing::Off ? 1 : 17;
    out.area_samples = halving(shading.area_samples > 0 ? shading.area_samples : usual);
    out.sky_lights = shading.sky_lights == 0 ? sky_lights_of(antialiasing)
                                             : std::clamp(shading.sky_lights, 0, kMostSkyLights);
    // No image texture can show more than samples do.
    out.texture_error =
        std::max(shading.texture_error, 1.0 / samples_along_side(out, antialiasing));
    const int usual_rays = antialiasing == Antialiasing::Off ? 0 : 128;
    out.sky_rays =
        shading.sky_rays == 0 ? usual_rays : std::clamp(shading.sky_rays, 0, kMostSkyRays);
    out.shadow_error = shading.shadow_error > 0 ? shading.shadow_error : pixel_error;
    const GatheringQuality gathering = gathering_of(antialiasing);
    out.bounces = std::clamp(shading.bounces, 0, kMostHandings);
    out.bounce_rays =
        shading.bounce_rays > 0 ? std::min(shading.bounce_rays, kMostBounceRays) : gathering.rays;
    out.bounce_error =
        shading.bounce_error > 0 ? std::clamp(shading.bounce_error, 0.01, 1.0) : gathering.error;
    out.reflection_error = std::clamp(shading.reflection_error, 1.0, 255.0);
    return out;
}

LightSampling light_sampling(const Shading& filled_up, Antialiasing antialiasing,
                             const Camera& camera) {
    // The fewest rays along an edge.
    // Taste: a larger value takes longer where depths are blurred.
    constexpr int kFewest = 5;
    const bool thorough = antialiasing == Antialiasing::Reference;
    int rays = filled_up.area_samples;
    if (!thorough && has_depth_blur(camera))
        rays = std::max(std::min(rays, kFewest), (rays - 1) / 2 + 1);
    return {rays, thorough};
}

int samples_along_side(const Shading& filled_up, Antialiasing antialiasing) {
    switch (antialiasing) {
        case Antialiasing::Off:
            return 1;
        case Antialiasing::Final:
            return filled_up.depth;
        case Antialiasing::Reference:
            break;
    }
    return 4;
}

}  // namespace lodestone::povray
