// SPDX-License-Identifier: GPL-3.0-or-later
// Finish: how a surface of the principled model reflects light, in POV-Ray's terms. All such
// fitting is in this file.
#pragma once

#include "model/material.h"
#include "model/representation.h"

#include <string>

namespace lodestone::povray {

/// POV-Ray's finish, as far as it is used. Times the pigment: ambient, diffuse, emission, and what
/// `metallic` and `mirror_metallic` tint.
struct Finish {
    glm::dvec3 ambient{0.0};  // answer to a uniform sky, which is not traced
    double diffuse = 0;       // share of a light's radiance times pi
    double brilliance = 1;    // exponent of the cosine
    double specular = 0;      // albedo of the highlight
    double roughness = 1;     // of the highlight: 1 / exponent of its half-vector's cosine
    double metallic = 0;
    double coat = 0;  // albedo of the second highlight, around the mirror direction
    double coat_exponent = 1;
    double mirror = 0;          // share of light that is mirrored (and traced) when facing,
    double mirror_grazing = 0;  // and when seen at no angle
    double mirror_metallic = 0;
};

/// Numbers of a material in their ranges, whatever was given.
struct SurfaceLook {
    double roughness = 0.5;
    double metallic = 0;
    double specular = 0.5;
    double clearcoat = 0;
    double clearcoat_roughness = 0.03;
};
SurfaceLook look_of(const Material& material);

/// Found by fitting: tests/bench/fit_finish.py. What is smooth mirrors its surroundings (traced);
/// what is rough answers the sky with `ambient`, which does not have the white part: that is
/// white_sky().
Finish finish_of(const SurfaceLook& look);

/// Radiance that a uniform sky of 1 comes back with from what is not metal, whatever the base
/// color: what the rough surface and a rough clear coat reflect.
double white_sky(const SurfaceLook& look);

/// finish{...}, every value written, because POV-Ray's defaults (ambient .1, diffuse .6) would leak
/// in. `light` scales all of it; emission (times the pigment) comes on top.
void append_finish(std::string& out, const Finish& finish, double light,
                   const glm::dvec3& emission);

/// Of a clear surface: it mirrors what Fresnel's equations say, and shows the highlight of that.
void append_glass_finish(std::string& out, const SurfaceLook& look);

/// Shows its pigment as it is.
void append_flat_texture(std::string& out, const glm::dvec3& color);

/// rgb <r,g,b>
void append_rgb(std::string& out, const glm::dvec3& color);

/// Color (linear Rec.709) of a representation in a false-colored picture and in its legend. Meshes
/// run from light gray (LOD 0) through blue and green to yellow (LOD 6 and coarser); boxes are
/// orange and ellipsoids magenta, whatever their LOD number.
glm::dvec3 color_of(Kind kind, uint32_t lod);

}  // namespace lodestone::povray
