// SPDX-License-Identifier: GPL-3.0-or-later
// Renderer surfaces: how much light POV-Ray lets each material send back, for the light plan.
#pragma once

#include "light/light_plan.h"

namespace lodestone::povray {

/// The reflections of all materials of a model, with the finish that they are written with.
light::RendererSurfaces renderer_surfaces(const Model& model);

}  // namespace lodestone::povray
