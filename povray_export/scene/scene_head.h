// SPDX-License-Identifier: GPL-3.0-or-later
// Scene head: what a scene says before its camera: settings of all of it, and the sky.
#pragma once

#include "model/view.h"
#include "povray_export/lamp/sky_writer.h"
#include "povray_export/scene/shading.h"

#include <string>

namespace lodestone::povray {

struct SceneHead {
    double pixel_error = 0;
    uint64_t occurrences = 0;
    double times = 1;          // as large everything is written
    bool refracts = false;     // some of it is glass
    bool transparent = false;  // the film
    glm::dvec3 eye{0.0};       // as it is written
};

/// `shading` is filled up; its bounces are those of light in this scene.
std::string head_text(const SceneHead& head, const Shading& shading, const WrittenSky& sky);

}  // namespace lodestone::povray
