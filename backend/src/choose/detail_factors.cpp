// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/detail_factors.h"

#include "base/color.h"
#include "base/error.h"
#include "base/maths.h"
#include "choose/criterion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace lodestone::choose {
namespace {

// The largest depth exaggeration.
// Taste: a larger one coarsens more behind the focus than an artist could mean.
constexpr double kSteepest = 8;
// The displayed value from which on nothing is coarser for darkness.
// Taste: a larger one coarsens middle tones, too.
constexpr double kMiddleShown = 0.5;
// The displayed value below which nothing becomes coarser any more.
// Taste: a smaller one coarsens more in black; so the factor is at most 64, as all factors.
constexpr double kLeastShown = 1.0 / 128;

void refuse_nonsense(const QualityModifiers& modifiers) {
    if (!(modifiers.depth >= 0 && modifiers.depth <= kSteepest))
        fail(Status::InvalidArgument, "depth exaggeration is ", modifiers.depth, "; 0 to ",
             kSteepest, " expected");
    if (modifiers.depth != 1 &&
        !(modifiers.depth_focus > 0 && std::isfinite(modifiers.depth_focus)))
        fail(Status::InvalidArgument, "depth exaggeration is about a distance of ",
             modifiers.depth_focus, " m; more than 0 expected");
    if (modifiers.screen_lenses.size() > kMostLenses)
        fail(Status::InvalidArgument, modifiers.screen_lenses.size(), " screen lenses; at most ",
             kMostLenses);
    for (const ScreenLens& lens : modifiers.screen_lenses) {
        if (!std::isfinite(lens.center.x) || !std::isfinite(lens.center.y))
            fail(Status::InvalidArgument, "the center of screen lens '", lens.name,
                 "' is not finite");
        if (!std::isfinite(lens.radius) || lens.radius < 0)
            fail(Status::InvalidArgument, "screen lens '", lens.name, "' has a radius of ",
                 lens.radius, "; 0 or more expected");
        if (!std::isfinite(lens.strength) || !(lens.strength > 0))
            fail(Status::InvalidArgument, "screen lens '", lens.name, "' has a strength of ",
                 lens.strength, "; more than 0 expected");
        if (!std::isfinite(lens.falloff) || lens.falloff < 0)
            fail(Status::InvalidArgument, "screen lens '", lens.name, "' has a fall-off of ",
                 lens.falloff, "; 0 or more expected");
    }
}

bool glows(const Model& model, const Representation& representation) {
    return std::any_of(representation.materials.begin(), representation.materials.end(),
                       [&](uint32_t index) {
                           const Material* material = &model.materials.at(index);
                           for (int depth = 0; material != nullptr && depth < 64; ++depth) {
                               if (largest(material->emission) > 0)
                                   return true;
                               material = material->other.get();
                           }
                           return false;
                       });
}

/// Whether nothing but lenses makes anything finer or coarser.
bool only_lenses(const QualityModifiers& modifiers) {
    // A new modifier breaks this line, so that its author decides here: FactorField::at is called
    // only for what this function knows. Criteria and classes of rays are no factors.
    const auto& [criterion, lenses, screen_lenses, depth, focus, when_moving, closing, when_dark,
                 off_screen, ray_classes] = modifiers;
    return screen_lenses.empty() && depth == 1 && !when_moving && !when_dark &&
           off_screen == OffScreen::Full;
}

/// The brightest radiance that a white surface at this place may send back of this light's. source:
/// Blender's energy units: a sun's strength in W/m^2, a lamp's power in W
double lit(const Light& light, const Bound& bound) {
    const double power = std::max(0.0, light.power) * largest(light.color);
    if (light.kind == LightKind::Sun)
        return power / kPi;
    double reach = light.radius;
    // A Lambert area sends, along its axis, four times the mean of a sphere.
    double concentrated = 1;
    if (light.kind == LightKind::Area) {
        reach = 0.5 * (glm::length(light.edge_u) + glm::length(light.edge_v));
        concentrated = 4;
    }
    const double away = std::max({distance(bound, light.position) - reach, 0.5 * reach, 1e-3});
    return concentrated * power / (4 * kPi * kPi * away * away);
}

}  // namespace

double DetailFactors::total() const {
    // A new factor breaks this line, so that its author decides here whether it refines or coarsens.
    const auto& [importance_, demand_, lenses_, screen_lenses_, depth_, motion_, darkness_,
                 off_screen_] = *this;
    const double refine = importance_ * demand_ * lenses_ * screen_lenses_;
    if (std::isinf(refine))
        return refine;
    return total_refinement(refine / (depth_ * motion_ * darkness_ * off_screen_));
}

double coarser_by_motion(double pixels) {
    return std::min(kMostImportance, std::sqrt(1 + pixels * pixels));
}

double coarser_by_darkness(double shown) {
    return std::max(1.0, kMiddleShown / std::max(shown, kLeastShown));
}

