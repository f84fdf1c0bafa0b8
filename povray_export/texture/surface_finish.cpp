// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/texture/surface_finish.h"

#include "base/color.h"
#include "povray_export/scene/povray_number.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::povray {
namespace {

/// The digits of a number in a finish.
/// Taste: a larger value writes longer files for nothing that shows.
constexpr int kDigits = 6;

double clamped(double value, double low, double high, double otherwise) {
    return std::isfinite(value) ? std::clamp(value, low, high) : otherwise;
}

void append_named(std::string& out, const char* name, double value) {
    out += name;
    append_number(out, value, kDigits);
}

/// A row that tests/bench/peers/fit_finish.py found for one roughness, against Cycles of Blender 3.4:
/// specular 0.5 and clear coat 1, times what they are. Exponents are of Blinn's half vector
/// (`specular`), the coat's of Phong's mirror direction. A metal is a highlight and a diffuse term,
/// both tinted: without the latter rough ones are 20/255 off, with it 8/255. `sky` and `metal_sky`
/// are the light that comes back from a uniform sky of 1, between the mean of a sphere and what
/// faces the eye. Entries below 0.05 repeat it: there Cycles without indirect light shows no sun.
struct FinishRow {
    double roughness;
    double log_exponent;
    double highlight;
    double sky;
    double metal_brilliance;
    double metal_diffuse;
    double metal_log_exponent;
    double metal_highlight;
    double metal_sky;
};

/// The finishes by roughness, rising.
/// Fitted: by tests/bench/peers/fit_finish.py, on balls rendered by Cycles of Blender 3.4.
const FinishRow kRows[] = {
    {0.00, std::log(16440), 0.0350, 0.0488, 3.0, 0.0004, std::log(16440), 0.150, 1.000},
    {0.05, std::log(8000), 0.0300, 0.0465, 3.0, 0.0008, std::log(7483), 0.176, 1.000},
    {0.10, std::log(2400), 0.0281, 0.0465, 3.0, 0.0033, std::log(706), 0.226, 0.998},
    {0.15, std::log(543), 0.0317, 0.0465, 2.8, 0.0083, std::log(247), 0.260, 0.997},
    {0.20, std::log(321), 0.0389, 0.0465, 2.2, 0.0153, std::log(146), 0.360, 0.994},
    {0.25, std::log(190), 0.0447, 0.0464, 1.3, 0.0199, std::log(86.5), 0.454, 0.985},
    {0.30, std::log(112), 0.0473, 0.0461, 0.9, 0.0267, std::log(51.2), 0.506, 0.977},
    {0.40, std::log(39.4), 0.0477, 0.0443, 0.8, 0.0608, std::log(30.3), 0.697, 0.939},
    {0.50, std::log(17.9), 0.0477, 0.0405, 0.8, 0.1247, std::log(23.3), 0.788, 0.871},
    {0.60, std::log(8.16), 0.0459, 0.0356, 0.9, 0.2179, std::log(17.9), 0.677, 0.803},
    {0.70, std::log(3.71), 0.0398, 0.0302, 0.9, 0.3004, std::log(13.8), 0.458, 0.678},
    {0.80, std::log(2.20), 0.0328, 0.0247, 0.8, 0.3481, std::log(13.8), 0.228, 0.554},
    {0.90, std::log(1.30), 0.0257, 0.0194, 0.8, 0.3686, std::log(13.8), 0.053, 0.429},
    {1.00, std::log(1.30), 0.0210, 0.0152, 0.6, 0.2946, std::log(13.8), 0.000, 0.321},
};

struct CoatRow {
    double roughness;
    double log_exponent;
    double highlight;
    double sky;
};

/// The clear coats by roughness, rising.
/// Fitted: by tests/bench/peers/fit_finish.py, on balls rendered by Cycles of Blender 3.4.
const CoatRow kCoatRows[] = {
    {0.00, std::log(2620), 0.0079, 0.0117}, {0.03, std::log(917), 0.0079, 0.0113},
    {0.10, std::log(51.2), 0.0072, 0.0113}, {0.20, std::log(13.8), 0.0075, 0.0112},
    {0.30, std::log(4.83), 0.0083, 0.0111}, {0.50, std::log(1.30), 0.0089, 0.0101},
    {0.70, std::log(1.30), 0.0075, 0.0083}, {1.00, std::log(1.30), 0.0051, 0.0056},
};

/// The two rows around a roughness, and where it lies between them.
template <typename Row_, size_t kCount>
double between(const Row_ (&rows)[kCount], double roughness, const Row_*& low, const Row_*& high) {
    size_t i = 1;
    while (i + 1 < kCount && rows[i].roughness < roughness)
        ++i;
    low = &rows[i - 1];
    high = &rows[i];
    return std::clamp((roughness - low->roughness) / (high->roughness - low->roughness), 0.0, 1.0);
}

FinishRow row_of(double roughness) {
    const FinishRow* a = nullptr;
    const FinishRow* b = nullptr;
    const double t = between(kRows, roughness, a, b);
    const auto mixed = [&](double FinishRow::*value) { return std::lerp(a->*value, b->*value, t); };
    return {roughness,
            mixed(&FinishRow::log_exponent),
            mixed(&FinishRow::highlight),
            mixed(&FinishRow::sky),
            mixed(&FinishRow::metal_brilliance),
            mixed(&FinishRow::metal_diffuse),
            mixed(&FinishRow::metal_log_exponent),
            mixed(&FinishRow::metal_highlight),
            mixed(&FinishRow::metal_sky)};
}

CoatRow coat_of(double roughness) {
    const CoatRow* a = nullptr;
    const CoatRow* b = nullptr;
    const double t = between(kCoatRows, roughness, a, b);
    const auto mixed = [&](double CoatRow::*value) { return std::lerp(a->*value, b->*value, t); };
    return {roughness, mixed(&CoatRow::log_exponent), mixed(&CoatRow::highlight),
            mixed(&CoatRow::sky)};
}

/// The share of a mirrored image that is traced: POV-Ray's is sharp, so it fades out where the true
/// one would be a blur. Metals show nothing else. The image of other surfaces is 4 % of the light
/// when facing, and costs the same: where all surfaces trace it a picture takes 3.4 times as long
/// (measured), so theirs ends earlier.
double sharpness(double roughness, double sharp, double blurred) {
    return std::clamp((blurred - roughness) / (blurred - sharp), 0.0, 1.0);
}
double metal_sharpness(double roughness) {
    return sharpness(roughness, 0.2, 0.35);
}
double coat_sharpness(double roughness) {
    return sharpness(roughness, 0.15, 0.25);
}

glm::dvec3 from_srgb(const glm::dvec3& color) {
    glm::dvec3 linear;
    for (int i = 0; i < 3; ++i)
        linear[i] = decode_srgb(color[i]);
    return linear;
}

}  // namespace

