// SPDX-License-Identifier: GPL-3.0-or-later
// Lenses, of the world and of the screen, and the criterion by which detail is judged (5.5.5).
#pragma once

#include "base/maths.h"
#include "model/placement.h"

#include <optional>
#include <string>
#include <vector>

namespace lodestone {

enum class LensShape : uint8_t { Sphere = 0, Box = 1 };

/// The effect of a lens on objects that are not in its list.
enum class LensFilter : uint8_t {
    All = 0,     // there is no list: everything is refined
    Refine = 1,  // only the listed objects are refined, and all below them
    Show = 2,    // and nothing else is drawn whose bound has its center inside
};

/// A region of the world. Inside it everything is drawn `strength` times finer (below 1: coarser),
/// less so towards its rim: 1 + (strength - 1) cos(pi d / 2 radius)^falloff, with d measured in the
/// lens's own frame.
struct DetailLens {
    std::string name;
    LensShape shape = LensShape::Sphere;
    Affine transform;     // its frame -> the world
    double radius = 1;    // of the sphere, or half the box's sides, in its frame; 0: no effect
    double strength = 2;  // more than 0
    double falloff = 1;   // 0: the same everywhere inside
    LensFilter filter = LensFilter::All;
    std::vector<ObjectIndex> objects;  // the list of the filter
};

/// A disc on the image.
struct ScreenLens {
    std::string name;
    glm::dvec2 center{0.0};  // pixels from the left and the top
    double radius = 1;       // pixels; 0: no effect
    double strength = 2;
    double falloff = 1;
};

/// The measure by which a level is good enough (5.2.2), and so the unit of the view's threshold.
enum class DetailCriterion : uint8_t {
    Resolution = 0,  // the pixels that its error covers
    Feature = 1,     // the share of the picture that its largest missing feature covers
    Area = 2,  // the share of the picture up to which the coarsest level is used; each finer one
               // serves four times as much
    Distance =
        3,  // metres up to which the original is used; each coarser level serves twice as far
};

}  // namespace lodestone
