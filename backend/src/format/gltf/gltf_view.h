// SPDX-License-Identifier: GPL-3.0-or-later
// glTF view: its cameras and lights as ours; included only by glTF's own files.
#pragma once

#include "base/error.h"
#include "model/model.h"

#include <functional>
#include <vector>

namespace tinygltf {
class Model;
}

namespace lodestone::format {

/// Adds the cameras and punctual lights (KHR_lights_punctual) of the nodes in `order` (parents
/// first) to a model; `transform` gives a node's own transform in our frame. Lumen and lux become
/// Blender's watts by 683 lm/W, as in Blender's own importer.
void read_view(const tinygltf::Model& from, const std::vector<int>& order,
               const std::function<Affine(int)>& transform, Model& model, Problems& problems);

}  // namespace lodestone::format
