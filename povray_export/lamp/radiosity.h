// SPDX-License-Identifier: GPL-3.0-or-later
// Radiosity: light that surfaces hand on to each other, as POV-Ray gathers it.
#pragma once

#include "povray_export/scene/shading.h"

#include <string>

namespace lodestone::povray {

/// The text radiosity{...} of global_settings. `shading` is filled up and has bounces. `sky` says
/// that some light comes from the background, which POV-Ray counts as a bounce of its own; lamps
/// then have one more. With radiosity POV-Ray ignores all ambient light: surfaces see the
/// background where nothing hides it.
std::string radiosity_text(const Shading& shading, bool sky);

}  // namespace lodestone::povray
