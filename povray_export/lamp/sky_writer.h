// SPDX-License-Identifier: GPL-3.0-or-later
// Sky writer: a world as what is seen behind everything and as the light it gives.
#pragma once

#include "model/view.h"

#include <filesystem>
#include <string>
#include <vector>

namespace lodestone::povray {

/// How an environment image is made lights.
struct SkySampling {
    size_t lights = 24;   // at most; more: finer shadows of the sky, a ray each at every point seen
    bool shadows = true;  // false: they shine through everything
};

struct WrittenSky {
    glm::dvec3 ambient{0.0};    // radiance that lights everything alike, without shadows
    std::vector<Light> lights;  // suns for the rest of an environment
    std::string pigment;        // pigment{...} of an environment's picture; "" without
    glm::dvec3 strength{1.0};   // of what it shows
    std::string file;           // of an environment, relative to the scene; "" without
    uint64_t bytes = 0;         // of that file
    bool written = false;       // false: it was there already
};

/// Writes an environment's picture into `folder`/i when it is not there. One that cannot be decoded
/// becomes a problem, and its world counts as its color. Without lights all of its light is
/// uniform. Throws Error(Io).
WrittenSky write_sky(const World& world, const SkySampling& sampling,
                     const std::filesystem::path& folder, Problems& problems);

/// An environment's picture behind everything.
std::string sky_sphere(const WrittenSky& sky);
/// The same as a ball around the eye, for pictures with indirect light: gathering rays go through
/// it and meet the background, as lights stand for most of the picture.
std::string sky_ball(const WrittenSky& sky, const glm::dvec3& eye);

}  // namespace lodestone::povray
