// SPDX-License-Identifier: GPL-3.0-or-later
// Empty scene: the memory that POV-Ray needs before it draws anything; reports give memory above
// it.
#pragma once

#include "povray_export/run/povray_runner.h"
#include "povray_export/scene/scene_writer.h"

namespace lodestone::povray {

/// The peak memory, in bytes, of the same picture (size, antialiasing, output, threads) of nothing.
/// It is measured once per process for each such picture. Throws like export_scene() and
/// render_scene().
uint64_t empty_scene_bytes(const View& view, Antialiasing antialiasing, const RunOptions& like,
                           const Job& job = {});

}  // namespace lodestone::povray
