// SPDX-License-Identifier: GPL-3.0-or-later
// Sky light: the share of the sky's light that a drawn thing answers to, and the grades of it that
// textures are written for.
#pragma once

#include "base/hash.h"
#include "light/sky/sky_visibility.h"
#include "povray_export/lamp/placement_grades.h"

#include <memory>

namespace lodestone::povray {

/// The grades of a mesh's corners.
/// Taste: a larger value shows finer steps of shade, for a texture of each material and grade.
inline constexpr int kSkyGrades = 32;
/// The share of the sky's light that a grade stands for; grade kSkyGrades - 1 is all of it.
double share_of_grade(uint8_t grade);
uint8_t grade_of_share(double share);

/// The hue of the sky's light, in octaves of red and blue beside luminance, in parts of its color.
using SkyTint = glm::dvec2;
/// The factors of a tint on the parts of a light of `color`, whose luminance they leave.
glm::dvec3 factors_of_tint(const SkyTint& tint, const glm::dvec3& color);

/// The share of the sky's light that one drawn thing answers to.
struct SkyLight {
    std::shared_ptr<const light::SkyShares> shares;  // null: `factor` alone
    double factor = 1;                               // on all shares: what is around the thing
    glm::dvec3 slope{0.0};   // of the factor, by metre of the thing's own frame
    glm::dvec3 middle{0.0};  // own frame: where the factor is that
    glm::dvec3 color{1.0};   // of the sky, beside which tints are; of any brightness
    Hash hash = 0;           // of all of it

    /// The share of a corner of the split mesh, which lies there (own frame).
    double share(size_t triangle, int corner, const glm::vec3& at) const;
    /// The grade of what is the same all over it.
    double even_share() const { return share_of_grade(grade_of_share(factor)); }
    /// The hue of the light there; 0 of the sky's own.
    SkyTint tint(size_t triangle, int corner) const;
};
using SkyLightPtr = std::shared_ptr<const SkyLight>;

/// A factor without digits that would only make other files.
double stepped_factor(double factor);
/// The same of a slope, by metre of a thing that is so large.
glm::dvec3 stepped_slope(const glm::dvec3& slope, double size);
/// The light on a thing by its shares, which a hash stands for, times what is around it; `box`: of
/// its finest level, own frame; `color`: of the sky, which the hash stands for, too.
SkyLightPtr sky_light(Hash shares_hash, std::shared_ptr<const light::SkyShares> shares,
                      const PlacementShade& around, const Box3& box, const glm::dvec3& color);
/// The same light on all of a thing.
SkyLightPtr even_sky_light(double factor);

}  // namespace lodestone::povray
