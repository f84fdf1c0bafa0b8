// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/criterion.h"

#include "model/placement.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace lodestone::choose {

double pixel_at_1m(const View& view) {
    return std::max(glm::length(view.camera.right) / std::max(1, view.width),
                    glm::length(view.camera.up) / std::max(1, view.height));
}

double pixel_size(const View& view, double z) {
    const double frame = pixel_at_1m(view);
    return view.camera.orthographic ? frame : frame * std::max(z, view.camera.near_clip);
}

double error_on_screen(const View& view, double error, double stretch, double z) {
    const double pixel = pixel_size(view, z);
    return pixel > 0 ? error * stretch / pixel : 0;
}

double total_refinement(double factors) {
    if (std::isinf(factors))
        return factors;
    return std::clamp(factors, 1 / kMostImportance, kMostImportance);
}

bool good_enough(const View& view, double error, double stretch, double z, double refine) {
    if (std::isinf(refine))
        return false;
    return error * stretch * refine <= view.pixel_error * pixel_size(view, z);
}

namespace {

/// The result of least_threshold(), but for rounding.
double near_threshold(const View& view, const OccurrenceSight& sight, double error, size_t lod,
                      size_t levels) {
    if (view.modifiers.criterion == DetailCriterion::Feature) {
        const double feature = error * sight.stretch * sight.total;
        return feature * feature / picture_area(view, sight.z);
    }
    if (view.modifiers.criterion == DetailCriterion::Area)
        return std::ldexp(sight.share * sight.total * sight.total,
                          -2 * static_cast<int>(levels - 1 - lod));
    return error_on_screen(sight, error) * sight.total;
}

}  // namespace

double picture_area(const View& view, double z) {
    const double frame = glm::length(glm::cross(view.camera.right, view.camera.up));
    const double depth = view.camera.orthographic ? 1 : std::max(z, view.camera.near_clip);
    return frame * depth * depth;
}

double least_threshold(View& view, const OccurrenceSight& sight, double error, size_t lod,
                       size_t levels) {
    // Numbers from 0 on are in the order of their bits.
    const auto good = [&](uint64_t threshold) {
        view.pixel_error = std::bit_cast<double>(threshold);
        return good_enough(view, sight, error, lod, levels);
    };
    uint64_t fails = 0;
    uint64_t works = std::bit_cast<uint64_t>(std::numeric_limits<double>::max());
    if (!good(works))
        return std::numeric_limits<double>::infinity();
    if (good(fails))
        return 0;
    const auto narrow = [&](uint64_t threshold) {
        if (threshold > fails && threshold < works)
            (good(threshold) ? works : fails) = threshold;
    };
    const double guess = near_threshold(view, sight, error, lod, levels);
    if (guess > 0) {  // the guess is a number and, but for rounding, the result
        const auto near = std::bit_cast<uint64_t>(guess);
        narrow(near);
        narrow(near - 1);
        narrow(near + 1);
    }
    while (works - fails > 1)
        narrow(fails + (works - fails) / 2);
    return std::bit_cast<double>(works);
}

bool good_otherwise(const View& view, const OccurrenceSight& sight, double error, size_t lod,
                    size_t levels) {
    const double refine = sight.total;
    if (std::isinf(refine))
        return false;
    const double threshold = view.pixel_error;
    switch (view.modifiers.criterion) {
        case DetailCriterion::Feature: {
            const double feature = error * sight.stretch * refine;
            return feature * feature <= threshold * picture_area(view, sight.z);
        }
        case DetailCriterion::Area: {
            const double serves = std::ldexp(threshold, 2 * static_cast<int>(levels - 1 - lod));
            return lod > 0 && sight.share * refine * refine <= serves;
        }
        case DetailCriterion::Distance: {
            const double serves = std::ldexp(threshold, static_cast<int>(lod) - 1);
            return lod > 0 && sight.z >= serves * refine;
        }
        case DetailCriterion::Resolution:
            break;
    }
    return false;
}

}  // namespace lodestone::choose
