// SPDX-License-Identifier: GPL-3.0-or-later
// Light plan: the few lights that each object of a scene needs, so that a view looks as with all
// lamps.
#pragma once

#include "base/job.h"
#include "model/model.h"

#include <optional>
#include <span>

namespace lodestone::light {

/// How much light a material sends back, as the renderer draws it.
struct SurfaceReflection {
    glm::dvec3 albedo{0.8};  // the diffuse share of each color
    double gloss = 0;        // the albedo of its highlight
    double exponent = 1;     // that of the cosine in its highlight
    bool mirror = false;     // rays go on from it, mirrored or refracted
};

/// The surfaces of a model as its renderer draws them.
struct RendererSurfaces {
    std::vector<SurfaceReflection> reflections;  // one for each material of the model
    double tolerance = 0;  // in metres: things nearer than this cast no shadow on the surface
};

/// A placed representation that is drawn.
struct DrawnThing {
    const Representation* representation = nullptr;
    Affine world;
    RayMask hidden = 0;
};

/// The part of a scene that one group of lights lights: a thing, or its part in a box (world
/// frame).
struct LitPiece {
    uint32_t drawn = 0;
    uint32_t group = 0;
    std::optional<Box3> within;
};

struct LightPlan {
    std::vector<Light> lights;  // lamps, and lights that stand for several
    /// Indices of `lights`; the first group holds all lamps as they are.
    std::vector<std::vector<uint32_t>> groups;
    /// In the order of the drawn things; all pieces of a thing together.
    std::vector<LitPiece> pieces;
    double lights_each = 0;  // the mean number of lights of a point that the view shows

    bool empty() const { return groups.empty(); }
};

/// With fewer lamps than this, all of them light everything.
/// Taste: a larger number saves choosing lights where little is to be gained.
inline constexpr size_t kFewLamps = 8;

/// Groups drawn things by the lights that light them. POV-Ray shades a group with its own lamps
/// alone, while everything in between casts shadows.
///
/// Rays are cast from lamps to points that the view shows: one in every 20 pixels, at least 12,000,
/// in mirrors and behind glass too, and as many more as needed so that every part of a thing that a
/// pixel shows sees one (light_coverage.h). They tell which lamps reach which points, and by how
/// much a light that stands for several lamps differs from these (cut_lights). A lamp that reaches
/// no point of an object, nor any beside these, is not among its lights; so a patch of light
/// smaller than the distance of points can be missed. Things without any point are lit by all
/// lamps. Things that many lamps light here and there (the floor of many rooms) are cut into boxes.
/// `bounces`: how often light goes from surface to surface; then points that send light to what the
/// view shows are used, too.
///
/// Empty if that saves little, lamps are few, `pixel_error` is 0, rays cannot be cast, or there is
/// too much to cast them at (a problem).
LightPlan plan_lights(const Model& model, const RendererSurfaces& renderer,
                      std::span<const DrawnThing> drawn, const View& view, double pixel_error,
                      int bounces, Problems& problems, const Job& job = {});

}  // namespace lodestone::light
