// SPDX-License-Identifier: GPL-3.0-or-later
// Scene lights: the lights of a view, each as exact as its pixels can tell, and groups lit by them.
#pragma once

#include "light/light_plan.h"
#include "povray_export/lamp/light_writer.h"
#include "povray_export/lamp/sky_writer.h"
#include "povray_export/scene/shading.h"

#include <map>
#include <string>

namespace lodestone::povray {

/// All lights of a picture: those that stand for the sky's image, and the model's.
std::vector<Light> all_lights(const WrittenSky& sky, const Model& model);
/// The demands on a plan of lamps, or on the light of what they light; `lights` are all of them,
/// and must outlive it.
light::LightDemands light_demands(const WrittenSky& sky, const Shading& shading,
                                  const LightSampling& sampling, double light_error,
                                  std::span<const Light> lights);

/// The lights of one view. All arguments must outlive it; `shading` is filled up. `bound` is around
/// everything, magnified by `times`; `occluders` are not magnified.
class SceneLights {
public:
    SceneLights(const View& view, std::span<const Bound> occluders, const Bound& bound,
                double times, const Shading& shading, const LightSampling& sampling,
                Problems& problems)
        : view_(view),
          occluders_(occluders),
          bound_(bound),
          times_(times),
          shading_(shading),
          sampling_(sampling),
          problems_(problems) {}

    /// Appends a light: without its size where no pixel can tell, or with the rays its penumbra
    /// needs. `rays`: along an edge of its grid, where that is known; else 0.
    void append(std::string& out, Light light, int rays) const;

    /// Declares the lights of a plan, once for each grid that a group samples them with; returns
    /// their names, empty for a light without power.
    std::map<light::GroupLight, std::string> declare(std::string& out,
                                                     const light::LightPlan& plan) const;

private:
    const View& view_;
    std::span<const Bound> occluders_;
    const Bound& bound_;
    double times_;
    const Shading& shading_;
    LightSampling sampling_;
    Problems& problems_;
};

/// The text of all groups with their lights. `objects` has the text of what each group of the plan
/// lights. Suns light all groups. The lights of a single group are written without it.
std::string grouped_text(const light::LightPlan& plan,
                         const std::map<light::GroupLight, std::string>& names,
                         const std::vector<std::string>& objects);

/// How many lamps, and lights that stand for several, have soft shadows anywhere.
uint64_t soft_lamps(const light::LightPlan& plan);

}  // namespace lodestone::povray
