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

void append_rgb(std::string& out, const char* name, const glm::dvec3& color) {
    out += name;
    out += "rgb ";
    append_vector(out, color, kDigits);
}

glm::dvec3 from_srgb(const glm::dvec3& color) {
    glm::dvec3 linear;
    for (int i = 0; i < 3; ++i)
        linear[i] =
            color[i] <= 0.04045 ? color[i] / 12.92 : std::pow((color[i] + 0.055) / 1.055, 2.4);
    return linear;
}

}  // namespace

void append_texture(std::string& out, const Material& material) {
    glm::dvec3 base;
    glm::dvec3 emission;
    for (int i = 0; i < 3; ++i) {
        base[i] = clamped(material.base_color[i], 0, 1, 0.8);
        emission[i] = clamped(material.emission[i], 0, 1e9, 0);
        // POV-Ray multiplies emission by the pigment: a black lamp needs a trace of color.
        if (emission[i] > 0)
            base[i] = std::max(base[i], 1e-4);
    }
    const double metallic = clamped(material.metallic, 0, 1, 0);
    const double roughness = clamped(material.roughness, 0, 1, 0.5);
    const double dielectric = (1 - metallic) * 0.08 * clamped(material.specular, 0, 1, 0.5);
    const double mirror = metallic > 0.5 && roughness < 0.3 ? metallic : 0;
    const double reflectance = metallic + dielectric;
    const double brightest = std::max({base.x, base.y, base.z});
    const double room = brightest > 0 ? std::min(1.0, (1 - dielectric) / brightest) : 1.0;
    const double alpha = std::max(roughness * roughness, 0.02);  // below it the sun's own disc wins
    const double exponent = std::max(2 / (alpha * alpha) - 2, 1.0);

    append_rgb(out, "texture{pigment{", base);
    append_named(out, "} finish{ambient ", 1 - mirror);
    for (int i = 0; i < 3; ++i)
        emission[i] = emission[i] > 0 ? emission[i] / base[i] : 0;
    append_rgb(out, " emission ", emission);
    append_named(out, " diffuse ", (1 - metallic) * room);
    append_named(out, " specular albedo ", reflectance);
    append_named(out, " roughness ", 1 / exponent);
    append_named(out, " metallic ", reflectance > 0 ? metallic / reflectance : 0);
    append_rgb(out, " reflection{", base * mirror);
    out += "}}}";
}

void append_flat_texture(std::string& out, const glm::dvec3& color) {
    append_rgb(out, "texture{pigment{", color);
    out +=
        "} finish{ambient 0 emission 1 diffuse 0 specular 0 roughness 1 metallic 0 "
        "reflection{rgb 0}}}";
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
