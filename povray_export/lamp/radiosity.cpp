// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/radiosity.h"

#include "povray_export/scene/povray_number.h"

namespace lodestone::povray {

std::string radiosity_text(const Shading& shading, bool sky) {
    // Light is gathered on a grid of this share of the picture's width first, then on ever finer
    // ones.
    // Taste: POV-Ray's own default; a larger value loses small patches of light.
    constexpr double kFirstGrid = 0.08;
    // The last grid before the picture.
    // Taste: a larger value leaves more to the picture, which then depends on the order of threads.
    constexpr double kLastGrid = 0.02;
    // Gatherings that are interpolated.
    // Taste: a larger value is smoother and blurs the light in corners.
    constexpr uint64_t kTogether = 15;
    std::string out = "radiosity{pretrace_start ";
    append_number(out, kFirstGrid, 4);
    out += " pretrace_end ";
    append_number(out, kLastGrid, 4);
    out += " count ";
    append_count(out, static_cast<uint64_t>(shading.bounce_rays));
    out += " nearest_count ";
    append_count(out, kTogether);
    out += " error_bound ";
    append_number(out, shading.bounce_error, 4);
    out += " recursion_limit ";
    append_count(out, static_cast<uint64_t>(shading.bounces) + (sky ? 1 : 0));
    return out +
           " low_error_factor .8 gray_threshold 0 minimum_reuse .02 adc_bailout .005 brightness 1 "
           "normal off media off always_sample off}";
}

}  // namespace lodestone::povray
