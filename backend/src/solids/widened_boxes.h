// SPDX-License-Identifier: GPL-3.0-or-later
// Widened boxes: clear boxes for what is long and thinner than a pixel.
#pragma once

#include "solids/solid_replacement.h"

#include <optional>

namespace lodestone::solids {

/// Long and thin: a post, wire, rail, mast or twig.
struct ThinPart {
    Primitive box;  // as long as it is and as thick as its variances say, the long axis first
    double visible_area = 0;

    /// Metres, the larger one across.
    double thickness() const;
};

/// Of a loose part with these attributes, if it is at least 12 times longer than thick.
std::optional<ThinPart> find_thin_part(const Mesh& part, const Attributes& attributes);

/// So wide across (metres, more than it is thick), as long, and as much more transparent as it is
/// wider: area times opacity stays. None reaches below `floor`.
ClearSolid widened_box(const ThinPart& thin, double width, double floor);

}  // namespace lodestone::solids
