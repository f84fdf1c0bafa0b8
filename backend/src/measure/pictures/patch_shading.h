// SPDX-License-Identifier: GPL-3.0-or-later
// ShadedPatches: a test whether pieces of a stand-in are shaded like the finest.
#pragma once

#include "measure/visible/visible_sampler.h"

#include <functional>
#include <span>
#include <vector>

namespace lodestone::measure {

/// The shading normals that rays have seen of the finest, to be looked at again on stand-ins. The
/// light on a matte surface is its normal times the lamp's direction. So where the mean normals of
/// a patch agree, so does its light under any lamp that all of it faces, a grazing one, too; a
/// lamp beside the eye (LightPatches) hardly tells a gully from a plain. A patch is one of
/// PatchGrid, on the side that the stand-in faces there: which side a rough surface faces or is
/// seen from is chance, and would favor its slopes to that side. What is turned counts; that slopes
/// to all sides show less light than a plain is told by LightPatches, and made up for.
class ShadedPatches {
public:
    /// Patches are shaded alike when the root of the mean square of how far their mean normals are
    /// turned (the part of the difference across the stand-in's, 0...1) is not larger than this.
    /// Taste: so much of a grazing lamp's light is off; 0.06 is 3.4 degrees.
    static constexpr double kMostTurned = 0.06;

    /// Takes the points that the sampler's rays 0, 1, ... found (`cast`), and casts more of a finer
    /// mesh. `visible_area` (m^2) is the mesh's. Keeps no reference.
    ShadedPatches(const Mesh& finest, const VisibleSampler& sampler,
                  std::span<const CastPoints> cast, double visible_area);

    /// The side in metres of the largest patches that are not shaded alike; smaller ones that are
    /// turned more than that count as larger in proportion, for their relief (side times turn) is
    /// off by as much: a box has the mean normals of a ball on each side, and none of its own. 0
    /// where that is `least` metres or less, or what is seen lies farther off than that. Thin
    /// things count by how much of a patch they cover. 0 of foliage, too, where neighbors face
    /// anywhere: it has no surface to be shaded. `scene` has `stand_in`. May be called from any
    /// thread.
    double largest_unlike_patch(const Mesh& stand_in, const ray::MeshScene& scene,
                                double least) const;

    /// The same for each part of the finest, of patches up to the part's width. `part_of` tells the part of a
    /// triangle of the finest, `least` is each part's. Samples lie as densely as in the whole, and
    /// resolve no smaller patches.
    std::vector<double> largest_unlike_patches(
        const Mesh& stand_in, const ray::MeshScene& scene,
        const std::function<uint32_t(uint32_t triangle)>& part_of,
        std::span<const double> least) const;

private:
    /// A place of a stand-in that a sample's ray meets.
    struct MetSample {
        uint64_t patch;
        glm::dvec3 point;   // of the finest
        glm::dvec3 normal;  // of the stand-in
        glm::dvec3 off;
    };
    struct ShadedSample {
        uint64_t cube;  // of PatchGrid
        uint32_t triangle;
        glm::dvec3 point;
        glm::dvec3 towards;  // unit direction to the eye
        glm::dvec3 normal;   // unit, on the eye's side
    };
    /// Adds what the sample meets, unless that is farther off than `near`.
    void meet(const ShadedSample& seen, const Mesh& stand_in, const ray::MeshScene& scene,
              double near, std::vector<MetSample>& out) const;
    /// The side of the largest of such patches that are not shaded alike; `samples` were asked.
    double largest_of(std::vector<MetSample>& met, size_t samples, double widest,
                      double least) const;

    std::vector<ShadedSample> seen_;  // in the order they were cast
    double radius_ = 0;               // metres: the radius of the bound
    double visible_area_ = 0;         // m^2
    bool is_surface_ = false;         // neighbors face about the same way
};

}  // namespace lodestone::measure
