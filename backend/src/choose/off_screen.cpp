// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/off_screen.h"

#include "base/maths.h"
#include "choose/criterion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace lodestone::choose {
namespace {

// Rougher surfaces show no images.
// Taste: povray_export/texture/surface_finish.cpp fades out images before this roughness of metal.
constexpr double kRoughMetal = 0.35;
// Taste: povray_export/texture/surface_finish.cpp fades out images before this roughness of a coat.
constexpr double kRoughCoat = 0.25;
// The reflectance of a dielectric, the mean over the half space.
// Law: Fresnel's equations with an index of refraction of 1.45.
constexpr double kDielectric = 0.085;
// The reflectance of a coat, in parts of a dielectric's.
// Law: Disney's principled model gives a clear coat a quarter of it.
constexpr double kCoat = 0.25;
// How many suns a picture of the sky becomes at least; each has this part of its light.
// Law: drafts light with 12 suns, others with more (light/environment/environment_lights).
constexpr double kSkySuns = 12;
// The pixels from which on a mirror counts fully. The image in a smaller one, such as a door knob,
// is small and so strongly bent that nothing in it is as large as in a flat mirror.
// Taste: a larger number lets things outside the picture be coarser.
constexpr double kWholeMirror = 64.0 * 64.0;

/// How far the surface of a light reaches from its position, in metres.
double extent(const Light& light) {
    return light.kind == LightKind::Area
               ? 0.5 * (glm::length(light.edge_u) + glm::length(light.edge_v))
               : std::max(0.0, light.radius);
}

/// The share of an object, with everything below it, whatever levels are drawn.
struct ImagingShare {
    double share = 0;  // the largest share; 0: the reach is not known
    Bound reach;
};
std::vector<ImagingShare> images_below(const Model& model) {
    std::vector<ImagingShare> images(model.objects.size());
    for (const ObjectIndex index : bottom_up(model)) {
        const Object& object = model.objects[index];
        ImagingShare& here = images[index];
        for (const Representation& representation : object.representations)
            here.share = std::max(here.share, imaged_share(model, representation));
        if (object.group()) {
            for (const Placement& placement : object.representations[0].assembly().placements) {
                const ImagingShare& below = images[placement.object];
                here.share = std::max(here.share, below.share);
                here.reach = merged(here.reach, transformed(below.reach, placement.transform));
            }
        }
        if (here.share > 0)
            here.reach = merged(here.reach, object.reach());
    }
    return images;
}

}  // namespace

double imaged_share(const Material& material) {
    double share = 0;
    const Material* part = &material;
    for (int depth = 0; part != nullptr && depth < 64; ++depth, part = part->other.get()) {
        double own = std::clamp(part->transmission, 0.0, 1.0);
        if (part->roughness < kRoughMetal)
            own = std::max(own, std::clamp(part->metallic, 0.0, 1.0));
        if (part->roughness < kRoughCoat)
            own = std::max(own, kDielectric * std::clamp(2 * part->specular, 0.0, 2.0));
        if (part->clearcoat_roughness < kRoughCoat)
            own = std::max(own, kDielectric * kCoat * std::clamp(part->clearcoat, 0.0, 1.0));
        share = std::max(share, own);
    }
    return share;
}

double imaged_share(const Model& model, const Representation& representation) {
    double most = 0;
    for (const uint32_t index : representation.materials)
        most = std::max(most, imaged_share(model.materials.at(index)));
    return most;
}

double imaged_share(double share, const View& view, const Bound& bound, double away) {
    const double wide = 2 * bound.radius / pixel_size(view, away);
    return share * std::min(1.0, wide * wide / kWholeMirror);
}

bool casts_shadows(const Light& light) {
    return light.shadow && light.power != 0 && std::isfinite(light.power);
}

