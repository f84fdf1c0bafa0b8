// SPDX-License-Identifier: GPL-3.0-or-later
// Lit uses: what is drawn within each group of lights, and what throws the shadows of things in parts.
#pragma once

#include "light/light_plan.h"
#include "povray_export/occurrence/occurrence_text.h"

#include <optional>
#include <span>
#include <vector>

namespace lodestone::povray {

/// All uses, by their numbers, also those of which nothing is drawn, for lights: these are chosen by
/// what the camera sees, as if all rays met that. `replaced`: by node, the classes of rays that meet
/// other uses in its place.
std::vector<light::DrawnThing> drawn_things(const Model& model, const choose::Cut& cut,
                                            std::span<const OccurrenceUse> uses,
                                            std::span<const RayMask> replaced);

/// A use within a group of lights of a plan.
struct LitUse {
    OccurrenceUse use;
    std::optional<Box3> within;          // only its part in a box (world frame)
    std::optional<uint32_t> group = {};  // nothing: outside of all groups
};

/// The uses that draw `drawn`, which a plan numbers so. A thing in several parts throws its shadow as
/// a whole, outside of all groups, and its parts throw none: a ray to a lamp would meet every part
/// whose box it passes.
std::vector<LitUse> lit_uses(std::span<const OccurrenceUse> drawn, const light::LightPlan& plan);

/// The shadow rays to lamps of groups that a point of each thing takes, about: the mean over its
/// parts, by the squares of their sizes. `bounds`: of the things, world frame.
std::vector<double> lamp_rays(std::span<const Bound> bounds, const light::LightPlan& plan);

}  // namespace lodestone::povray