SurfaceLook look_of(const Material& material) {
    SurfaceLook look;
    for_each_field_of<double>([&](const MaterialField<double>& field) {
        double& number = look.*field.member;
        number = clamped(material.*field.member, field.clamped.low, field.clamped.high, number);
    });
    return look;
}

Finish finish_of(const SurfaceLook& look) {
    const double m = look.metallic;
    const FinishRow row = row_of(look.roughness);
    const double dielectric = (1 - m) * look.specular / 0.5;  // over the table's
    const double sharp = coat_sharpness(look.roughness);
    const double metal_sharp = metal_sharpness(look.roughness);
    const CoatRow coat = coat_of(look.clearcoat_roughness);
    const double coat_sharp = coat_sharpness(look.clearcoat_roughness);
    Finish finish;
    finish.diffuse = 1 - m + m * row.metal_diffuse;
    const double metal_share = finish.diffuse > 0 ? m * row.metal_diffuse / finish.diffuse : 0;
    finish.brilliance = std::lerp(1.1 - 0.25 * look.roughness, row.metal_brilliance, metal_share);
    finish.specular = dielectric * row.highlight + m * row.metal_highlight;
    if (finish.specular > 0) {
        finish.metallic = m * row.metal_highlight / finish.specular;
        finish.roughness =
            std::exp(-std::lerp(row.log_exponent, row.metal_log_exponent, finish.metallic));
    }
    finish.coat = look.clearcoat * coat.highlight;
    finish.coat_exponent = std::exp(coat.log_exponent);
    // The mirrored part is Schlick's curve, tinted as far as it is metal's.
    const double metal_mirror = m * metal_sharp * row.metal_sky;
    finish.mirror = metal_mirror + dielectric * sharp * 0.04 + look.clearcoat * coat_sharp * 0.01;
    finish.mirror_grazing = m * metal_sharp + (1 - m) * sharp * std::min(1.0, 2 * look.specular) +
                            look.clearcoat * coat_sharp * 0.25;
    finish.mirror_grazing = std::clamp(finish.mirror_grazing, finish.mirror, 1.0);
    finish.mirror_metallic = finish.mirror > 0 ? metal_mirror / finish.mirror : 0;
    finish.around = m * (1 - metal_sharp) * row.metal_sky;
    finish.ambient = glm::dvec3((1 - m) * (0.967 + 0.058 * look.roughness) + finish.around);
    return finish;
}

