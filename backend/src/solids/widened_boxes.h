// SPDX-License-Identifier: GPL-3.0-or-later
// Widened boxes: clear boxes for parts that are long and thinner than a pixel.
#pragma once

#include "solids/solid_replacement.h"

#include <optional>

namespace lodestone::solids {

/// A long and thin part: a post, wire, rail, mast or twig.
struct ThinPart {
    Primitive
        box;  // has the part's length and the thickness of its variances; the long axis is first
    double visible_area = 0;

    /// The thickness in metres, the larger one of the two.
    double thickness() const;
};

/// The thin part of a loose part with these attributes, if it is at least 12 times longer than
/// thick.
std::optional<ThinPart> find_thin_part(const Mesh& part, const Attributes& attributes);

/// The box with this width across (metres, more than its thickness), as long, and as much more
/// transparent as it is wider: area times opacity stays. None reaches below `floor`.
ClearSolid widened_box(const ThinPart& thin, double width, double floor);

}  // namespace lodestone::solids
