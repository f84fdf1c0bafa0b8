// SPDX-License-Identifier: GPL-3.0-or-later
// MeshSource: where the meshes of a model's representations come from.
#pragma once

#include "model/model.h"

#include <functional>
#include <memory>

namespace lodestone::hierarchy {

/// Gives the mesh of a representation, resident or not. Called from several threads.
using MeshSource = std::function<std::shared_ptr<const Mesh>(const Representation&)>;

}  // namespace lodestone::hierarchy
