// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/scene_lights.h"

#include "light/penumbra.h"
#include "povray_export/scene/magnification.h"
#include "povray_export/scene/povray_number.h"

#include <algorithm>

namespace lodestone::povray {

void SceneLights::append(std::string& out, Light light) const {
    // The pixels of the narrowest penumbra that shows.
    // Taste: antialiasing shows no less; a larger value draws more shadows sharp.
    constexpr double kLeast = 0.25;
    // The factor on an area's edges, which still say where it shines.
    // Taste: any size that no pixel can tell will do.
    constexpr double kPoint = 1e-7;
    const double widest = light::widest_penumbra(light, view_, occluders_);
    const double step = std::max(kLeast, shading_.shadow_error);
    if (widest <= step) {
        light.angle = light.radius = 0;
        light.edge_u *= kPoint;
        light.edge_v *= kPoint;
    }
    LightSampling sampling = sampling_;
    if (shading_.shadow_error > 0)  // else every light is as it is
        sampling.steps = widest / step;
    append_light(out, magnified(light, times_), bound_, sampling, problems_);
}

std::vector<std::string> SceneLights::declare(std::string& out,
                                              const light::LightPlan& plan) const {
    std::vector<std::string> names(plan.lights.size());
    for (size_t i = 0; i < names.size(); ++i) {
        std::string light;
        append(light, plan.lights[i]);
        if (light.empty())
            continue;
        names[i] = "LDS_L_";
        append_count(names[i], i);
        out += "#declare " + names[i] + " = " + light;
    }
    return names;
}

std::string grouped_text(const light::LightPlan& plan, const std::vector<std::string>& names,
                         const std::vector<std::string>& objects) {
    std::string out;
    for (size_t i = 0; i < objects.size(); ++i) {
        std::string own;
        for (const uint32_t light : plan.groups[i]) {
            if (!names[light].empty())
                own += "light_source{" + names[light] + "}\n";
        }
        if (objects[i].empty())
            continue;
        out +=
            own.empty() ? objects[i] : "light_group{\n" + own + objects[i] + "global_lights on}\n";
    }
    return out;
}

}  // namespace lodestone::povray
