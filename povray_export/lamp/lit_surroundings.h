// SPDX-License-Identifier: GPL-3.0-or-later
// Lit surroundings: the light of lit surfaces around that things show. POV-Ray's mirrors are sharp,
// so rough metal would be black, and the gloss of all else dark, wherever it is not the sky or a
// lamp that they show.
#pragma once

#include "light/light_around.h"
#include "povray_export/lamp/sky_light.h"

namespace lodestone::povray {

/// How a drawn thing is seen.
struct SurroundedThing {
    double pixels = 0;  // how many it is across in the picture; 0: it is not seen
    SkyLightPtr sky;    // the sky's light on it; null: all of it
};

/// The lit surfaces around each drawn thing, in steps; none around things that are too small to show
/// them. Copies under one light of the sky have one, those of rough metal few. Only rough metal has
/// any where light bounces, for all else has them from there, and in frames of an animation, where
/// what moves would change all files around it: `still` says that it is a picture alone. Where rays
/// cannot be cast, or there is too much to cast them at, there are none. Throws Error(Cancelled).
std::vector<light::LightAround> lit_surroundings(const Model& model,
                                                 const light::RendererSurfaces& renderer,
                                                 std::span<const light::DrawnThing> drawn,
                                                 std::span<const SurroundedThing> things,
                                                 const light::LightDemands& demands, bool still,
                                                 const Job& job);

}  // namespace lodestone::povray
