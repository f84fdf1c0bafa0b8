// SPDX-License-Identifier: GPL-3.0-or-later
// Texture writer: a material as the text of a POV-Ray texture.
#pragma once

#include "base/maths.h"
#include "light/light_around.h"
#include "model/material.h"
#include "povray_export/texture/picture_writer.h"

#include <glm/vec4.hpp>

#include <optional>
#include <string>

namespace lodestone::povray {

/// The facts about a surface that its texture's text depends on.
struct TexturedSurface {
    bool uvs = false;  // without texture coordinates every texture is its mean
    UvRange range;
    PicturePtr mask;          // the picture whose alpha says where it is, or where it was cut out
    glm::dvec4 color{1.0};    // color of its vertices, linear; counts where the material uses it
    double sky = 1;           // share of a uniform sky's light that reaches it
    glm::dvec3 sky_hue{1.0};  // factors on that light
    glm::dvec3 around{0.0};   // radiance of lit surfaces around that reaches it
    bool layered = true;      // false: gloss is not a layer, but in the color of what is no picture
    bool flat = false;        // true: in one plane with to_uv; only there bumps are shown
    Affine to_uv;             // position to (u, v, height above the plane), where flat

    /// Sets how much of the sky's light reaches it, where that is known (else all of it), and of the
    /// surfaces around: what is not the sky is around.
    void light(std::optional<double> sky_share, const light::LightAround& surfaces) {
        sky = sky_share.value_or(1);
        around = surfaces.radiance * (sky_share ? 1 - *sky_share : surfaces.part);
    }
};

/// The text texture{...}. Shares (alpha, mixtures, maps of roughness and metallic) are weighted
/// averages of whole textures, which is what they mean; base color, emission and the white
/// reflection of the sky are averaged at two or three times their strength where one pigment cannot
/// be all of them. Values out of range are clamped, so that any material gives text that POV-Ray
/// reads.
std::string texture_text(const Material& material, const TexturedSurface& surface,
                         PictureWriter& pictures);

/// Whether the material shows more on a flat surface, because it has bumps.
bool bumpy(const Material& material);

/// Whether the surface mirrors somewhere: by what its pictures may make of it, if `uvs` (pictures
/// are shown), or by what it is mixed with.
bool may_mirror(const Material& material, bool uvs);

/// Whether rays go on at the surface, mirrored or through it. POV-Ray follows such a ray for each of
/// the textures of a triangle's corners. `uvs`: pictures are shown.
bool rays_go_on(const Material& material, bool uvs);

/// How rays go on at surfaces.
struct OnwardRays {
    double mirrored = 0;     // the largest share of light from all sides that any of it mirrors
    bool clear = false;      // rays go on straight through some of it
    bool refracted = false;  // some of it is glass
};

/// Adds how rays go on at a material whose pictures are shown.
void add_onward(const Material& material, OnwardRays& rays);

/// The index of refraction of a material that light goes through; 0 for all others.
double refraction_of(const Material& material);

}  // namespace lodestone::povray
