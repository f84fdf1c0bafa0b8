// SPDX-License-Identifier: GPL-3.0-or-later
// Occurrence text: the flags and the comment of an occurrence, besides its shape and place.
#pragma once

#include "choose/cut.h"

#include <string>

namespace lodestone::povray {

/// Appends POV-Ray's flags; only ever on single objects, as it loses no_image in some of its CSG.
void append_hidden(std::string& out, RayMask hidden);

/// Appends the name of a node's placement, as far as it may stand in a comment: letters, digits and
/// underscores only, at most 60.
void append_name(std::string& out, const Model& model, const choose::Cut& cut, uint32_t node);

}  // namespace lodestone::povray