FactorField::FactorField(const Model& model, const View& view, bool in_any_order)
    : model_(model),
      view_(view),
      lenses_(model, view.modifiers.lenses, in_any_order),
      frame_(view.camera, view.width, view.height) {
    const QualityModifiers& modifiers = view.modifiers;
    refuse_nonsense(modifiers);
    lenses_alone_ = only_lenses(modifiers);
    bends_ = !lenses_.empty() || !lenses_alone_;
    pixel_ = pixel_at_1m(view);
    if (modifiers.off_screen != OffScreen::Full)
        off_screen_.emplace(model, view);
    if (modifiers.when_moving) {
        if (modifiers.closing)
            closing_.emplace(*modifiers.closing, view.width, view.height);
        moves_below_.resize(model.objects.size(), 0);
        for (const ObjectIndex index : bottom_up(model)) {
            if (!model.objects[index].group())
                continue;
            for (const Placement& placement :
                 model.objects[index].representations[0].assembly().placements) {
                if (placement.closing || moves_below_[placement.object] != 0)
                    moves_below_[index] = 1;
            }
        }
    }
    if (modifiers.when_dark) {
        // The background behind a transparent film may be bright, and so may a picture of the sky.
        const World& world = model.world;
        background_ =
            world.transparent || world.environment ? 1 : encode_srgb(largest(world.color));
        glows_.resize(model.objects.size(), 0);
        for (const ObjectIndex index : bottom_up(model)) {
            const Object& object = model.objects[index];
            for (const Representation& representation : object.representations) {
                if (glows(model, representation))
                    glows_[index] = 1;
            }
            if (!object.group())
                continue;
            for (const Placement& placement : object.representations[0].assembly().placements)
                glows_[index] |= glows_[placement.object];
        }
    }
}

FactorField::FactorPath FactorField::root() {
    return {lenses_.root(), Affine{}, false};
}

FactorField::FactorPath FactorField::below(const FactorPath& group, const Affine& world,
                                           const Placement& placement) const {
    // A new fact breaks this line, so that its author adds its condition to follows_paths().
    [[maybe_unused]] const auto& [lenses, closing, moving] = group;
    FactorPath path = group;
    if (moves_below_.empty())
        return path;
    if (placement.closing) {
        path.closing = (group.moving ? group.closing : world) * *placement.closing;
        path.moving = true;
    } else if (group.moving) {
        path.closing = group.closing * placement.transform;
    }
    return path;
}

FactorField::FactorEffect FactorField::at(ObjectIndex object, bool group, const Bound& local,
                                          const Affine& world, const Bound& bound, double z,
                                          FactorPath& path) {
    FactorEffect effect;
    if (!lenses_.empty()) {
        const LensField::LensEffect lens = lenses_.at(object, group, bound, path.lenses);
        effect.factors.lenses = lens.refine;
        effect.open = lens.open;
        effect.gone = lens.gone;
        path.lenses = lens.below;
    }
    const QualityModifiers& modifiers = view_.modifiers;
    if (!modifiers.screen_lenses.empty())
        effect.factors.screen_lenses = screen_lenses(bound);
    if (modifiers.depth != 1)
        effect.factors.depth = std::pow(std::max(z, view_.camera.near_clip) / modifiers.depth_focus,
                                        modifiers.depth - 1);
    if (modifiers.when_moving)
        effect.factors.motion = motion(object, local, world, path);
    if (modifiers.when_dark)
        effect.factors.darkness = darkness(object, bound);
    if (off_screen_)
        effect.factors.off_screen =
            off_screen_->coarser(transformed(model_.objects[object].reach(), world), z);
    return effect;
}

double FactorField::screen_lenses(const Bound& bound) const {
    const ImageRect rect = frame_.rect(bound);
    if (rect.behind)
        return 1;
    double refine = 1;
    for (const ScreenLens& lens : view_.modifiers.screen_lenses) {
        const double d = lens.strength < 1 ? rect.farthest(lens.center) : rect.nearest(lens.center);
        refine *= lens_profile(lens.strength, lens.radius, lens.falloff, d);
    }
    return refine;
}

/// The factor of motion, by the least motion of the bound's center and of the middles of its box's
/// sides.
double FactorField::motion(ObjectIndex object, const Bound& local, const Affine& world,
                           const FactorPath& path) const {
    if (!closing_ && !path.moving)
        return 1;
    if (moves_below_[object] != 0 || local.empty())  // each of its parts moves in its own way
        return 1;
    const Affine& later = path.moving ? path.closing : world;
    const ImageFrame& frame = closing_ ? *closing_ : frame_;
    double least = kInfinity;
    for (int side = 0; side < 7; ++side) {
        glm::dvec3 at = local.box.center();
        if (side > 0)
            at[(side - 1) / 2] =
                side % 2 == 0 ? local.box.low[(side - 1) / 2] : local.box.high[(side - 1) / 2];
        bool front = false;
        bool front_later = false;
        const glm::dvec2 from = frame_.point(world(at), front);
        const glm::dvec2 to = frame.point(later(at), front_later);
        if (!front || !front_later)
            return 1;
        least = std::min(least, glm::length(to - from));
    }
    return std::isfinite(least) ? coarser_by_motion(least) : 1;
}

/// The factor of darkness, by the value that a white surface anywhere in the bound would show
/// without any shadow.
double FactorField::darkness(ObjectIndex object, const Bound& bound) const {
    if (glows_[object] != 0 || bound.empty())
        return 1;
    double radiance = largest(model_.world.color);
    for (const Light& light : model_.lights) {
        if (encode_srgb(radiance) >= kMiddleShown)
            break;
        radiance += lit(light, bound);
    }
    return coarser_by_darkness(std::max(encode_srgb(radiance), background_));
}

}  // namespace lodestone::choose
