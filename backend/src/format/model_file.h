// SPDX-License-Identifier: GPL-3.0-or-later
// Format: models from and to files, by their extension.
#pragma once

#include "model/model.h"

#include <filesystem>

namespace lodestone::format {

/// .obj and .ply (coordinates as in the file), .glb and .gltf (Y up turned to Z up); see their
/// headers. Polygons are cut as fans from their first corner; meshes are repaired; other files are
/// opened only inside the folder of `path`. Throws Error(Io) or Error(BadFile) naming the file; the
/// latter, too, where there are errors in it and no triangle is left.
Model read_model(const std::filesystem::path& path, Problems& problems);

/// .glb keeps placements and sharing. .obj (with an .mtl and the pictures, "<16 hex>.png", beside
/// it) and .ply (without materials) hold the finest representations of all occurrences in one mesh.
/// Throws Error(Io) or Error(InvalidArgument).
void write_model(const std::filesystem::path& path, const Model& model);

/// All occurrences below the root in one mesh. `materials[slot]` indexes model.materials; slots of
/// the parts beyond their representation's materials become its first, or a slot of ~0 (none).
Mesh flattened(const Model& model, std::vector<uint32_t>& materials);

}  // namespace lodestone::format
