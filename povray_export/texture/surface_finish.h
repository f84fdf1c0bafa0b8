// SPDX-License-Identifier: GPL-3.0-or-later
// Surface finish: the reflection of light by a surface of the principled model, in POV-Ray's terms.
// All such fitting is in this file.
#pragma once

#include "model/material.h"
#include "model/representation.h"

#include <string>

namespace lodestone::povray {

/// POV-Ray's finish, as far as it is used. The pigment multiplies ambient, diffuse and emission,
/// and tints the reflections that `metallic` and `mirror_metallic` say.
struct Finish {
    glm::dvec3 ambient{0.0};  // answer to a uniform sky, which is not traced
    double around = 0;        // the part of it that rough metal has
    glm::dvec3 glow{0.0};     // what it shows of lit surfaces around, which are not traced
    double diffuse = 0;       // share of a light's radiance times pi
    double brilliance = 1;    // exponent of the cosine
    double specular = 0;      // albedo of the highlight
    double roughness = 1;     // highlight's: 1 / exponent of its half-vector's cosine
    double metallic = 0;
    double coat = 0;  // albedo of the second highlight, around the mirror direction
    double coat_exponent = 1;
    double mirror = 0;          // share of facing light that is mirrored (and traced)
    double mirror_grazing = 0;  // share that is mirrored when seen at no angle
    double mirror_metallic = 0;
};

/// A material whose numbers are finite and in their ranges, without its textures and the other one.
using SurfaceLook = Material;
/// The look of a material, whatever its numbers are.
SurfaceLook look_of(const Material& material);

/// The finish of a look, found by fitting: tests/bench/peers/fit_finish.py. Smooth surfaces mirror their
/// surroundings (traced); rough ones answer the sky with `ambient`, which does not have the white
/// part: that is white_gloss().
Finish finish_of(const SurfaceLook& look);

/// The radiance that surroundings of 1, as a uniform sky, come back with from a surface that is not
/// metal, whatever the base color: the reflection of the rough surface and of a rough clear coat.
double white_gloss(const SurfaceLook& look);

/// The part of the light of lit surfaces around that the matt surface below gloss sends on although no
/// light bounces, in the color of the pigment; `gray`: about how bright that is.
double carried_by_gloss(const SurfaceLook& look, double gray);

/// Appends finish{...}, with every value written, because POV-Ray's defaults (ambient 0.1, diffuse
/// 0.6) would leak in. `light` scales all of it; other emission (times the pigment) comes on top.
void append_finish(std::string& out, const Finish& finish, double light,
                   const glm::dvec3& emission);

/// Appends the finish of a clear surface: it mirrors by Fresnel's equations, and shows that
/// highlight.
void append_glass_finish(std::string& out, const SurfaceLook& look);

/// Appends a texture that shows its pigment as it is.
void append_flat_texture(std::string& out, const glm::dvec3& color);

/// Appends rgb <r,g,b>.
void append_rgb(std::string& out, const glm::dvec3& color);

/// The color (linear Rec.709) of a representation in a false-colored picture and in its legend.
/// Meshes run from light gray (LOD 0) through blue and green to yellow (LOD 6 and coarser); boxes
/// are orange and ellipsoids magenta, whatever their LOD number.
glm::dvec3 color_of(Kind kind, uint32_t lod);

}  // namespace lodestone::povray
