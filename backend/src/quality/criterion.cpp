// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/criterion.h"

#include "model/placement.h"

#include <algorithm>
#include <cmath>

namespace lodestone::quality {

double pixel_size(const View& view, double z) {
    const double frame = std::max(glm::length(view.camera.right) / std::max(1, view.width),
                                  glm::length(view.camera.up) / std::max(1, view.height));
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

}  // namespace lodestone::quality
