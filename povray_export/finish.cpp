// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/finish.h"

#include "povray_export/number.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::povray {
namespace {

constexpr int kDigits = 6;

double clamped(double value, double low, double high, double otherwise) {
    return std::isfinite(value) ? std::clamp(value, low, high) : otherwise;
}

void append_named(std::string& out, const char* name, double value) {
    out += name;
    append_number(out, value, kDigits);
}

glm::dvec3 from_srgb(const glm::dvec3& color) {
    glm::dvec3 linear;
    for (int i = 0; i < 3; ++i)
        linear[i] =
            color[i] <= 0.04045 ? color[i] / 12.92 : std::pow((color[i] + 0.055) / 1.055, 2.4);
    return linear;
}

}  // namespace

Look look_of(const Material& material) {
    Look look;
    look.roughness = clamped(material.roughness, 0, 1, 0.5);
    look.metallic = clamped(material.metallic, 0, 1, 0);
    look.specular = clamped(material.specular, 0, 1, 0.5);
    look.clearcoat = clamped(material.clearcoat, 0, 1, 0);
    look.clearcoat_roughness = clamped(material.clearcoat_roughness, 0, 1, 0.03);
    return look;
}

Finish finish_of(const Look& look, double brightest) {
    const double dielectric = (1 - look.metallic) * 0.08 * look.specular;
    const double mirror = look.metallic > 0.5 && look.roughness < 0.3 ? look.metallic : 0;
    const double reflectance = look.metallic + dielectric;
    const double room = brightest > 0 ? std::min(1.0, (1 - dielectric) / brightest) : 1.0;
    const double alpha = std::max(look.roughness * look.roughness, 0.02);
    Finish finish;
    finish.ambient = 1 - mirror;
    finish.diffuse = (1 - look.metallic) * room;
    finish.specular = reflectance;
    finish.roughness = 1 / std::max(2 / (alpha * alpha) - 2, 1.0);
    finish.metallic = reflectance > 0 ? look.metallic / reflectance : 0;
    finish.mirror = finish.mirror_grazing = mirror;
    finish.mirror_metallic = 1;
    return finish;
}

void append_rgb(std::string& out, const glm::dvec3& color) {
    out += "rgb ";
    append_vector(out, color, kDigits);
}

void append_finish(std::string& out, const Finish& finish, double light,
                   const glm::dvec3& emission) {
    append_named(out, "finish{ambient ", finish.ambient * light);
    out += " emission ";
    append_rgb(out, emission);
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

void append_glass_finish(std::string& out, const Look& look) {
    Look clear = look;
    clear.metallic = 0;
    const Finish finish = finish_of(clear, 1);
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
    static constexpr glm::dvec3 kMesh[] = {{.84, .84, .84}, {.27, .33, .66}, {.16, .50, .73},
                                           {.13, .64, .65}, {.27, .75, .44}, {.62, .82, .23},
                                           {.95, .88, .15}};
    switch (kind) {
        case Kind::Box:
            return from_srgb({.93, .45, .13});
        case Kind::Ellipsoid:
            return from_srgb({.82, .20, .58});
        case Kind::Mesh:
        case Kind::Assembly:
            break;
    }
    return from_srgb(kMesh[std::min<size_t>(lod, std::size(kMesh) - 1)]);
}

}  // namespace lodestone::povray
