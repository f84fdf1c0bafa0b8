// SPDX-License-Identifier: GPL-3.0-or-later
// Lamp gloss: how a rough surface of one color reflects lamps the more the flatter they shine, by a
// single texture. A layer for it would have its shadow rays cast once more.
#pragma once

#include "povray_export/texture/grazing_gloss.h"

#include <array>
#include <optional>
#include <string>

namespace lodestone::povray {

/// The white reflection of a rough surface that is not metal, as a texture without layers has it.
struct LampGloss {
    /// The white that the pigment gains at each of GrazingGloss::kAngles.
    std::array<double, GrazingGloss::kAngles.size()> white;
    std::array<double, GrazingGloss::kAngles.size()> matte;  // the surface below, over facing
    std::array<double, GrazingGloss::kAngles.size()> sky;    // of a uniform sky of 1, by angle
    double highlight = 0;  // albedo of the highlight of a lamp that shines at no angle
    double roughness = 1;  // that of the highlight: 1 / exponent
    double fading = 0;     // POV-Ray's metallic: the share that a lamp overhead does not have
};

/// The gloss of a look, found by fitting: tests/bench/peers/fit_grazing.py. None where there is
/// none, of what has a clear coat, of metal, and of what is so smooth that it mirrors.
std::optional<LampGloss> lamp_gloss(const SurfaceLook& look);

/// The texture of a surface of one color with such gloss: its pigment is so dark that the highlight
/// fades by `fading`, and the finish as much brighter.
struct LampGlossText {
    std::string pigment;  // pigment{...}, without its end
    Finish finish;
};

/// `finish`: of the surface, whose highlight is replaced.
LampGlossText lamp_gloss_text(const LampGloss& gloss, const glm::dvec3& color, const Finish& finish,
                              const GlossLight& light);

}  // namespace lodestone::povray