ShadowReach shadow_reach(const Light& light, const Bound& bound, const ViewPyramid* pyramid,
                         const Box3& scene, const glm::dvec3& eye) {
    ShadowReach reach;
    SweptBall& sweep = reach.sweep;
    sweep = {bound.center, {}, bound.radius, 0};
    if (light.kind == LightKind::Sun) {
        const double length = glm::length(light.direction);
        if (!(length > 0))
            return reach;
        reach.away = kInfinity;
        sweep.direction = light.direction / length;
        sweep.growth = std::tan(0.5 * std::clamp(light.angle, 0.0, 3.0));
    } else {
        const glm::dvec3 ray = bound.center - light.position;
        const double away = glm::length(ray);
        if (!(away > bound.radius + extent(light))) {
            reach.seen = true;
            return reach;
        }
        reach.away = away;
        sweep.direction = ray / away;
        sweep.growth = (bound.radius + extent(light)) / away;
    }
    const SweepInterval seen = pyramid != nullptr ? pyramid->touched_interval(sweep, scene)
                                                  : touched_interval(sweep, scene);
    if (seen.empty())
        return reach;
    reach.seen = true;
    reach.last = seen.last;
    // The least distance from the ball, at its largest, to the eye
    const double along =
        std::clamp(glm::dot(eye - sweep.start, sweep.direction), seen.first, seen.last);
    reach.z = std::max(0.0, glm::length(sweep.start + along * sweep.direction - eye) -
                                (sweep.radius + seen.last * sweep.growth));
    return reach;
}

OffScreenField::OffScreenField(const Model& model, const View& view)
    : view_(view), lights_(model.lights), pyramid_(view) {
    if (model.root >= model.objects.size())
        return;
    scene_ = model.objects[model.root].bound().box;
    most_ = model.world.environment ? std::sqrt(kSkySuns) : kMostImportance;
    if (view.modifiers.off_screen == OffScreen::Reflected)
        find_mirrors(model);
}

void OffScreenField::find_mirrors(const Model& model) {
    struct MirrorCandidate {
        ObjectIndex object = kNoObject;
        Affine world;
        MirrorGroup mirror;
        size_t number = 0;  // the order in which they were found

        bool operator<(const MirrorCandidate& other) const {
            return mirror.share != other.mirror.share ? mirror.share < other.mirror.share
                                                      : number > other.number;
        }
    };
    const std::vector<ImagingShare> images = images_below(model);
    std::priority_queue<MirrorCandidate> parts;
    size_t number = 0;
    const auto add = [&](ObjectIndex index, const Affine& world) {
        if (!(images[index].share > 0))
            return;
        const Bound bound = transformed(images[index].reach, world);
        if (pyramid_.outside(bound))
            return;
        const double away = distance(bound, view_.camera.position);
        const double share = imaged_share(images[index].share, view_, bound, away);
        if (share > kLeastImaged)
            parts.push({index, world, {bound, away, share}, number++});
    };
    add(model.root, Affine{});
    // The group that shows most is split as long as there are few: a group is nearer than its
    // mirrors.
    while (!parts.empty()) {
        const MirrorCandidate part = parts.top();
        parts.pop();
        const Object& object = model.objects[part.object];
        const size_t children =
            object.group() ? object.representations[0].assembly().placements.size() : 0;
        if (children == 0 || mirrors_.size() + parts.size() + children > kMostMirrors) {
            mirrors_.push_back(part.mirror);
            continue;
        }
        for (const Placement& placement : object.representations[0].assembly().placements)
            add(placement.object, part.world * placement.transform);
    }
}

double OffScreenField::shadow_pixel(const Light& light, const Bound& bound) const {
    const ShadowReach reach = shadow_reach(light, bound, &pyramid_, scene_, view_.camera.position);
    if (!reach.seen)
        return kInfinity;
    if (reach.away == 0)
        return 0;  // everything around it may be in its shadow
    return pixel_size(view_, reach.z) / (1 + reach.last / reach.away);
}

double OffScreenField::coarser(const Bound& bound, double z) const {
    if (!pyramid_.outside(bound))
        return 1;
    const double here = pixel_size(view_, z);
    double least = here * most_;
    for (const MirrorGroup& mirror : mirrors_) {
        const double gap =
            glm::length(bound.center - mirror.bound.center) - bound.radius - mirror.bound.radius;
        const double way = std::max(z, mirror.away + std::max(0.0, gap));
        least = std::min(least, pixel_size(view_, way) / std::sqrt(mirror.share));
    }
    for (const Light& light : lights_) {
        if (least <= here)
            return 1;
        if (casts_shadows(light))
            least = std::min(least, shadow_pixel(light, bound));
    }
    return std::max(1.0, least / here);
}

bool OffScreenField::only_shadows(const Bound& bound) const {
    return mirrors_.empty() && pyramid_.outside(bound);
}

}  // namespace lodestone::choose