double white_gloss(const SurfaceLook& look) {
    const double dielectric = (1 - look.metallic) * look.specular / 0.5;
    return dielectric * (1 - coat_sharpness(look.roughness)) * row_of(look.roughness).sky +
           look.clearcoat * (1 - coat_sharpness(look.clearcoat_roughness)) *
               coat_of(look.clearcoat_roughness).sky;
}

double carried_by_gloss(const SurfaceLook& look, double gray) {
    // Fitted: Cycles of Blender 3.4 in a lit ball, roughness 0.3 ... 1, grays of 0.2 ... 0.8, facing:
    // it counts what gloss sends on as no bounce of matt light, and lets it carry matt light, too, the
    // more the brighter the surface is. More at flat angles. The script was not kept.
    constexpr double kCarried = 0.085;
    return kCarried * gray * std::min(1.0, (1 - look.metallic) * look.specular / 0.5);
}

void append_rgb(std::string& out, const glm::dvec3& color) {
    out += "rgb ";
    append_vector(out, color, kDigits);
}

void append_finish(std::string& out, const Finish& finish, double light,
                   const glm::dvec3& emission) {
    out += "finish{ambient ";
    append_rgb(out, finish.ambient * light);
    out += " emission ";
    append_rgb(out, emission + finish.glow * light);
    append_named(out, " diffuse ", finish.diffuse * light);
    if (finish.brilliance != 1)
        append_named(out, " brilliance ", finish.brilliance);
    append_named(out, " specular albedo ", finish.specular * light);
    append_named(out, " roughness ", finish.roughness);
    append_named(out, " metallic ", finish.metallic);
    if (finish.coat > 0) {
        append_named(out, " phong albedo ", finish.coat * light);
        append_named(out, " phong_size ", finish.coat_exponent);
    }
    if (finish.mirror > 0 || finish.mirror_grazing > 0) {
        append_named(out, " reflection{rgb ", finish.mirror * light);
        append_named(out, ", rgb ", finish.mirror_grazing * light);
        append_named(out, " falloff 5 metallic ", finish.mirror_metallic);
        out += '}';
    } else {
        out += " reflection{rgb 0}";
    }
    out += '}';
}

void append_glass_finish(std::string& out, const SurfaceLook& look) {
    SurfaceLook clear = look;
    clear.metallic = 0;
    const Finish finish = finish_of(clear);
    append_named(out, "finish{ambient 0 emission 0 diffuse 0 specular albedo ", finish.specular);
    append_named(out, " roughness ", finish.roughness);
    out += " reflection{rgb 0, rgb 1 fresnel on} conserve_energy}";
}

void append_flat_texture(std::string& out, const glm::dvec3& color) {
    out += "texture{pigment{";
    append_rgb(out, color);
    out += "} ";
    append_finish(out, Finish{}, 1, glm::dvec3(1.0));
    out += '}';
}

glm::dvec3 color_of(Kind kind, uint32_t lod) {
    // The colors of meshes by LOD number.
    // Taste: a scale that grows brighter from blue to yellow, as levels grow coarser.
    static constexpr glm::dvec3 kMesh[] = {{.84, .84, .84}, {.27, .33, .66}, {.16, .50, .73},
                                           {.13, .64, .65}, {.27, .75, .44}, {.62, .82, .23},
                                           {.95, .88, .15}};
    if (const auto& own = row_of(kind).false_color)
        return from_srgb({(*own)[0], (*own)[1], (*own)[2]});
    return from_srgb(kMesh[std::min<size_t>(lod, std::size(kMesh) - 1)]);
}

}  // namespace lodestone::povray
