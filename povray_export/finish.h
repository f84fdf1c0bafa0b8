// SPDX-License-Identifier: GPL-3.0-or-later
// Finish: a material of the principled model in POV-Ray's terms. All such fitting is in this file.
#pragma once

#include "model/material.h"
#include "model/representation.h"

#include <string>

namespace lodestone::povray {

/// texture{pigment{...} finish{...}}, every value written, because POV-Ray's defaults (ambient .1,
/// diffuse .6) would leak in. With a = base color, m = metallic, F = reflectance of a smooth face:
///   sun S on a facing surface   (1 - m) a S / pi   (lights are written as S / pi, so diffuse = 1 - m)
///   uniform sky of radiance L   a L                (ambient 1, ambient_light = L; what is mirrored
///                                                   is traced instead)
///   highlight                   F times the normalized Blinn-Phong lobe as wide as the material's
///                               microfacets: exponent 2 / roughness^4 - 2
/// Metals tint their highlight; only smooth ones (metallic > .5, roughness < .3) trace reflections.
/// Diffuse gives way where it would send back more light than arrives. Values out of range are
/// clamped, so that any material gives text that POV-Ray reads.
void append_texture(std::string& out, const Material& material);

/// Unlit and flat: what the picture shows is `color` (linear).
void append_flat_texture(std::string& out, const glm::dvec3& color);

/// Color (linear Rec.709) of a representation in a false-colored picture and in its legend. Meshes
/// run from light gray (LOD 0) through blue and green to yellow (LOD 6 and coarser); boxes are
/// orange and ellipsoids magenta, whatever their LOD number.
glm::dvec3 color_of(Kind kind, uint32_t lod);

}  // namespace lodestone::povray
