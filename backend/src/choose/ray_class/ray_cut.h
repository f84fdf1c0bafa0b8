// SPDX-License-Identifier: GPL-3.0-or-later
// Ray cut: the representations that a class of rays meets instead of those that the camera sees,
// where the picture shows no difference.
#pragma once

#include "choose/ray_class/ray_need.h"

#include <array>

namespace lodestone::choose {

/// The rule by which a class of rays may meet something coarser than the camera's rays do.
enum class RayRule : uint8_t {
    None,    // it meets what they meet
    Mirror,  // its images must look alike
    Shadow,  // its shadows must look alike; soft ones hide more
};
/// The rule of each of kRayClasses: camera, reflection, shadow, radiosity.
inline constexpr std::array kRayRules{RayRule::None, RayRule::Mirror, RayRule::Shadow,
                                      RayRule::None};
static_assert(kRayRules.size() == kRayClasses.size(), "each class has a rule, or None");

/// The rule of one class.
constexpr RayRule rule_of(RayMask rays) {
    for (size_t i = 0; i < kRayClasses.size(); ++i) {
        if (kRayClasses[i] == rays)
            return kRayRules[i];
    }
    return RayRule::None;
}

/// The classes with this rule.
constexpr RayMask classes_with(RayRule rule) {
    RayMask rays = 0;
    for (size_t i = 0; i < kRayClasses.size(); ++i)
        rays |= kRayRules[i] == rule ? kRayClasses[i] : RayMask{0};
    return rays;
}

/// Why a class of rays meets a representation in place of what the camera sees.
enum class RayState : uint8_t {
    Off = 0,      // the class does not see the thing
    Own = 1,      // a coarser representation of its own
    Group = 2,    // a stand-in for a group around it
    Need = 3,     // the camera's representation: nothing coarser is good enough
    Shape = 4,    // the camera's: a stand-in would shadow or mirror its own original
    Contact = 5,  // the camera's representation: something else is too near
};

/// A representation that a class meets in place of a node of the camera's cut and everything below
/// it.
struct RayChoice {
    uint32_t node = 0;
    uint32_t lod = 0;
    double scale = 1;     // that of a box or ellipsoid, about its center
    double error = 0;     // in metres, in the world
    double error_px = 0;  // how much of Pixel Error it uses up
    bool soft = false;    // good enough only because lights have the size they have
    bool alone = false;   // no ray meets the camera's representation here: it need not be drawn
};

/// The choices of one class.
struct RayCut {
    RayMask rays = 0;
    std::vector<RayChoice> own;    // by rising node; none is below another
    std::vector<RayState> states;  // one for each of the camera cut's `chosen`

    uint64_t triangles = 0;  // those of all occurrences that its rays meet
    uint64_t bytes = 0;      // those of the same in POV-Ray's memory, as Cut::bytes
    uint64_t met = 0;        // in occurrences
    double largest_error_px = 0;
};

/// Chooses for the classes in view.modifiers.ray_classes: one RayCut for each, in the order of
/// their bits. `cut`: that of the camera, of the same model and view. No class is finer than it,
/// and one without a rule meets the same. A coarser representation cannot shadow or mirror its own original,
/// for one of two reasons:
/// - The picture shows the original by no ray at all. It is then replaced for all classes together,
///   by a level that is good enough for its shadows and its images (images are asked for with
///   reflections only): `alone`.
/// - Or it is a box or ellipsoid in place of a convex opaque mesh, inside it (shadows) or around it
///   (reflections), and nothing else touches it or is nearer than a few pixels.
/// The result depends on the arguments only, as does `shape_of`, which is asked only about things
/// that are good enough otherwise. With a criterion other than Resolution nothing is coarser. cost:
/// about one visit of each node, and n log n where something may be coarser.
std::vector<RayCut> choose_rays(const Model& model, const View& view, const Cut& cut,
                                const ShapeOf& shape_of, const Job& job = {});

/// The size of all that must be in POV-Ray's memory for the camera and all classes.
struct ResidentSize {
    uint64_t triangles = 0;  // those of all occurrences
    uint64_t bytes = 0;
};
ResidentSize resident_size(const Model& model, const Cut& cut, const std::vector<RayCut>& rays);

}  // namespace lodestone::choose
