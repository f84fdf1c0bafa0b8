// SPDX-License-Identifier: GPL-3.0-or-later
// Light plan: the few lights that each object of a scene
// needs, so that a view looks as with all lamps.
#pragma once

#include "base/job.h"
#include "model/model.h"

#include <optional>
#include <span>

namespace lodestone::light {

/// How much light a material sends back, as the renderer draws it.
struct SurfaceReflection {
    glm::dvec3 albedo{0.8};  // diffuse share of each color
    double gloss = 0;        // albedo of its highlight
    double exponent = 1;     // of that highlight's cosine
    bool mirror = false;     // rays go on from it, mirrored or refracted
};

/// The surfaces of a model as its renderer takes them.
struct RendererSurfaces {
    std::vector<SurfaceReflection> reflections;  // one for each material of the model
    double tolerance = 0;  // metres: the renderer lets nothing nearer than this cast a shadow
};

/// Something that is drawn.
struct DrawnThing {
    const Representation* representation = nullptr;
    Affine world;
    RayMask hidden = 0;
};

/// What is lit by one group of lights: a thing, or what of it is in a box (world frame).
struct LitPiece {
    uint32_t drawn = 0;
    uint32_t group = 0;
    std::optional<Box3> within;
};

struct LightPlan {
    std::vector<Light> lights;  // lamps, and such that stand for several
    std::vector<std::vector<uint32_t>>
        groups;                    // indices of lights; the first: all lamps as they are
    std::vector<LitPiece> pieces;  // in the order of things drawn, each whole
    double lights_each = 0;        // that light a point the view shows, on average

    bool empty() const { return groups.empty(); }
};

/// Below this many lamps all of them light everything.
inline constexpr size_t kFewLamps = 8;

/// Groups what is drawn by what lights it. POV-Ray shades a group with its own lamps alone, while
/// everything in between casts shadows.
///
/// Rays are cast from lamps to points that the view shows: one in every 20 pixels, at least 12,000,
/// in mirrors and behind glass too, and as many more as it takes that every part of a thing that a
/// pixel shows sees one (light_coverage.h). They tell which lamps reach what, and by how much a
/// light that stands for several differs from these (cut_lights). A lamp that reaches no
/// point of an object, nor any beside these, is not among its lights; so a patch of light smaller
/// than the distance of points can be missed. Things without any point are lit by all lamps. Things
/// that many lamps light here and there (the floor of many rooms) are cut into boxes. `bounces`: of
/// light between surfaces; then points that send light to what the view shows are taken too.
///
/// Empty if that saves little, lamps are few, `pixel_error` is 0, rays cannot be cast, or there is
/// too much to cast them at (a problem).
LightPlan plan_lights(const Model& model, const RendererSurfaces& renderer,
                      std::span<const DrawnThing> drawn, const View& view, double pixel_error,
                      int bounces, Problems& problems, const Job& job = {});

}  // namespace lodestone::light
