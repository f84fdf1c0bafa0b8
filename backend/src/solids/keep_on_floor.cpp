// SPDX-License-Identifier: GPL-3.0-or-later
#include "solids/keep_on_floor.h"

#include "solids/solid_replacement.h"

#include <algorithm>
#include <cmath>

namespace lodestone::solids {
namespace {

// The least height above the floor, over the height of the whole.
// Law: less is rounding of double precision, with a large margin.
constexpr double kSameHeight = 1e-9;
// The most rounds of stretching.
// Taste: more come nearer; it mostly needs a few.
constexpr int kRounds = 30;
// The change below which a round is the last.
// Taste: a smaller change takes more rounds for nothing that is seen.
constexpr double kLastChange = 1e-7;

double area_of(const Primitive& primitive, bool box) {
    return (box ? box_shell(primitive.half_size) : ellipsoid_shell(primitive.half_size)).area;
}

/// Stretches along Z and across it; the axes stay as they are.
void stretch(Primitive& primitive, double along, double across) {
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3& axis = primitive.axes[i];
        primitive.half_size[i] *=
            glm::length(glm::dvec3(across * axis.x, across * axis.y, along * axis.z));
    }
}

}  // namespace

HeightRange reach_of(const Primitive& primitive, bool box) {
    double sum = 0;
    double squares = 0;
    for (int i = 0; i < 3; ++i) {
        const double part = std::abs(primitive.axes[i].z) * primitive.half_size[i];
        sum += part;
        squares += part * part;
    }
    const double half = box ? sum : std::sqrt(squares);
    return {primitive.center.z - half, primitive.center.z + half};
}

Primitive standing_on(const Primitive& primitive, bool box, double floor) {
    // A primitive that would have to change too much (tilted and far below the floor) is moved
    // instead.
    // The most stretch.
    // Taste: a larger one keeps more solids on the floor in strange proportions.
    constexpr double kMost = 2;
    const HeightRange before = reach_of(primitive, box);
    const double height = before.high - before.low;
    if (!(before.high - floor > kSameHeight * height) ||
        !(std::abs(before.low - floor) > kSameHeight * height))
        return primitive;
    const double area = area_of(primitive, box);
    Primitive out = primitive;
    double whole_along = 1;
    double whole_across = 1;
    for (int round = 0; round < kRounds; ++round) {
        const HeightRange now = reach_of(out, box);
        const double along = (before.high - floor) / (now.high - now.low);
        stretch(out, along, 1);
        // The power lies between the effects of the width on tops (squared) and on sides.
        const double across = std::pow(area / area_of(out, box), 0.7);
        stretch(out, 1, across);
        whole_along *= along;
        whole_across *= across;
        if (std::max(std::abs(along - 1), std::abs(across - 1)) < kLastChange)
            break;
        if (!(std::max(whole_along, whole_across) <= kMost &&
              std::min(whole_along, whole_across) >= 1 / kMost)) {
            out = primitive;
            break;
        }
    }
    // Where both cannot be had the area counts, because it is seen.
    out.half_size *= std::sqrt(area / area_of(out, box));
    out.center.z += floor - reach_of(out, box).low;
    return out;
}

Primitive kept_above(const Primitive& primitive, bool box, double floor) {
    const HeightRange reach = reach_of(primitive, box);
    if (!(reach.low < floor))
        return primitive;
    Primitive out = standing_on(primitive, box, floor);
    out.center.z += std::max(0.0, floor - reach_of(out, box).low);
    return out;
}

}  // namespace lodestone::solids
