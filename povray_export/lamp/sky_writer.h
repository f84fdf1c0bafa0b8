// SPDX-License-Identifier: GPL-3.0-or-later
// Sky writer: a world as the picture behind everything and as the light it gives.
#pragma once

#include "light/environment/uneven_sky.h"
#include "model/view.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace lodestone::povray {

/// The lights that an environment image becomes.
struct SkySampling {
    /// The most lights: more give finer shadows of the sky, for a ray each at every seen point.
    size_t lights = 24;
    bool shadows = true;  // false: the lights shine through everything
    /// True: rays find what each place sees of the sky, so that only its peaks become lights.
    bool found_by_rays = false;
};

/// A world as it is written.
struct WrittenSky {
    glm::dvec3 ambient{0.0};  // radiance that lights everything alike, without shadows
    /// The sky by direction, in parts of it. Null: it is the same everywhere.
    std::shared_ptr<const light::UnevenSky> uneven{};
    std::vector<Light> lights;  // suns for an environment's light besides
    std::string pigment;        // pigment{...} of an environment's picture; "" without
    glm::dvec3 strength{1.0};   // factor on what the picture shows
    std::string file;           // an environment's file, relative to the scene; "" without
    uint64_t bytes = 0;         // size of that file
    uint64_t texels = 0;        // of its picture
    bool written = false;       // false: the file was there already
};

/// Writes an environment's picture into `folder`/i when it is not there. A picture that cannot be
/// decoded becomes a problem, and its world counts as its color. Without lights all of its light is
/// uniform, but for what rays find. Throws Error(Io).
WrittenSky write_sky(const World& world, const SkySampling& sampling,
                     const std::filesystem::path& folder, Problems& problems);

/// The text of an environment's picture behind everything.
std::string sky_sphere(const WrittenSky& sky);
/// The same picture as a ball around the eye, for pictures with indirect light: gathering rays go
/// through it and meet the background, as lights stand for most of the picture.
std::string sky_ball(const WrittenSky& sky, const glm::dvec3& eye);

}  // namespace lodestone::povray
