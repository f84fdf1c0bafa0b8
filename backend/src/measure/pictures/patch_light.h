// SPDX-License-Identifier: GPL-3.0-or-later
// LightPatches: a test whether pieces of a stand-in show about as much light as the finest does
// there.
#pragma once

#include "measure/visible/visible_sampler.h"

namespace lodestone::measure {

/// The light that rays have seen of the finest, to be looked at again on stand-ins. Distances do
/// not tell what lies a little before or behind something else, which way it faces, nor how much of
/// it there is: pages that come through a cover, bricks gone from before their mortar. The same
/// rays meet the stand-in, and their light (of a lamp beside the eye, on the surface there) is
/// compared in the mean over patches of PatchGrid.
class LightPatches {
public:
    /// Patches do not look alike when the root of the mean square of their differences, over the
    /// mean light, is larger than this.
    /// Taste: a larger value keeps cheaper levels that are visibly darker or brighter in places.
    static constexpr double kMostOff = 0.1;

    /// Takes the points that the sampler's rays 0, 1, ... found (`cast`).
    /// Keeps no reference.
    LightPatches(const Mesh& finest, const VisibleSampler& sampler, const ray::MeshSkin& skin,
                 std::span<const CastPoints> cast);

    /// The side in metres of the largest patches that do not look alike; up to four radii of the
    /// bound where all of the stand-in looks different. 0 where only patches of `least` metres or
    /// less look different, or only patches with fewer than two rays. With `matched` its brightness
    /// as a whole does not count, up to a factor of two: it will be made as bright. `scene` has
    /// `stand_in` in `skin`. May be called from any thread.
    double largest_unlike_patch(const Mesh& stand_in, const ray::MeshScene& scene,
                                const ray::MeshSkin& skin, bool matched, double least) const;

    /// Colors (red, green, blue) of the vertices of an opaque, matte, convex stand-in in which it
    /// shows about as much light as the finest, from each side and at each place. The fourth number
    /// is how much light falls around each vertex; 0 where nothing was seen, and for a surface of
    /// one color. The light is that of a sky and of a sun obliquely beside the eye, not below it,
    /// with shadows; eyes below the horizon count less. `finest` is the scene of the mesh this was
    /// made of. May be called from any thread.
    std::vector<glm::dvec4> fitted_vertex_colors(const Mesh& stand_in,
                                                 const ray::MeshScene& finest) const;

private:
    struct PatchSample {
        uint64_t patch;
        glm::dvec3 point;
        glm::dvec3 towards;            // unit direction to the eye
        glm::dvec3 normal;             // unit, on the eye's side
        ray::SurfaceAppearance shown;  // the surface's colors
        glm::dvec3 light;
    };
    std::vector<PatchSample> seen_;  // sorted by patch
    glm::dvec3 mean_{0.0};           // the mean light
    bool colored_ = false;           // true: the finest shows more than one color
    double radius_ = 0;              // metres: the radius of the bound
};

}  // namespace lodestone::measure
