// SPDX-License-Identifier: GPL-3.0-or-later
// Clear layers: how many half-clear surfaces of a mesh a ray meets, one behind the other.
#pragma once

#include "model/model.h"

#include <functional>

namespace lodestone::povray {

/// The most clear layers that any ray may meet.
/// Law: POV-Ray 3.7 traces what is behind a clear surface within the ray that met it, on a stack of a
/// fixed size: 260 cards with a texture of alpha are drawn, 280 end it by a signal. Shadow rays do
/// not do that. Half of that, for textures that take more of the stack.
inline constexpr double kMostLayers = 128;

/// The layers that a ray through the mesh's box meets on average (by Cauchy and Crofton), of the
/// triangles that `counts`: all cards of a stack. 0 for none.
double clear_layers(const Mesh& mesh, const std::function<bool(size_t)>& counts);

}  // namespace lodestone::povray
