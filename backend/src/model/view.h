// SPDX-License-Identifier: GPL-3.0-or-later
// What a picture is taken with: camera, lights, world, and the quality asked for.
#pragma once

#include "base/maths.h"
#include "model/representation.h"

#include <string>
#include <vector>

namespace lodestone {

/// Explicit frame vectors, so that no convention of angles, sensors or shifts is needed.
/// Perspective: a pixel at (u, v) in [-1/2, 1/2]^2 looks along direction + u right + v up.
/// Orthographic: it looks along direction from position + u right + v up.
struct Camera {
    std::string name;
    bool orthographic = false;
    glm::dvec3 position{0.0};
    glm::dvec3 direction{0, 0, -1};  // perspective: to the frame's middle at distance 1
    glm::dvec3 right{1, 0, 0};       // whole frame width (perspective: at distance 1)
    glm::dvec3 up{0, 1, 0};          // whole frame height
    double near_clip = 0.1;          // metres
};

enum class LightKind : uint8_t { Sun = 0, Point = 1 };

struct Light {
    std::string name;
    LightKind kind = LightKind::Sun;
    glm::dvec3 color{1.0};  // linear
    double power = 1;       // sun: W/m^2; point: W (Blender's energy units)
    glm::dvec3 position{0.0};
    glm::dvec3 direction{0, 0, -1};  // the way a sun's light travels
    bool shadow = true;
};

struct World {
    glm::dvec3 color{0.05};    // linear radiance, the same from everywhere
    bool transparent = false;  // film: the background has alpha 0
};

/// Everything but the model.
struct View {
    Camera camera;
    int width = 640;  // pixels of the final image
    int height = 360;
    double pixel_error = 1;      // T; 0 = originals
    KindMask kinds = kAllKinds;  // what the consumer can draw
};

}  // namespace lodestone
