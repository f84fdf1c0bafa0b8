// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/light_around.h"

#include "base/color.h"
#include "base/parallel.h"
#include "light/light_arrival.h"

namespace lodestone::light {
namespace {

// The most luminance that one ray tells: where a lamp nearly touches a wall few rays end, which would
// tell anything.
// Law: Cycles' own limit of indirect light (Clamping, Indirect Light).
constexpr double kMostOfRay = 10;

/// The light of lamps that a point sends on: of one by chance, rather a strong one, for all.
glm::dvec3 lamp_light(const LitScene& scene, const std::vector<const Light*>& lamps,
                      const LitPoint& point, PcgRandom& random) {
    std::vector<double> sums;
    sums.reserve(lamps.size());
    double sum = 0;
    for (const Light* lamp : lamps)
        sums.push_back(sum += std::max(0.0, luminance(sent_radiance(*lamp, point))));
    if (!(sum > 0) || !std::isfinite(sum))
        return glm::dvec3(0.0);
    const double chosen = random.uniform() * sum;
    const size_t i = std::min(
        static_cast<size_t>(std::upper_bound(sums.begin(), sums.end(), chosen) - sums.begin()),
        lamps.size() - 1);
    const double share = sums[i] - (i > 0 ? sums[i - 1] : 0);
    if (!(share > 0))
        return glm::dvec3(0.0);
    uint32_t blocker = ray::PlacedScenes::kNothing;
    return sent_radiance(*lamps[i], point) *
           (scene.reaches(*lamps[i], point, blocker) * sum / share);
}

}  // namespace

std::vector<LightAround> light_around(const Model& model, const RendererSurfaces& renderer,
                                      std::span<const DrawnThing> drawn,
                                      std::span<const AroundRequest> requests,
                                      const LightDemands& demands, const Job& job) {
    std::vector<LightAround> out(requests.size());
    if (requests.empty())
        return out;
    const LitScene scene(model, renderer, drawn, job);
    std::vector<const Light*> lamps;
    for (const Light& light : model.lights) {
        if (is_lamp(light))
            lamps.push_back(&light);
    }
    parallel_for(requests.size(), [&](size_t i) {
        job.check();
        const AroundRequest& request = requests[i];
        PcgRandom random(request.drawn);  // in whatever order they are asked for
        std::vector<LitPoint> points = scene.surroundings(request.drawn, request.rays, random);
        scene.add_other_light(demands, points, job);
        for (const LitPoint& point : points) {
            const glm::dvec3 light = point.other_light + lamp_light(scene, lamps, point, random);
            const double over = std::max(1.0, luminance(light) / kMostOfRay);
            if (finite(light))
                out[i].radiance += light / (over * static_cast<double>(points.size()));
        }
        out[i].part = static_cast<double>(points.size()) / std::max(request.rays, 1);
    });
    return out;
}

}  // namespace lodestone::light
