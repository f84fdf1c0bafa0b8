// SPDX-License-Identifier: GPL-3.0-or-later
// Replacement: a solid box or ellipsoid with the attributes of what it stands for.
#pragma once

#include "model/attributes.h"
#include "model/primitive.h"

#include <optional>

namespace lodestone::solids {

/// The box with the object's visible area, centroid, and ratios of its variances (so trace(tensor)
/// / VSA differs where the object is not a box, its shape does not). `bound` is the object's, in
/// the frame of the attributes. Nothing where a solid would look wrong: nothing visible, numbers
/// that are not finite; a sparse group (its area below a tenth of the box its variances ask for);
/// a box that sticks out of the bound by more than a fifth along one of its own axes (things in
/// two heaps). Flat things get a thickness of 1/1000 of the next larger side.
/// source: 4.3.2 with 4.33-4.35, A.13, A.14; differs: A.13's factor is 1/12 (printed 1/6).
std::optional<Primitive> fit_box(const Attributes& attributes, const Bound& bound);

/// Likewise an ellipsoid.
/// source: 4.3.1; differs: half axes are solved for, as ratios of standard deviations are off by
/// up to 9 %.
std::optional<Primitive> fit_ellipsoid(const Attributes& attributes, const Bound& bound);

/// Whether a box shows its outline better than an ellipsoid does: by the fourth moment of the
/// normals (box 1, sphere .6).
bool boxlike(const Attributes& attributes);

/// A primitive that shows what is behind it.
struct ClearSolid {
    Primitive primitive;
    double opacity = 1;  // of the whole; its surface is crossed twice (surface_alpha)
};

/// For what is mostly air (less than .55 of the matched solid's area): the box with the object's
/// centroid and variances, unscaled, as opaque as there is visible area. Nothing where a solid
/// serves better or all but a fiftieth would be air.
/// source: 4.3.3, 4.36, 4.37
std::optional<ClearSolid> fit_clear_box(const Attributes& attributes, const Bound& bound);
std::optional<ClearSolid> fit_clear_ellipsoid(const Attributes& attributes, const Bound& bound);

/// Many rays settle a solid: so many times those that it was fitted by, or fewer, when the last
/// half of them changed no more (VisibleOptions). 4,096 rays know the centroid of the reference
/// shapes to .32 % of the radius of gyration, 32,768 to .07 %; what is mostly air needs twice as
/// many, all of them.
inline constexpr uint64_t kRaysOfSolid = 8;
inline constexpr double kSettled = 0.0008;
inline constexpr uint64_t kRaysOfClear = 16;

/// A primitive fitted by few rays (`rough`) as more of them (`sure`) see the same object: moved
/// with the centroid, and scaled with the area; or, if it is clear, more or less opaque with it.
Primitive settled(Primitive primitive, const Attributes& rough, const Attributes& sure);
ClearSolid settled(ClearSolid clear, const Attributes& rough, const Attributes& sure);

/// A clear primitive whatever it covers: opacity may be more than 1, where no shell is dense
/// enough. Nothing where there is no extent to match.
std::optional<ClearSolid> shell_box(const Attributes& attributes);
std::optional<ClearSolid> shell_ellipsoid(const Attributes& attributes);

/// What each crossing of a shell must cover so that two of them cover `opacity`.
double surface_alpha(double opacity);

/// Surface area, and the mean square of the surface's points along each axis.
struct ShellMoments {
    double area = 0;
    glm::dvec3 variances{0.0};
};
ShellMoments box_shell(const glm::dvec3& half_size);
ShellMoments ellipsoid_shell(const glm::dvec3& half_size);

}  // namespace lodestone::solids
