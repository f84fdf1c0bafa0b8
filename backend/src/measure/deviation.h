// SPDX-License-Identifier: GPL-3.0-or-later
// Deviation: how far a solid stand-in is from the finest surface, as far as that can be seen.
#pragma once

#include "measure/surface_samples.h"

namespace lodestone::measure {

class VisibleLooks;

/// Distances in metres, of both directions together: from the visible surface of the finest to the
/// stand-in, and from the stand-in (all of it) to the finest (all of it). Where the nearest surface
/// of the stand-in has another look than a visible point, it also counts by how much the looks were
/// moved, the least of: the distance to the look that is missed; to where the finest shows the look
/// that is there instead; and, for a look that the finest has nowhere (a mean color), the radius
/// within which the finest's own colors mix to it. So a road that is gone is as wrong as half its
/// width, however large the field around it: every look that at least .2 % of the area shows has
/// its own quantile (99 %). Where the same textured material shows another color it counts by how
/// far its texture slid. What is transparent is not there: it is neither sampled nor matched.
struct Deviation {
    double error = 0;  // the largest quantile: places (99.9 %) both ways, and moves of every look
    double max = 0;    // the largest distance that was seen
};

struct DeviationOptions {
    uint32_t samples = 8192;        // points uniform in area, each direction
    uint32_t most_vertices = 8192;  // of the finest; a larger one is represented by so many
    uint64_t seed = 1;
};

/// The finest surface made ready to be compared with. A direction's quantile is over two sets of
/// equal weight: points uniform in (visible) area, which share it equally, and (visible) vertices,
/// each with a third of its triangles' area; of a stand-in up to 16,384, for a few of them decide. A point of the finest is visible when a ray from
/// outside its bound hits it; a vertex when one of 16 rays from beside it sees infinity.
class DeviationReference {
public:
    /// Keeps what it needs of the mesh, of the looks and of the skin, and a reference to their
    /// palette. Throws Error: InvalidArgument, RaysUnavailable, Cancelled.
    DeviationReference(const Mesh& finest, const DeviationOptions& options,
                       const Surface& surface = {}, const Job& job = {});
    ~DeviationReference();
    DeviationReference(const DeviationReference&) = delete;
    DeviationReference& operator=(const DeviationReference&) = delete;

    /// `surface` is numbered by the same palette. Same bits on any number of threads. Where one of
    /// the two meshes has nothing to measure to, both numbers are the diameter of the other's
    /// bounding sphere; two empty ones agree. Where the error is much larger than `useless` the answer
    /// may be infinite, and sooner there. May be called from any thread.
    Deviation of(const Mesh& stand_in, const Surface& surface = {}, const Job& job = {},
                 double useless = std::numeric_limits<double>::infinity()) const {
        return of(stand_in, surface, {}, useless, job);
    }
    /// The same of a level that was repainted (or not, and no triangle of it has moved since), knowing
    /// what that found; `nearest` may be empty.
    Deviation of(const Mesh& stand_in, const Surface& surface,
                 std::span<const ray::Closest> nearest, double useless, const Job& job) const;

    /// The same with half of all points, for what need not be known as well.
    Deviation roughly(const Mesh& stand_in, const Surface& surface,
                      std::span<const ray::Closest> nearest, double useless, const Job& job) const;

    /// Gives each triangle of a level (of the finest's slots and skin) the slot that most of the
    /// visible points nearest to it show, where enough of them agree: boards look like the tiles
    /// that lay on them. A slot with textures comes with texture coordinates that show what those
    /// points show, or not at all. The nearest point of the level by visible point, at infinity where
    /// it was not looked for; empty where nothing was.
    std::vector<ray::Closest> repaint(Mesh& level, const ray::Skin* skin = nullptr,
                                      const Job& job = {}) const;

    /// Of the finest, as it was made for this.
    const ray::Scene& scene() const { return scenes_.whole(); }
    /// Likewise; of the mesh it was made from, which must still be there.
    const VisibleSampler& sampler() const { return sampler_; }
    /// What the first rays of sampler() found, once.
    std::vector<Cast> take_cast() { return std::move(cast_); }

    /// How many visible points and vertices of the finest there are.
    size_t visible_points() const { return seen_.points.size(); }

private:
    /// Points of the finest.
    struct Seen {
        std::vector<SurfaceSample> points;  // neighbors in the list are mostly neighbors in space
        std::unique_ptr<const VisibleLooks> looks;  // the same, to be searched
    };
    struct Against;
    static Deviation measure(const std::vector<SurfaceSample>& samples, const Against& against,
                             std::span<const ray::Closest> nearest, double useless, const Job& job);
    Deviation compare(const Seen& seen, const Mesh& stand_in, const Surface& surface,
                      uint32_t samples, uint32_t most_vertices,
                      std::span<const ray::Closest> nearest, double useless, const Job& job) const;

    DeviationOptions options_;
    LookScenes scenes_;
    VisibleSampler sampler_;
    std::vector<Cast> cast_;
    const Looks* palette_;
    Seen seen_;
    Seen few_;  // half of them
    double diameter_ = 0;
};

}  // namespace lodestone::measure
