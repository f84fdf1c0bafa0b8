// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/texture/grazing_gloss.h"

#include "povray_export/scene/povray_number.h"

#include <algorithm>
#include <cmath>

namespace lodestone::povray {
namespace {

constexpr size_t kAngleCount = GrazingGloss::kAngles.size();

/// The digits of a number.
/// Taste: a larger value writes longer files for nothing that shows.
constexpr int kGlossDigits = 4;

/// The specular value for which the rows hold: an index of refraction of 1.5.
/// Law: Blender's scale.
constexpr double kUsualSpecular = 0.5;
/// The albedo of a clear coat over that of the surface below it.
/// Law: the strength of Disney's clear coat, which Cycles has.
constexpr double kCoat = 0.25;
/// The exponent by which weaker and stronger gloss come together as they are seen flatter: at no
/// angle everything reflects.
/// Fitted: by tests/bench/peers/fit_grazing.py, at specular 0.2 and 1, within 15 % at 80 degrees.
constexpr double kSaturation = 0.75;
/// The least share of the surface that the layer of gloss covers.
/// Taste: what POV-Ray interpolates between two angles is then off by 3 % at most; a larger value
/// makes it better, and the surface below needs a stronger finish.
constexpr double kLeastCover = 0.25;

/// The angle at which highlights grow as much as they should.
/// Taste: seen flatter little is left of a surface.
constexpr size_t kSame = kAngleCount - 2;

/// The reflection of surfaces of one roughness.
struct GrazingRow {
    double roughness;
    double log_exponent;
    double highlight;
    double lamp_growth;
    std::array<double, kAngleCount> sky;    // of a uniform sky of 1, by angle
    std::array<double, kAngleCount> matte;  // of the surface without gloss, over facing
};

/// The gloss by roughness, rising.
/// Fitted: by tests/bench/peers/fit_grazing.py, on planes rendered by Cycles of Blender 3.4.
/// Highlights of surfaces that mirror are not used.
const GrazingRow kGrazingRows[] = {
    {0.10,
     std::log(197.8),
     0.0118,
     1,
     {0.040, 0.046, 0.058, 0.089, 0.171, 0.385, 0.757},
     {1.000, 1.000, 0.997, 0.988, 0.953, 0.850, 0.634}},
    {0.20,
     std::log(137.4),
     0.0344,
     1,
     {0.040, 0.046, 0.058, 0.089, 0.167, 0.349, 0.544},
     {1.000, 0.999, 0.998, 0.992, 0.967, 0.892, 0.727}},
    {0.25,
     std::log(95.4),
     0.0401,
     2,
     {0.040, 0.046, 0.058, 0.089, 0.161, 0.311, 0.454},
     {1.000, 0.999, 0.998, 0.993, 0.974, 0.913, 0.773}},
    {0.30,
     std::log(95.4),
     0.0467,
     2,
     {0.040, 0.046, 0.058, 0.087, 0.151, 0.268, 0.377},
     {1.000, 0.999, 0.998, 0.995, 0.982, 0.934, 0.819}},
    {0.40,
     std::log(46.0),
     0.0543,
     2,
     {0.039, 0.046, 0.056, 0.079, 0.123, 0.192, 0.259},
     {1.000, 0.999, 0.998, 0.999, 0.996, 0.977, 0.912}},
    {0.50,
     std::log(31.9),
     0.0295,
     5,
     {0.037, 0.043, 0.051, 0.067, 0.095, 0.137, 0.181},
     {1.000, 0.999, 0.999, 1.003, 1.011, 1.020, 1.004}},
    {0.60,
     std::log(22.2),
     0.0218,
     7,
     {0.034, 0.038, 0.044, 0.054, 0.072, 0.100, 0.131},
     {1.000, 0.998, 1.000, 1.006, 1.025, 1.062, 1.097}},
    {0.70,
     std::log(15.4),
     0.0138,
     9,
     {0.029, 0.032, 0.036, 0.044, 0.055, 0.075, 0.098},
     {1.000, 0.998, 1.000, 1.010, 1.040, 1.104, 1.191}},
    {0.80,
     std::log(7.4),
     0.0254,
     3,
     {0.023, 0.026, 0.029, 0.035, 0.043, 0.057, 0.075},
     {1.000, 0.998, 1.000, 1.013, 1.054, 1.147, 1.285}},
    {0.90,
     std::log(3.0),
     0.0254,
     2,
     {0.017, 0.020, 0.023, 0.027, 0.034, 0.044, 0.058},
     {1.000, 0.998, 1.000, 1.016, 1.069, 1.188, 1.377}},
    {1.00,
     std::log(1.4),
     0.0160,
     2,
     {0.013, 0.015, 0.018, 0.021, 0.026, 0.035, 0.046},
     {1.000, 0.997, 1.002, 1.020, 1.083, 1.233, 1.470}},
};

GrazingRow grazing_row(double roughness) {
    size_t i = 1;
    while (i + 1 < std::size(kGrazingRows) && kGrazingRows[i].roughness < roughness)
        ++i;
    const GrazingRow& a = kGrazingRows[i - 1];
    const GrazingRow& b = kGrazingRows[i];
    const double t = std::clamp((roughness - a.roughness) / (b.roughness - a.roughness), 0.0, 1.0);
    GrazingRow out{roughness,
                   std::lerp(a.log_exponent, b.log_exponent, t),
                   std::lerp(a.highlight, b.highlight, t),
                   std::lerp(a.lamp_growth, b.lamp_growth, t),
                   {},
                   {}};
    for (size_t k = 0; k < kAngleCount; ++k)
        out.sky[k] = std::lerp(a.sky[k], b.sky[k], t);
    for (size_t k = 0; k < kAngleCount; ++k)
        out.matte[k] = std::lerp(a.matte[k], b.matte[k], t);
    return out;
}

/// The gloss as the color of a pigment.
struct CoveredGloss {
    std::array<double, kAngleCount> white;    // at each angle, over that of facing
    std::array<double, kAngleCount> through;  // the share of what is below that is seen
};

/// The gloss as a layer: it lets the surface below through as that is bright at an angle, and is
/// the brighter itself the less it covers.
CoveredGloss covered_gloss(const GrazingGloss& gloss) {
    const double brightest = *std::max_element(gloss.matte.begin(), gloss.matte.end());
    CoveredGloss out{};
    for (size_t k = 0; k < kAngleCount; ++k) {
        out.through[k] = (1 - kLeastCover) * gloss.matte[k] / brightest;
        out.white[k] = gloss.grow[k] * (1 - out.through[0]) / (1 - out.through[k]);
    }
    return out;
}

void append_grazing_pigment(std::string& out, const CoveredGloss& gloss) {
    // Law: POV-Ray's pattern is 1 for what faces the eye, and 1/2 at no angle.
    constexpr double kFacing = 1;
    // Law: degrees of half a turn, over which the pattern falls to 0.
    constexpr double kHalfTurn = 180;
    out += "pigment{aoi pigment_map{";
    for (size_t k = kAngleCount; k-- > 0;) {
        out += '[';
        append_number(out, kFacing - GrazingGloss::kAngles[k] / kHalfTurn, kGlossDigits);
        out += " rgbt <";
        for (int i = 0; i < 3; ++i) {
            append_number(out, gloss.white[k], kGlossDigits);
            out += ',';
        }
        append_number(out, gloss.through[k], kGlossDigits);
        out += ">]";
    }
    out += "}}";
}

/// The numbers of a finish that depend on how the gloss is drawn.
struct GlossScale {
    double sky;        // what it shows of all around
    double highlight;  // times what it is
    double growth;     // POV-Ray's metallic
};

void append_grazing_finish(std::string& out, const GrazingGloss& gloss, const GlossLight& light,
                           const GlossScale& scale) {
    const auto named = [&](const char* name, double value) {
        out += name;
        append_number(out, value, 6);
    };
    named("finish{ambient ", light.sky * scale.sky);
    out += " emission ";
    if (light.around == glm::dvec3(0.0))
        out += '0';
    else
        append_rgb(out, light.around * scale.sky);
    named(" diffuse 0 specular albedo ", gloss.highlight * scale.highlight);
    named(" roughness ", gloss.roughness);
    named(" metallic ", scale.growth);
    out += " reflection{rgb 0}}";
}

}  // namespace

std::optional<GrazingGloss> grazing_gloss(const SurfaceLook& look) {
    const Finish finish = finish_of(look);
    const double weight = (1 - look.metallic) * look.specular / kUsualSpecular;
    if (!(weight > 0) || finish.mirror > 0 || finish.mirror_grazing > 0)
        return std::nullopt;
    const GrazingRow row = grazing_row(look.roughness);
    const GrazingRow coat = grazing_row(look.clearcoat_roughness);
    const double over = look.specular / kUsualSpecular;
    std::array<double, kAngleCount> sky{};
    for (size_t k = 0; k < kAngleCount; ++k) {
        const double near = std::pow(row.sky[0] / row.sky[k], kSaturation);
        sky[k] = (1 - look.metallic) * std::pow(over, near) * row.sky[k] +
                 look.clearcoat * kCoat * coat.sky[k];
    }
    GrazingGloss out;
    out.sky = sky[0];
    for (size_t k = 0; k < kAngleCount; ++k)
        out.grow[k] = sky[k] / sky[0];
    out.matte = row.matte;
    out.highlight = weight * row.highlight;
    out.roughness = std::exp(-row.log_exponent);
    // Weak gloss of a sky grows the more, of which some is met at no angle. Most lamps are
    // met at half angles where it reflects as little as it does when facing.
    const double usual = row.sky[kSame] / row.sky[0] - 1;
    // Law: gloss that is stronger than any grows less; its highlight need not make up for all of it.
    constexpr double kMostTimes = 4;
    out.lamp_growth =
        row.lamp_growth * std::min(kMostTimes, usual / std::max(out.grow[kSame] - 1, 1e-3));
    return out;
}

GlossText gloss_alone(const GrazingGloss& gloss, const GlossLight& light, double times) {
    const CoveredGloss plain{gloss.grow, {}};
    const CoveredGloss layer = covered_gloss(gloss);
    // The highlight of the layer follows another pigment: it is to grow as much at kSame.
    const double growth =
        gloss.lamp_growth * (layer.white[kSame] - 1) / std::max(gloss.grow[kSame] - 1, 1e-3);
    GlossText out;
    append_grazing_pigment(out.pigment, plain);
    append_grazing_finish(out.finish, gloss, light, {gloss.sky * times, times, growth});
    return out;
}

GlossText gloss_layer(const GrazingGloss& gloss, const GlossLight& light) {
    const CoveredGloss layer = covered_gloss(gloss);
    GlossText out;
    append_grazing_pigment(out.pigment, layer);
    append_grazing_finish(out.finish, gloss, light,
                          {gloss.sky / (1 - layer.through[0]), 1, gloss.lamp_growth});
    out.below = 1 / layer.through[0];
    return out;
}

}  // namespace lodestone::povray
