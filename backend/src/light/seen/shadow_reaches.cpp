// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/seen/shadow_reaches.h"

#include "base/parallel.h"
#include "choose/off_screen.h"

namespace lodestone::light {

ShadowReaches::ShadowReaches(const Model& model, std::span<const DrawnThing> drawn,
                             const View& view, std::span<const ShadowLight> lights, const Job& job)
    : lights_(lights), pyramid_(view), eye_(view.camera.position), of_thing_(drawn.size()) {
    if (model.root < model.objects.size())
        scene_ = model.objects[model.root].bound().box;
    parallel_for(drawn.size(), [&](size_t i) {
        job.check();
        const DrawnThing& thing = drawn[i];
        if ((thing.hidden & kShadowRays) != 0 || !thing.world.finite())
            return;
        const Bound bound = transformed(thing.representation->summary.bound, thing.world);
        for (uint32_t light = 0; light < lights_.size(); ++light) {
            if (seen(light, bound))
                of_thing_[i].push_back(light);
        }
    });
}

bool ShadowReaches::seen(uint32_t light, const Bound& bound) const {
    return choose::shadow_reach(*lights_[light].light, bound, &pyramid_, scene_, eye_).seen;
}

}  // namespace lodestone::light
