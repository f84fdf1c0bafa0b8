// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/scene_sky.h"

namespace lodestone::povray {

SceneSky::SceneSky(const Model& model, const Shading& shading, bool lit,
                   const std::filesystem::path& folder, Problems& problems)
    : model_(model),
      shading_(shading),
      folder_(folder),
      problems_(problems),
      // Gathered light shadows the sky by itself; POV-Ray ignores ambient then.
      by_rays_(lit && shading.bounces == 0 && shading.sky_rays > 0) {
    write(by_rays_);
}

void SceneSky::write(bool found_by_rays) {
    const bool before = written_.written;
    written_ = write_sky(
        model_.world,
        {static_cast<size_t>(shading_.sky_lights), shading_.area_samples > 1, found_by_rays},
        folder_, problems_);
    written_.written = written_.written || before;
}

bool SceneSky::find_light(const choose::Cut& cut, SkyOcclusionOptions options,
                          const PixelField& pixels, const Job& job) {
    if (!by_rays_ || written_.ambient == glm::dvec3(0.0))
        return true;
    options.rays = shading_.sky_rays;
    options.uneven = written_.uneven;
    options.pixels_across = [&pixels](const Bound& bound) {
        return 2 * bound.radius / pixels.at(bound);
    };
    light_.emplace(model_, cut, options, problems_, job);
    if (light_->found() || !written_.uneven)
        return true;
    write(false);  // then lights show where it comes from
    return false;
}

}  // namespace lodestone::povray
