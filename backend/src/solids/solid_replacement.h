// SPDX-License-Identifier: GPL-3.0-or-later
// Solid replacement: a box or ellipsoid with the attributes of its original.
#pragma once

#include "model/attributes.h"
#include "model/primitive.h"

#include <optional>

namespace lodestone::solids {

/// The box with the object's visible area, centroid, and ratios of its variances (so trace(tensor)
/// / VSA differs where the object is not a box, its shape does not). `bound`: the object's, in the
/// frame of the attributes. None where a solid would look wrong: nothing is visible; numbers are
/// not finite; the group is sparse (its area is below a tenth of the box its variances ask for);
/// the box sticks out of the bound by more than a fifth along one of its own axes (things in two
/// heaps). Flat things get a thickness of 1/1000 of the next larger side. source: 4.3.2 with
/// 4.33-4.35, A.13, A.14; differs: A.13's factor is 1/12 (printed 1/6).
std::optional<Primitive> fit_box(const Attributes& attributes, const Bound& bound);

/// The ellipsoid in the same way. source: 4.3.1; differs: half axes are solved for, as ratios of
/// standard deviations are off by up to 9 %.
std::optional<Primitive> fit_ellipsoid(const Attributes& attributes, const Bound& bound);

/// Whether a box shows its outline better than an ellipsoid does: by the fourth moment of the
/// normals (box 1, sphere 0.6).
bool boxlike(const Attributes& attributes);

/// A primitive through which things behind it are seen.
struct ClearSolid {
    Primitive primitive;
    double opacity = 1;  // that of the whole; a ray crosses its surface twice (surface_alpha)
};

/// The clear box of an object that is mostly air (its area is less than 0.55 of the matched
/// solid's): with the object's centroid and variances, unscaled, as opaque as there is visible
/// area. None where a solid serves better or all but a fiftieth would be air. source: 4.3.3, 4.36,
/// 4.37
std::optional<ClearSolid> fit_clear_box(const Attributes& attributes, const Bound& bound);
std::optional<ClearSolid> fit_clear_ellipsoid(const Attributes& attributes, const Bound& bound);

/// Many rays settle a solid. 4,096 rays know the centroid of the reference shapes to 0.32 % of the
/// radius of gyration, 32,768 to 0.07 %; objects that are mostly air need twice as many, all of
/// them.
/// The most rays that settle a solid, in multiples of those it was fitted by.
/// Fitted: by tests/bench/sheets/bench_replace.py on the reference shapes.
inline constexpr uint64_t kRaysOfSolid = 8;
/// The change by the last half of the rays below which they end (VisibleOptions).
/// Fitted: by tests/bench/sheets/bench_replace.py and pictures of samples/street.
inline constexpr double kSettled = 0.0008;
/// The rays that settle a clear solid, in multiples of those it was fitted by.
/// Fitted: by tests/bench/sheets/bench_replace.py on reference shapes that are mostly air.
inline constexpr uint64_t kRaysOfClear = 16;

/// A primitive that was fitted by few rays (`rough`), corrected by more rays (`sure`) of the same
/// object: moved with the centroid, and scaled with the area; or, if it is clear, more or less
/// opaque with the area.
Primitive settled(Primitive primitive, const Attributes& rough, const Attributes& sure);
ClearSolid settled(ClearSolid clear, const Attributes& rough, const Attributes& sure);

/// A clear primitive for any share of air: its opacity may be more than 1, where no shell is dense
/// enough. None where there is no extent to match.
std::optional<ClearSolid> shell_box(const Attributes& attributes);
std::optional<ClearSolid> shell_ellipsoid(const Attributes& attributes);

/// The share that each crossing of a shell must cover so that two of them cover `opacity`.
double surface_alpha(double opacity);

/// The surface area, and the mean square of the surface's points along each axis.
struct ShellMoments {
    double area = 0;
    glm::dvec3 variances{0.0};
};
ShellMoments box_shell(const glm::dvec3& half_size);
ShellMoments ellipsoid_shell(const glm::dvec3& half_size);

}  // namespace lodestone::solids
