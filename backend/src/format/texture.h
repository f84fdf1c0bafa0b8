// SPDX-License-Identifier: GPL-3.0-or-later
// Texture: what a picture on a surface comes down to where only one value is kept.
#pragma once

#include "image/image.h"

#include <glm/vec3.hpp>

namespace lodestone::format {

/// Mean of R, G, B weighted by alpha (by 1 where all alpha is 0). `color`: of linear light, the
/// picture is decoded from sRGB first; else of the values as they are (roughness, metallic).
glm::dvec3 mean_of(const image::Image& picture, bool color);

}  // namespace lodestone::format
