// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/scene_lights.h"

#include "light/penumbra.h"
#include "povray_export/scene/magnification.h"
#include "povray_export/scene/povray_number.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace lodestone::povray {

std::vector<Light> all_lights(const WrittenSky& sky, const Model& model) {
    std::vector<Light> out = sky.lights;
    out.insert(out.end(), model.lights.begin(), model.lights.end());
    return out;
}

light::LightDemands light_demands(const WrittenSky& sky, const Shading& shading,
                                  const LightSampling& sampling, double light_error,
                                  std::span<const Light> lights) {
    light::LightDemands demands;
    demands.grids.pixel_error = light_error;
    demands.grids.shadow_error = shading.shadow_error;
    demands.grids.rays = sampling.rays;
    demands.bounces = shading.bounces;
    // Where light is gathered, walls shadow a sky.
    if (shading.bounces == 0)
        demands.sky = sky.ambient;
    demands.sky_shaded = shading.sky_rays > 0;
    demands.suns = lights;
    return demands;
}

void SceneLights::append(std::string& out, Light light, int rays) const {
    // The factor on an area's edges, which still say where it shines.
    // Taste: any size that no pixel can tell will do.
    constexpr double kPoint = 1e-7;
    LightSampling sampling = sampling_;
    if (rays > 0) {
        sampling.grid = light::LampGrid{rays, false};
        append_light(out, magnified(light, times_), bound_, sampling, problems_);
        return;
    }
    const double widest = light::widest_penumbra(light, view_, occluders_);
    const double step = std::max(light::kLeastPenumbra, shading_.shadow_error);
    if (widest <= step) {
        light.angle = light.radius = 0;
        light.edge_u *= kPoint;
        light.edge_v *= kPoint;
    }
    if (shading_.shadow_error > 0)  // else every light is as it is
        sampling.steps = widest / step;
    append_light(out, magnified(light, times_), bound_, sampling, problems_);
}

std::map<light::GroupLight, std::string> SceneLights::declare(std::string& out,
                                                              const light::LightPlan& plan) const {
    std::map<light::GroupLight, std::string> names;
    std::vector<uint8_t> told(plan.lights.size(), 0);
    for (const std::vector<light::GroupLight>& group : plan.groups) {
        for (const light::GroupLight& one : group) {
            const auto [at, fresh] = names.try_emplace(one);
            if (!fresh)
                continue;
            LightSampling sampling = sampling_;
            sampling.grid = one.grid;
            Problems again;  // what is wrong with a light is told once
            std::string light;
            append_light(light, magnified(plan.lights[one.light], times_), bound_, sampling,
                         told[one.light]++ == 0 ? problems_ : again);
            if (light.empty())
                continue;
            at->second = "LDS_L_";
            append_count(at->second, names.size());
            out += "#declare " + at->second + " = " + light;
        }
    }
    return names;
}

std::string grouped_text(const light::LightPlan& plan,
                         const std::map<light::GroupLight, std::string>& names,
                         const std::vector<std::string>& objects) {
    std::string out;
    for (size_t i = 0; i < objects.size(); ++i) {
        std::string own;
        for (const light::GroupLight& one : plan.groups[i]) {
            const std::string& name = names.at(one);
            if (!name.empty())
                own += "light_source{" + name + "}\n";
        }
        if (objects.size() == 1)
            return own + objects[i];
        if (objects[i].empty())
            continue;
        out +=
            own.empty() ? objects[i] : "light_group{\n" + own + objects[i] + "global_lights on}\n";
    }
    return out;
}

uint64_t soft_lamps(const light::LightPlan& plan) {
    std::set<uint32_t> soft;
    for (const std::vector<light::GroupLight>& group : plan.groups) {
        for (const light::GroupLight& one : group) {
            if (one.grid.rays > 1)
                soft.insert(one.light);
        }
    }
    return soft.size();
}

}  // namespace lodestone::povray
