// SPDX-License-Identifier: GPL-3.0-or-later
// Shadow reaches: by which lights the shadow of a drawn thing may lie in the picture at all.
#pragma once

#include "choose/view_pyramid.h"
#include "light/light_plan.h"
#include "light/seen/shadow_lights.h"

#include <span>
#include <vector>

namespace lodestone::light {

/// The lights of each drawn thing by which its shadow may be seen. Const methods may be called from
/// any thread; all arguments must outlive it.
class ShadowReaches {
public:
    /// Throws Error(Cancelled). cost: a test of each thing for each light.
    ShadowReaches(const Model& model, std::span<const DrawnThing> drawn, const View& view,
                  std::span<const ShadowLight> lights, const Job& job);

    /// The numbers of such lights, rising; none of what throws no shadows.
    std::span<const uint32_t> of(size_t drawn) const { return of_thing_[drawn]; }
    /// Whether the shadow of a bound (world frame) by one of the lights may lie in the picture.
    bool seen(uint32_t light, const Bound& bound) const;

private:
    std::span<const ShadowLight> lights_;
    choose::ViewPyramid pyramid_;
    glm::dvec3 eye_;
    Box3 scene_;
    std::vector<std::vector<uint32_t>> of_thing_;
};

}  // namespace lodestone::light
