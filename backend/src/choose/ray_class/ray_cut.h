// SPDX-License-Identifier: GPL-3.0-or-later
// Ray cut: what a class of rays meets instead of what the camera sees, where the picture cannot
// tell.
#pragma once

#include "choose/ray_class/ray_need.h"

namespace lodestone::choose {

/// Why a class meets what it meets of a thing the camera sees.
enum class RayState : uint8_t {
    Off = 0,      // it does not see it
    Own = 1,      // a coarser representation of its own
    Group = 2,    // a stand-in for a group around it
    Need = 3,     // what the camera sees: there is nothing coarser that is good enough
    Shape = 4,    // the same: a stand-in would shadow or mirror its own original
    Contact = 5,  // the same: something else is too near
};

/// A representation that a class meets in place of a node of the camera's cut and all below it.
struct RayChoice {
    uint32_t node = 0;
    uint32_t lod = 0;
    double scale = 1;     // of a box or ellipsoid, about its center
    double error = 0;     // metres in the world
    double error_px = 0;  // what of Pixel Error it takes
    bool soft = false;    // good enough only as lights have the size they have
    bool alone = false;   // no ray meets what the camera's cut has here: it need not be drawn
};

/// Of one class.
struct RayCut {
    RayMask rays = 0;
    std::vector<RayChoice> own;    // by node, rising; none is below another
    std::vector<RayState> states;  // one for each of the camera cut's `chosen`

    uint64_t triangles = 0;  // placed, that its rays meet
    uint64_t bytes = 0;      // of these in POV-Ray's memory, as Cut::bytes
    uint64_t met = 0;        // occurrences
    double largest_error_px = 0;
};

/// What the classes asked for by view.modifiers.ray_classes meet, one RayCut for each, in the order
/// of their bits. `cut`: the camera's, of the same model and view; no class is finer than it, and
/// radiosity meets the same. What is coarser cannot shadow or mirror its own original, for:
/// - the picture shows the original by no ray at all. It is then replaced for all classes together,
/// by
///   what its shadows and its images need (which are asked for with reflections only): `alone`;
/// - or it is a box or ellipsoid in place of a convex opaque mesh, inside it (shadows) or around it
///   (reflections), and nothing else touches it or is nearer than a few pixels.
/// Pure, as `shape_of` is, which is asked only about what else is good enough. Nothing is coarser
/// by a criterion but Resolution. cost: about a visit of each node, and n log n where something may
/// be.
std::vector<RayCut> choose_rays(const Model& model, const View& view, const Cut& cut,
                                const ShapeOf& shape_of, const Job& job = {});

/// What must be in POV-Ray's memory for the camera and all classes.
struct ResidentSize {
    uint64_t triangles = 0;  // placed
    uint64_t bytes = 0;
};
ResidentSize resident_size(const Model& model, const Cut& cut, const std::vector<RayCut>& rays);

}  // namespace lodestone::choose
