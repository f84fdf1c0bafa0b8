// SPDX-License-Identifier: GPL-3.0-or-later
// Clear surfaces: which object of a scene has the most of them one behind the other.
#pragma once

#include "choose/cut.h"
#include "model/model.h"

#include <span>
#include <string>

namespace lodestone::povray {

/// An occurrence with many clear surfaces one behind the other.
struct ClearOccurrence {
    uint32_t node = 0;  // of the cut
    double layers = 0;
};

/// The object with the most clear surfaces in all of its occurrences, as a comment that
/// render_scene() reads, and a problem where POV-Ray may not bear those of one; "" without any.
std::string clear_surfaces_text(const Model& model, const choose::Cut& cut,
                                std::span<const ClearOccurrence> occurrences, Problems& problems);

}  // namespace lodestone::povray
