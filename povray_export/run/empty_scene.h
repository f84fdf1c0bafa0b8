// SPDX-License-Identifier: GPL-3.0-or-later
// Empty scene: what POV-Ray needs before it draws anything; reports give memory above it.
#pragma once

#include "povray_export/run/povray_runner.h"
#include "povray_export/scene/scene_writer.h"

namespace lodestone::povray {

/// Peak memory of the same picture (size, antialiasing, output, threads) of nothing. Measured once
/// per process for each such picture. Throws what export_scene and run throw.
uint64_t empty_scene_bytes(const View& view, Antialiasing antialiasing, const RunOptions& like,
                           const Job& job = {});

}  // namespace lodestone::povray
