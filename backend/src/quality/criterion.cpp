// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/criterion.h"

#include "model/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::quality {

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

double picture_area(const View& view, double z) {
    const double frame = glm::length(glm::cross(view.camera.right, view.camera.up));
    const double depth = view.camera.orthographic ? 1 : std::max(z, view.camera.near_clip);
    return frame * depth * depth;
}

double threshold_for(const View& view, const Sight& sight, double error, size_t lod,
                     size_t levels) {
    const double refine = sight.total;
    if (std::isinf(refine))
        return refine;
    switch (view.modifiers.criterion) {
        case Criterion::Feature: {
            const double feature = error * sight.stretch * refine;
            return feature * feature / picture_area(view, sight.z);
        }
        case Criterion::Area:
            return lod == 0 ? 0
                            : std::ldexp(sight.share * refine * refine,
                                         -2 * static_cast<int>(levels - 1 - lod));
        case Criterion::Distance:
            return lod == 0 ? std::numeric_limits<double>::infinity()
                            : std::ldexp(sight.z / refine, 1 - static_cast<int>(lod));
        case Criterion::Resolution:
            break;
    }
    return error_on_screen(sight, error) * refine;
}

bool good_otherwise(const View& view, const Sight& sight, double error, size_t lod, size_t levels) {
    const double refine = sight.total;
    if (std::isinf(refine))
        return false;
    const double threshold = view.pixel_error;
    switch (view.modifiers.criterion) {
        case Criterion::Feature: {
            const double feature = error * sight.stretch * refine;
            return feature * feature <= threshold * picture_area(view, sight.z);
        }
        case Criterion::Area: {
            const double serves = std::ldexp(threshold, 2 * static_cast<int>(levels - 1 - lod));
            return lod > 0 && sight.share * refine * refine <= serves;
        }
        case Criterion::Distance: {
            const double serves = std::ldexp(threshold, static_cast<int>(lod) - 1);
            return lod > 0 && sight.z >= serves * refine;
        }
        case Criterion::Resolution:
            break;
    }
    return false;
}

}  // namespace lodestone::quality
