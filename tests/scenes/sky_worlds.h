// SPDX-License-Identifier: GPL-3.0-or-later
// Worlds whose skies are known functions, shared by the tests of their light.
#pragma once

#include "image/image.h"
#include "image/texture_sampler.h"
#include "light/environment/environment_sky.h"

#include <functional>

namespace lodestone {

/// A world whose picture (128 x 64, OpenEXR) has this radiance by direction.
inline World world_of_sky(const std::function<glm::dvec3(const glm::dvec3&)>& radiance) {
    image::Image sky;
    sky.width = 128;
    sky.height = 64;
    sky.linear = true;
    for (int y = 0; y < sky.height; ++y) {
        for (int x = 0; x < sky.width; ++x) {
            const glm::dvec3 color = radiance(light::equirectangular_direction(
                (x + 0.5) / sky.width, 1 - (y + 0.5) / sky.height));
            for (int c = 0; c < 3; ++c)
                sky.pixels.push_back(static_cast<float>(color[c]));
            sky.pixels.push_back(1);
        }
    }
    World world;
    world.environment = image::make_picture(image::exr_bytes(sky), ColorSpace::Linear, "sky");
    return world;
}

}  // namespace lodestone
