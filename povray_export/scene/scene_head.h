// SPDX-License-Identifier: GPL-3.0-or-later
// Scene head: the beginning of a scene: its settings and its sky.
#pragma once

#include "model/view.h"
#include "povray_export/lamp/sky_writer.h"
#include "povray_export/scene/shading.h"
#include "povray_export/texture/texture_writer.h"

#include <string>

namespace lodestone::povray {

/// The facts that the head tells or depends on.
struct SceneHead {
    double pixel_error = 0;
    uint64_t occurrences = 0;
    double times = 1;          // factor by which everything is written larger
    OnwardRays onward;         // at all surfaces
    bool transparent = false;  // true: the film is transparent
    glm::dvec3 eye{0.0};       // the eye as it is written
};

/// The text of the head. `shading` is filled up; its bounces are those of light in this scene.
std::string head_text(const SceneHead& head, const Shading& shading, const WrittenSky& sky);

}  // namespace lodestone::povray
