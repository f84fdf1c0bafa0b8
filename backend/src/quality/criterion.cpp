// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/criterion.h"

#include <algorithm>

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

bool good_enough(const View& view, double error, double stretch, double z) {
    return error * stretch <= view.pixel_error * pixel_size(view, z);
}

}  // namespace lodestone::quality
