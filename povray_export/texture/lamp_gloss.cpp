// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/texture/lamp_gloss.h"

#include "povray_export/scene/povray_number.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace lodestone::povray {
namespace {

/// The digits of a number.
/// Taste: a larger value writes longer files for nothing that shows.
constexpr int kLampDigits = 6;
/// The specular value for which the rows hold: an index of refraction of 1.5.
/// Law: Blender's scale.
constexpr double kFittedSpecular = 0.5;
/// The angle of GrazingGloss::kAngles at which the strength of a highlight that grows is taken.
/// Taste: seen flatter little is left of a surface.
constexpr size_t kFlat = GrazingGloss::kAngles.size() - 2;
/// The exponent by which weaker and stronger gloss come together as they are seen flatter.
/// Fitted: by tests/bench/peers/fit_grazing.py, as that of grazing_gloss.cpp.
constexpr double kTogether = 0.75;
/// The factor that makes a pigment nearly black, and its finish as much brighter.
/// Taste: less tints the highlights of lamps overhead, more takes digits from the pigment.
constexpr double kDarkened = 64;
/// The least of a color that a finish is divided by.
/// Taste: lit, it is never seen; a larger value makes black surfaces gray.
constexpr double kLeastColor = 1e-4;

/// The gloss of surfaces of one roughness.
struct LampRow {
    double roughness;
    double log_exponent;
    double highlight;
    double fading;
    double white;  // the share of what the sky's reflection grows by the angle
};

/// The gloss by roughness, rising.
/// Fitted: by tests/bench/peers/fit_grazing.py, on planes rendered by Cycles of Blender 3.4.
const LampRow kLampRows[] = {
    {0.10, std::log(197.8), 0.1345, 0.85, 0},    {0.20, std::log(164.8), 0.4790, 0.93, 0},
    {0.25, std::log(114.5), 1.2420, 0.97, 0},    {0.30, std::log(95.4), 1.0597, 0.95, 0.125},
    {0.40, std::log(55.2), 1.4558, 0.97, 0.125}, {0.50, std::log(38.3), 1.0597, 0.95, 0.375},
    {0.60, std::log(31.9), 0.6581, 0.93, 0.75},  {0.70, std::log(26.6), 0.3487, 0.9, 1},
    {0.80, std::log(15.4), 0.1572, 0.8, 1},      {0.90, std::log(8.9), 0.0816, 0.7, 1},
    {1.00, std::log(3.0), 0.0310, 0.3, 1},
};

LampRow lamp_row(double roughness) {
    size_t i = 1;
    while (i + 1 < std::size(kLampRows) && kLampRows[i].roughness < roughness)
        ++i;
    const LampRow& a = kLampRows[i - 1];
    const LampRow& b = kLampRows[i];
    const double t = std::clamp((roughness - a.roughness) / (b.roughness - a.roughness), 0.0, 1.0);
    return {roughness, std::lerp(a.log_exponent, b.log_exponent, t),
            std::lerp(a.highlight, b.highlight, t), std::lerp(a.fading, b.fading, t),
            std::lerp(a.white, b.white, t)};
}

}  // namespace

std::optional<LampGloss> lamp_gloss(const SurfaceLook& look) {
    const std::optional<GrazingGloss> gloss = grazing_gloss(look);
    if (!gloss || look.metallic > 0 || look.clearcoat > 0)
        return std::nullopt;
    const LampRow row = lamp_row(look.roughness);
    const double over = look.specular / kFittedSpecular;
    // Highlights of lamps overhead are as strong as the gloss, those of flat ones less apart.
    const double overhead = row.highlight * (1 - row.fading) * over;
    const double flat =
        row.highlight * row.fading * std::pow(over, std::pow(1 / gloss->grow[kFlat], kTogether));
    LampGloss out{};
    for (size_t k = 0; k < out.white.size(); ++k) {
        out.sky[k] = gloss->sky * gloss->grow[k];
        out.white[k] = row.white * (out.sky[k] - gloss->sky);
    }
    out.matte = gloss->matte;
    out.highlight = overhead + flat;
    out.roughness = std::exp(-row.log_exponent);
    out.fading = flat / out.highlight;
    return out;
}

LampGlossText lamp_gloss_text(const LampGloss& gloss, const glm::dvec3& color, const Finish& finish,
                              const GlossLight& light) {
    // Law: POV-Ray's pattern is 1 for what faces the eye, and 1/2 at no angle.
    constexpr double kFacing = 1;
    // Law: degrees of half a turn, over which the pattern falls to 0.
    constexpr double kHalfTurn = 180;
    LampGlossText out;
    out.pigment = "pigment{aoi color_map{";
    for (size_t k = gloss.white.size(); k-- > 0;) {
        out.pigment += '[';
        append_number(out.pigment, kFacing - GrazingGloss::kAngles[k] / kHalfTurn, kLampDigits);
        out.pigment += ' ';
        const glm::dvec3 shown = color * gloss.matte[k] + gloss.white[k];
        append_rgb(out.pigment, glm::max(shown, glm::dvec3(kLeastColor)) / kDarkened);
        out.pigment += ']';
    }
    out.pigment += '}';
    out.finish = finish;
    out.finish.diffuse *= kDarkened;
    // Gloss is exact at the angle where it is brightest for such a pigment, and nowhere brighter than
    // it is.
    const auto answer = [&](double matte, double arriving, double channel) {
        double least = std::numeric_limits<double>::infinity();
        for (size_t k = 0; k < gloss.white.size(); ++k) {
            const double whole = matte * channel * gloss.matte[k] + arriving * gloss.sky[k];
            const double pigment = channel * gloss.matte[k] + gloss.white[k];
            least = std::min(least, whole / std::max(pigment, kLeastColor));
        }
        return kDarkened * least;
    };
    for (int i = 0; i < 3; ++i) {
        out.finish.ambient[i] = answer(finish.ambient[i], light.sky, color[i]);
        out.finish.glow[i] = answer(finish.glow[i], light.around[i], color[i]);
    }
    out.finish.specular = gloss.highlight;
    out.finish.roughness = gloss.roughness;
    out.finish.metallic = gloss.fading;
    return out;
}

}  // namespace lodestone::povray
