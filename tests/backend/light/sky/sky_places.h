// SPDX-License-Identifier: GPL-3.0-or-later
// Things that hide the sky, ready for rays, shared by the tests of what surfaces see of it.
#pragma once

#include "light/sky/sky_visibility.h"
#include "povray/povray_scenes.h"
#include "scenes/with_rays.h"

namespace lodestone::light {

class SkyPlaces : public WithRays {
protected:
    const Representation& finest(ObjectIndex object) const {
        return builder.model.objects[object].representations[0];
    }

    struct SkyPlace {
        SkyPlace(SkyPlaces& test, const std::vector<std::pair<ObjectIndex, Affine>>& things)
            : surfaces(test.builder.model) {
            std::vector<const Representation*> all;
            for (const auto& [object, world] : things) {
                occluders.push_back({&test.finest(object), world});
                all.push_back(&test.finest(object));
            }
            surfaces.add(all, {});
            scene.emplace(test.builder.model, surfaces, occluders, Job{});
        }
        SkySurfaces surfaces;
        std::vector<SkyOccluder> occluders;
        std::optional<SkyScene> scene;
    };

    povray::scenes::Builder builder;
};

}  // namespace lodestone::light
