// SPDX-License-Identifier: GPL-3.0-or-later
// DetailCriterion: is a representation good enough from here? (DESIGN 5; dissertation 5.2)
#pragma once

#include "base/maths.h"
#include "model/view.h"

#include <algorithm>
#include <cmath>

namespace lodestone::choose {

/// Size in metres of a pixel of `view` 1 m away; orthographic: anywhere.
double pixel_at_1m(const View& view);

/// Size in metres of a pixel of `view` at distance z (perspective: proportional to z, never nearer
/// than the near clip; orthographic: the same everywhere).
double pixel_size(const View& view, double z);

/// Error on screen in pixels of a representation with `error` metres under a transform that
/// enlarges by `stretch`, its bound z metres from the eye.
double error_on_screen(const View& view, double error, double stretch, double z);

/// All that refines and coarsens together, kept within 1/64 ... 64; infinite stays so.
double total_refinement(double factors);

/// error * stretch * refine <= T * p(z); T = 0 asks for error 0.
bool good_enough(const View& view, double error, double stretch, double z, double refine = 1);

/// How an occurrence is seen: what its levels are judged by.
struct OccurrenceSight {
    double z = 0;        // metres from the eye to its bound
    double pixel = 0;    // pixel_size() there
    double stretch = 1;  // of its transform
    double total = 1;    // total_refinement of all factors
    double share =
        0;  // of the picture, covered by the image of its box; DetailCriterion::Area only
};

/// distance(transformed(bound, world, stretch), eye), to the last bit and sooner, above all where
/// nothing is turned: of all that choosing computes this is the most.
inline double distance_of(const Bound& bound, const Affine& world, double stretch,
                          const glm::dvec3& eye) {
    if (bound.empty() || world.linear != glm::dmat3(1.0))
        return distance(transformed(bound, world, stretch), eye);
    const glm::dvec3 center = bound.center + world.offset;
    const glm::dvec3 outside = glm::max(
        glm::max(bound.box.low + world.offset - eye, eye - (bound.box.high + world.offset)),
        glm::dvec3(0.0));
    return std::max(
        {0.0, glm::length(eye - center) - bound.radius * stretch, glm::length(outside)});
}

/// error_on_screen() of what is seen so.
inline double error_on_screen(const OccurrenceSight& sight, double error) {
    return sight.pixel > 0 ? error * sight.stretch / sight.pixel : 0;
}

/// By another criterion than resolution: see below.
bool good_otherwise(const View& view, const OccurrenceSight& sight, double error, size_t lod,
                    size_t levels);

/// Whether LOD number `lod` of `levels` is good enough by the view's criterion (5.2.2): by
/// resolution as above; else as DetailCriterion says, the threshold divided by the refinement (of areas:
/// by its square).
inline bool good_enough(const View& view, const OccurrenceSight& sight, double error, size_t lod,
                        size_t levels) {
    if (view.modifiers.criterion != DetailCriterion::Resolution)
        return good_otherwise(view, sight, error, lod, levels);
    return !std::isinf(sight.total) &&
           error * sight.stretch * sight.total <= view.pixel_error * sight.pixel;
}

/// The least threshold that this is good enough for, to the last bit as good_enough() finds it;
/// infinite: there is none. Not of DetailCriterion::Distance. The view's own threshold is lost.
double least_threshold(View& view, const OccurrenceSight& sight, double error, size_t lod,
                       size_t levels);

/// Square metres that the whole picture covers at distance z.
double picture_area(const View& view, double z);

}  // namespace lodestone::choose
