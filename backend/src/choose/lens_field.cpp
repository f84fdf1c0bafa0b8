// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/lens_field.h"

#include "base/error.h"
#include "base/maths.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone::choose {
namespace {

void refuse_nonsense(const DetailLens& lens) {
    const auto number = [&](double value, const char* what, bool zero) {
        if (!std::isfinite(value) || value < 0 || (value == 0 && !zero))
            fail(Status::InvalidArgument, "lens '", lens.name, "' has a ", what, " of ", value,
                 zero ? "; 0 or more expected" : "; more than 0 expected");
    };
    number(lens.radius, "radius", true);
    number(lens.strength, "strength", false);
    number(lens.falloff, "fall-off", true);
    if (!lens.transform.finite())
        fail(Status::InvalidArgument, "the transform of lens '", lens.name, "' is not finite");
}

/// Whether the lens has no inside.
bool flat(const DetailLens& lens) {
    const glm::dmat3& m = lens.transform.linear;
    const double volume = glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2]);
    return lens.radius == 0 || !(std::abs(glm::determinant(m)) > 1e-12 * volume);
}

}  // namespace

double lens_profile(double strength, double radius, double falloff, double d) {
    if (!(d < radius))
        return 1;
    const double cosine = std::cos(0.5 * std::numbers::pi * d / radius);
    return 1 + (strength - 1) * (falloff == 1 ? cosine : std::pow(cosine, falloff));
}

LensField::Lens LensField::prepared(const DetailLens& lens) {
    Lens out;
    out.shape = lens.shape;
    out.filter = lens.filter;
    out.linear = glm::inverse(lens.transform.linear);
    out.offset = -(out.linear * lens.transform.offset);
    const glm::dmat3 rows = glm::transpose(out.linear);
    out.row_lengths = {glm::length(rows[0]), glm::length(rows[1]), glm::length(rows[2])};
    out.stretch = stretch({out.linear, {}});
    out.center = lens.transform.offset;
    // The sphere around a box reaches to its corners.
    out.world_radius = lens.radius * stretch(lens.transform) *
                       (lens.shape == LensShape::Box ? std::numbers::sqrt3 : 1);
    out.radius = lens.radius;
    out.strength = lens.strength;
    out.falloff = lens.falloff;
    return out;
}

LensReach LensField::reach(const Lens& lens, const Bound& world) {
    const glm::dvec3 center = lens.linear * world.center + lens.offset;
    const glm::dvec3 middle = lens.linear * world.box.center() + lens.offset;
    const glm::dvec3 half = 0.5 * world.box.size();
    const glm::dvec3 spread = glm::abs(lens.linear[0]) * half.x +
                              glm::abs(lens.linear[1]) * half.y + glm::abs(lens.linear[2]) * half.z;
    const glm::dvec3 low = glm::max(glm::abs(middle) - spread, glm::dvec3(0.0));
    const glm::dvec3 high = glm::abs(middle) + spread;
    LensReach out;
    if (lens.shape == LensShape::Sphere) {
        const double away = glm::length(center);
        const double radius = world.radius * lens.stretch;
        out.nearest = std::max(away - radius, glm::length(low));
        out.farthest = std::min(away + radius, glm::length(high));
    } else {
        const glm::dvec3 radius = world.radius * lens.row_lengths;
        out.nearest = std::max(largest(glm::abs(center) - radius), largest(low));
        out.farthest = std::min(largest(glm::abs(center) + radius), largest(high));
    }
    out.nearest = std::max(out.nearest, 0.0);
    return out;
}

LensReach reach(const DetailLens& lens, const Bound& world) {
    return LensField::reach(LensField::prepared(lens), world);
}

LensField::LensField(const Model& model, const std::vector<DetailLens>& lenses, bool in_any_order)
    : in_any_order_(in_any_order) {
    if (lenses.size() > kMostLenses)
        fail(Status::InvalidArgument, lenses.size(), " detail lenses; at most ", kMostLenses);
    uint64_t lists = 0;
    for (const DetailLens& lens : lenses) {
        refuse_nonsense(lens);
        if (flat(lens))
            continue;
        Lens made = prepared(lens);
        if (lens.filter != LensFilter::All) {
            if (lists == kMostFilters)
                fail(Status::InvalidArgument, "lens '", lens.name, "' is the ", kMostFilters + 1,
                     "th with a list of objects; at most ", kMostFilters);
            made.list = uint64_t{1} << lists++;
            in_list_.resize(model.objects.size(), 0);
            for (const ObjectIndex object : lens.objects) {
                if (object >= model.objects.size())
                    fail(Status::InvalidArgument, "lens '", lens.name, "' lists object ", object,
                         " of ", model.objects.size());
                in_list_[object] |= made.list;
            }
        }
        lenses_.push_back(made);
    }
    if (lists == 0)
        return;
    holds_list_ = in_list_;
    for (const ObjectIndex index : bottom_up(model)) {
        if (!model.objects[index].group())
            continue;
        for (const Placement& placement :
             model.objects[index].representations[0].assembly().placements)
            holds_list_[index] |= holds_list_[placement.object];
    }
}

LensField::LensPath LensField::root() {
    touching_.clear();
    for (size_t i = 0; i < lenses_.size(); ++i)
        touching_.push_back(static_cast<uint32_t>(i));
    return {0, static_cast<uint32_t>(touching_.size()), 0};
}

LensField::LensEffect LensField::at(ObjectIndex object, bool group, const Bound& world,
                                    const LensPath& above) {
    LensEffect effect;
    if (!in_any_order_)
        // Everything that was visited below an earlier group is done.
        touching_.resize(above.end);
    const auto first = static_cast<uint32_t>(touching_.size());
    effect.below = {first, first, above.lists};
    if (!in_list_.empty())
        effect.below.lists |= in_list_[object];
    if (world.empty())
        return effect;
    for (uint32_t i = above.begin; i < above.end; ++i) {
        const Lens& lens = lenses_[touching_[i]];
        const glm::dvec3 arm = world.center - lens.center;
        const double most = world.radius + lens.world_radius;
        if (!(glm::dot(arm, arm) < most * most))
            continue;
        const LensReach reached = reach(lens, world);
        if (!(reached.nearest < lens.radius))
            continue;
        const bool listed = lens.list == 0 || (effect.below.lists & lens.list) != 0;
        const bool holds = listed || (group && (holds_list_[object] & lens.list) != 0);
        if (group)
            touching_.push_back(touching_[i]);
        if (holds) {
            // A lens that coarsens must not coarsen objects in the group that it does not list.
            const double d = lens.strength < 1 ? reached.farthest : reached.nearest;
            const double value = lens_profile(lens.strength, lens.radius, lens.falloff, d);
            effect.refine *= listed ? value : std::max(1.0, value);
        }
        if (listed || lens.filter != LensFilter::Show)
            continue;
        if (!group) {
            const glm::dvec3 center = lens.linear * world.center + lens.offset;
            const double d =
                lens.shape == LensShape::Sphere ? glm::length(center) : largest(glm::abs(center));
            effect.gone = effect.gone || d < lens.radius;
        } else if (!holds && reached.farthest < lens.radius) {
            effect.gone = true;
        } else {
            effect.open = true;
        }
    }
    effect.below.end = static_cast<uint32_t>(touching_.size());
    if (in_any_order_ &&
        // The same lenses touch it as the group above.
        effect.below.end - first == above.end - above.begin) {
        touching_.resize(first);
        effect.below.begin = above.begin;
        effect.below.end = above.end;
    }
    return effect;
}

}  // namespace lodestone::choose
