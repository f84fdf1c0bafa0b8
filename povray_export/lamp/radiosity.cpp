// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/radiosity.h"

#include "povray_export/scene/povray_number.h"

namespace lodestone::povray {

std::string radiosity_text(const Shading& shading, bool sky) {
    // Before the picture it is gathered on a grid of this share of its width, then ever finer ones.
    constexpr double kFirstGrid = 0.08;
    constexpr double kLastGrid = 0.02;
    constexpr uint64_t kTogether = 15;  // gatherings that are interpolated; more are smoother
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
