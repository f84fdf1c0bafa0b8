// SPDX-License-Identifier: GPL-3.0-or-later
// LightPatches: whether pieces of a stand-in show about as much light as the finest does there.
#pragma once

#include "measure/visible/visible_sampler.h"

namespace lodestone::measure {

/// What rays have seen of the finest, to be looked at again on stand-ins. Distances do not tell
/// what lies a little before or behind something else, which way it faces, nor how much of it there
/// is: pages that come through a cover, bricks gone from before their mortar. The same rays meet
/// the stand-in, and their light (of a lamp beside the eye, on the surface there) is compared in
/// the mean over patches: what lies in one cube of space and is seen from one of six sides. Single
/// rays differ anyway: what they add by being few is left out of the mean square (products of two
/// rays' differences have nothing of it).
class LightPatches {
public:
    /// Of a mean square of differences, over the mean light: patches that differ by more do not
    /// look alike.
    static constexpr double kMostOff = 0.1;

    /// Of what the sampler's rays 0, 1, ... found (`cast`); `seed` is the sampler's. Keeps no
    /// reference.
    LightPatches(const Mesh& finest, const VisibleSampler& sampler, const ray::MeshSkin& skin,
                 std::span<const CastPoints> cast, uint64_t seed);

    /// The side of the largest patches that do not look alike, metres; up to four radii of the
    /// bound where all of it looks different. 0 where only patches of `least` or less do, or such
    /// as have no two rays. With `matched` it does not count by how much it is brighter in all, up
    /// to twice: it will be made as bright. `scene` has `stand_in` in `skin`. Any thread.
    double largest_unlike_patch(const Mesh& stand_in, const ray::MeshScene& scene,
                                const ray::MeshSkin& skin, bool matched, double least) const;

    /// Colors (red, green, blue) of the vertices of an opaque, matte, convex stand-in in which it
    /// shows about as much light as the finest, from each side and at each place, and (the fourth)
    /// how much light falls around each vertex; 0 where nothing was seen, and for what has one
    /// color. The light is that of a sky and of a sun obliquely beside the eye, not below it, with
    /// shadows; eyes below the horizon count less. `finest`: the scene of the mesh this was made
    /// of. Any thread.
    std::vector<glm::dvec4> fitted_vertex_colors(const Mesh& stand_in,
                                                 const ray::MeshScene& finest) const;

private:
    struct PatchSample {
        uint64_t patch;  // the smallest one; of larger ones the first bits
        glm::dvec3 point;
        glm::dvec3 towards;            // the eye, unit length
        glm::dvec3 normal;             // on its side
        ray::SurfaceAppearance shown;  // what it is made of
        glm::dvec3 light;
    };
    struct PatchDifference {
        double off = 0;    // root of the mean square, over the mean light
        double known = 0;  // share of the rays that are not alone in their patch
    };
    PatchDifference difference(const std::vector<glm::dvec3>& off, int halvings) const;

    std::vector<PatchSample> seen_;  // by patch
    glm::dvec3 mean_{0.0};           // light
    bool colored_ = false;           // in more than one color
    double radius_ = 0;
};

}  // namespace lodestone::measure
