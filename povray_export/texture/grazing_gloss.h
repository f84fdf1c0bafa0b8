// SPDX-License-Identifier: GPL-3.0-or-later
// Grazing gloss: how a rough surface reflects the more the flatter it is looked at (Fresnel), by a
// pigment that follows the angle of view. No ray is traced for it.
#pragma once

#include "povray_export/texture/surface_finish.h"

#include <array>
#include <optional>
#include <string>

namespace lodestone::povray {

/// The white reflection of a rough surface that is not metal.
struct GrazingGloss {
    /// The angles of view, in degrees from the normal, between which the reflection is linear.
    /// Taste: more knots follow the curve closer, in longer texts.
    static constexpr std::array<double, 7> kAngles{0, 40, 50, 60, 70, 80, 90};

    double sky = 0;                            // of a uniform sky of 1, when facing the eye
    std::array<double, kAngles.size()> grow;   // at each angle, over that
    std::array<double, kAngles.size()> matte;  // the light of the surface below, over facing
    double highlight = 0;                      // albedo of the highlight of lamps, when facing
    double roughness = 1;                      // that of the highlight: 1 / exponent
    double lamp_growth = 1;  // POV-Ray's metallic: how the highlight follows the pigment
};

/// The gloss of a look, found by fitting: tests/bench/peers/fit_grazing.py. None where there is
/// none, and of what is so smooth that it mirrors its surroundings.
std::optional<GrazingGloss> grazing_gloss(const SurfaceLook& look);

/// The light that gloss shows.
struct GlossLight {
    double sky = 1;          // the share of a uniform sky's light that arrives
    glm::dvec3 around{0.0};  // radiance of lit surfaces around that does
};

/// The texts of gloss. Bumps of the surface belong between the two.
struct GlossText {
    std::string pigment;  // pigment{...}
    std::string finish;   // finish{...}
    double below = 1;     // the factor on the finish of the surface below
};

/// The gloss alone, `times` as strong: white that grows with the angle of view.
GlossText gloss_alone(const GrazingGloss& gloss, const GlossLight& light, double times);
/// The gloss as a layer over the matte surface, which shines through by angle.
GlossText gloss_layer(const GrazingGloss& gloss, const GlossLight& light);

}  // namespace lodestone::povray
