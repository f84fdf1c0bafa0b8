// SPDX-License-Identifier: GPL-3.0-or-later
// Detail criterion: whether a representation is good enough from here (dissertation 5.2).
#pragma once

#include "base/maths.h"
#include "model/view.h"

#include <algorithm>
#include <cmath>

namespace lodestone::choose {

/// The size in metres of a pixel of `view` at a distance of 1 m; if orthographic: at any distance.
double pixel_at_1m(const View& view);

/// The size in metres of a pixel of `view` at distance z. Perspective: proportional to z, but never
/// that of a distance below the near clip. Orthographic: the same everywhere.
double pixel_size(const View& view, double z);

/// The error on screen, in pixels, of a representation with `error` metres under a transform that
/// enlarges by `stretch`, where its bound is z metres from the eye.
double error_on_screen(const View& view, double error, double stretch, double z);

/// The product of all that refines and coarsens, kept within 1/64 ... 64; infinity stays infinite.
double total_refinement(double factors);

/// Whether error * stretch * refine <= T * p(z); T = 0 asks for error 0.
bool good_enough(const View& view, double error, double stretch, double z, double refine = 1);

/// How an occurrence is seen; its levels are judged by these numbers.
struct OccurrenceSight {
    double z = 0;        // metres from the eye to its bound
    double pixel = 0;    // pixel_size() at z
    double stretch = 1;  // that of its transform
    double total = 1;    // total_refinement() of all factors
    /// The share of the picture that the image of its box covers; for DetailCriterion::Area only.
    double share = 0;
};

/// The value of distance(transformed(bound, world, stretch), eye), to the last bit but faster,
/// above all where nothing is turned. Choosing computes nothing more often than this.
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

/// The error on screen, in pixels, of a level with `error` metres that is seen so.
inline double error_on_screen(const OccurrenceSight& sight, double error) {
    return sight.pixel > 0 ? error * sight.stretch / sight.pixel : 0;
}

/// The same decision by a criterion other than resolution: see good_enough() below.
bool good_otherwise(const View& view, const OccurrenceSight& sight, double error, size_t lod,
                    size_t levels);

/// Whether LOD number `lod` of `levels` is good enough by the view's criterion (5.2.2). By
/// resolution it is as above. By another one it is as DetailCriterion says, with the threshold
/// divided by the refinement (for areas: by its square).
inline bool good_enough(const View& view, const OccurrenceSight& sight, double error, size_t lod,
                        size_t levels) {
    if (view.modifiers.criterion != DetailCriterion::Resolution)
        return good_otherwise(view, sight, error, lod, levels);
    return !std::isinf(sight.total) &&
           error * sight.stretch * sight.total <= view.pixel_error * sight.pixel;
}

/// The least threshold that the level is good enough for, to the last bit as good_enough() finds
/// it; infinite: no threshold. Not for DetailCriterion::Distance. Changes the threshold of `view`.
double least_threshold(View& view, const OccurrenceSight& sight, double error, size_t lod,
                       size_t levels);

/// The area in square metres that the whole picture covers at distance z.
double picture_area(const View& view, double z);

}  // namespace lodestone::choose
