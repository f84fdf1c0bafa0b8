// SPDX-License-Identifier: GPL-3.0-or-later
// Rough metal: the light of lit surfaces around that it shows. POV-Ray's mirrors are sharp, so what
// is rough would be black wherever it is not the sky or a lamp that it shows.
#pragma once

#include "light/light_around.h"

namespace lodestone::povray {

/// The lit surfaces around each drawn thing that shows rough metal, in steps, of which copies of one
/// thing have few; none around all others. `pixels`: how many each is across in the picture; 0: it
/// is not seen. Where rays cannot be cast, or there is too much to cast them at, there are none, too.
/// Throws Error(Cancelled).
std::vector<light::LightAround> light_on_rough_metal(const Model& model,
                                                     const light::RendererSurfaces& renderer,
                                                     std::span<const light::DrawnThing> drawn,
                                                     std::span<const double> pixels,
                                                     const light::LightDemands& demands,
                                                     const Job& job);

}  // namespace lodestone::povray
