// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene/scene_head.h"

#include "povray_export/lamp/radiosity.h"
#include "povray_export/scene/povray_number.h"

#include <algorithm>

namespace lodestone::povray {
namespace {

/// Law: 8 bits.
constexpr double kDisplaySteps = 255;

/// The surfaces one behind the other that show: what one more mirrors is less than what is left out
/// anyway. POV-Ray follows a mirrored ray however little it is worth.
uint64_t shown_depth(const OnwardRays& onward, const Shading& shading) {
    const auto most = static_cast<uint64_t>(shading.trace_depth);
    if (onward.refracted)
        return 2 * most;  // two surfaces of a glass are two levels
    if (shading.bounces > 0)
        return most;
    const double least = std::max(shading.reflection_error, 1.0) / kDisplaySteps;
    uint64_t depth = 1;
    for (double share = onward.mirrored; share >= least && depth < most; share *= onward.mirrored)
        ++depth;
    // A ray that goes on straight is on the level of the one that it goes on from, but POV-Ray
    // follows none from the last.
    return std::min(most, depth + (onward.clear ? 1 : 0));
}

}  // namespace

std::string head_text(const SceneHead& head, const Shading& shading, const WrittenSky& sky) {
    const bool indirect = shading.bounces > 0;
    std::string out = "// Lodestone " LODESTONE_VERSION ": a fixed cut at Pixel Error ";
    append_number(out, head.pixel_error, 6);
    out += "\n// ";
    append_count(out, head.occurrences);
    out +=
        " occurrences; render it from this folder with: povray scene.ini\n"
        "#version 3.7;\n\n";
    if (head.times > 1) {
        out += "// All is ";
        append_count(out, static_cast<uint64_t>(head.times));
        out += " times as large: POV-Ray takes what is nearer than .001 for one point.\n";
    }
    if (!indirect) {
        out +=
            "// A sky of radiance L on all sides lights a surface of albedo a to a L: POV-Ray's "
            "ambient\n// with ambient_light = L. The share that it sees of the sky is in its "
            "ambient.\n";
    }
    out += "global_settings{assumed_gamma 1 max_trace_level ";
    append_count(out, shown_depth(head.onward, shading));
    if (shading.reflection_error > 1) {
        out += " adc_bailout ";
        append_number(out, shading.reflection_error / kDisplaySteps, 6);
    }
    if (indirect) {
        const bool lit = sky.ambient != glm::dvec3(0.0);
        out += "\n    " + radiosity_text(shading, lit) + "}\n";
    } else {
        out += " ambient_light rgb ";
        append_vector(out, sky.ambient, 6);
        out += "}\n";
    }
    // Surfaces gather of an environment the light that its lights leave over; its picture stands
    // before that, for all other rays.
    const bool pictured = !sky.pigment.empty();
    const glm::dvec3 background = pictured && !indirect ? glm::dvec3(0.0) : sky.ambient;
    out += head.transparent ? "background{rgbt <" : "background{rgb <";
    for (int i = 0; i < 3; ++i) {
        append_number(out, background[i], 6);
        out += i < 2 ? "," : (head.transparent ? ",1>}\n\n" : ">}\n\n");
    }
    if (!head.transparent && pictured)
        out += indirect ? sky_ball(sky, head.eye) : sky_sphere(sky);
    return out;
}

}  // namespace lodestone::povray
