// SPDX-License-Identifier: GPL-3.0-or-later
// Pixel spreading: POV-Ray samples each pixel within its square; its picture is blurred by the rest
// of the pixel filter when it is drawn.
#pragma once

#include "povray_export/run/povray_runner.h"

namespace lodestone::povray {

/// Blurs a picture's file by a variance in square pixels (image::missing_spread()), in linear light;
/// of a picture with a border only what is drawn. A .ppm stays as it is, and so does everything with
/// a variance of 0, and a picture of more than image::kMostPixels, which would not fit in memory. `settings`: the scene.ini that was drawn. Throws Error(PovrayFailed) when the
/// picture cannot be read, Error(Io) when it cannot be written.
void spread_picture(const std::filesystem::path& picture, OutputFormat format, double variance,
                    const std::filesystem::path& settings);

}  // namespace lodestone::povray
