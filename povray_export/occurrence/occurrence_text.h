// SPDX-License-Identifier: GPL-3.0-or-later
// Occurrence text: the flags and the comment of an occurrence, besides its shape and place.
#pragma once

#include "choose/cut.h"

#include <optional>
#include <string>

namespace lodestone::povray {

/// The position of a use that is not of the cut itself.
/// Law: the largest number; no cut chooses so many.
inline constexpr size_t kNoPosition = ~size_t{0};

/// A use of a representation in the scene.
struct OccurrenceUse {
    uint32_t node;
    uint32_t lod;
    size_t position;  // in cut.chosen, or kNoPosition
    size_t file;      // index of the include file
    Affine world;
    RayMask hidden;        // ray classes that do not see it
    RayMask in_place = 0;  // Not 0: in place of what the camera sees, for these classes only
    std::optional<glm::dvec3> dull = {};  // shown in this color alone
};

/// Appends the object of a use, in a scene enlarged `times`, up to the beginning of a comment. `flat`:
/// it has this color without light. `within`: only its part in a box (world frame).
void append_occurrence(std::string& out, const std::string& identifier, const OccurrenceUse& use,
                       const std::optional<glm::dvec3>& flat, double times,
                       const std::optional<Box3>& within);

/// Appends POV-Ray's flags; only ever on single objects, as it loses no_image in some of its CSG.
void append_hidden(std::string& out, RayMask hidden);

/// Appends the name of a node's placement, as far as it may stand in a comment: letters, digits and
/// underscores only, at most 60.
void append_name(std::string& out, const Model& model, const choose::Cut& cut, uint32_t node);

}  // namespace lodestone::povray
