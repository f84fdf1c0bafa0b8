// SPDX-License-Identifier: GPL-3.0-or-later
// SurfaceDeviation: how far a solid stand-in is from the finest surface, as far as it can be seen.
#pragma once

#include "measure/deviation/surface_samples.h"
#include "model/composite.h"

#include <mutex>

namespace lodestone::measure {

class VisibleLooks;

/// The distance between two surfaces and their looks, in metres. Surfaces are compared both ways:
/// from the visible surface of the finest to the whole stand-in, and from the whole stand-in to the
/// whole finest.
///
/// If the nearest point of the stand-in has another look than the visible point, that look was
/// moved, by the least of: the distance to the missing look on the stand-in; the distance to where
/// the finest shows the look that is there instead; and, for a look that the finest has nowhere (a
/// mean color), the radius within which the finest's own colors mix to it. If the same textured
/// material shows another color there, it was moved by as much as its texture slid. Every look that
/// at least 0.2 % of the area shows has its own quantile, so a lost road is wrong by half its
/// width, however large the field around it is. Transparent points are neither sampled nor matched.
struct SurfaceDeviation {
    /// Metres: the largest quantile of places (99.9 %), both ways, and of moves of every look.
    double error = 0;
    double max = 0;    // metres: the largest distance that was seen
    double moved = 0;  // metres: of the error, what is moves of looks
};

/// The numbers of samples of a comparison.
struct DeviationOptions {
    uint32_t samples = 8192;  // points uniform in area, in each direction
    /// Vertices of the finest; a larger mesh is represented by so many.
    uint32_t most_vertices = 8192;
    uint64_t seed = 1;
    /// Rays of each triangle by which seen_from_outside() tells which triangles of the finest can
    /// be seen; vertices of hidden triangles alone are then hidden without rays of their own. 0: no
    /// triangle is asked. A mesh that refracts hides nothing.
    int rays_of_triangle = 0;
};

/// The finest surface made ready to be compared with. The quantile of each direction is over two
/// sets of the same total weight: points uniform in (visible) area, with equal weights, and
/// (visible) vertices, each with a third of its triangles' area. Of a stand-in up to 16,384
/// vertices are taken, because a few of them decide. A point of the finest is visible if a ray from
/// outside its bound hits it; a vertex if one of 16 rays from beside it reaches infinity.
class DeviationReference {
public:
    /// Keeps what it needs of the mesh, of the looks and of the skin, and a reference to their
    /// palette. Throws Error: InvalidArgument, RaysUnavailable, Cancelled.
    DeviationReference(const Mesh& finest, const DeviationOptions& options,
                       const SurfaceLooks& surface = {}, const Job& job = {});
    ~DeviationReference();
    /// The answers that repaint() found on its way; empty where there was nothing to vote on.
    struct RepaintResult {
        std::shared_ptr<const ray::MeshScene> scene;  // the level, opaque, for closest points
        /// The point of the level nearest to each visible point; infinitely far: not searched.
        std::vector<ray::ClosestPoint> nearest;
        bool surely_useless = false;
    };
    DeviationReference(const DeviationReference&) = delete;
    DeviationReference& operator=(const DeviationReference&) = delete;

    /// The deviation of a stand-in, whose `surface` is numbered by the same palette. It may be
    /// called from any thread, and the bits are the same on any number of threads. If one of the
    /// two meshes has nothing to measure to, both numbers are the diameter of the other's bounding
    /// sphere; two empty meshes agree. When the error is larger than `useless`, the answer may be
    /// any number above `useless` (infinite where that is very sure), which takes less time.
    SurfaceDeviation of(const Mesh& stand_in, const SurfaceLooks& surface = {}, const Job& job = {},
                        double useless = std::numeric_limits<double>::infinity()) const {
        return of(stand_in, surface, {}, useless, job);
    }
    /// The deviation of a level after repaint(), whose result is `known`, or of a level without it
    /// (empty). No triangle of the level may have moved since.
    SurfaceDeviation of(const Mesh& stand_in, const SurfaceLooks& surface,
                        const RepaintResult& known, double useless, const Job& job) const;

    /// The deviation of a box or an ellipsoid that shows one look everywhere. Distances to it are
    /// exact; they are measured from a quarter of the points, and from the corners of a box and 25
    /// points of each of its sides, or from as many points as tell an ellipsoid.
    SurfaceDeviation of(const lodestone::Solid& stand_in, uint16_t look, double useless,
                        const Job& job) const;

    /// The deviation told by half of all points: less exact, in half of the time.
    SurfaceDeviation roughly(const Mesh& stand_in, const SurfaceLooks& surface,
                             const RepaintResult& known, double useless, const Job& job) const;

    /// Gives each triangle of a level (with the finest's slots and skin) the slot that most of the
    /// visible points nearest to it show, if enough of them agree: boards look like the tiles that
    /// lay on them. A textured slot is given only with texture coordinates that show what those
    /// points show. A level whose error is surely above `useless` is left as it is; with `rough`
    /// that is the error of roughly().
    RepaintResult repaint(Mesh& level, const ray::MeshSkin* skin = nullptr, const Job& job = {},
                          bool rough = false,
                          double useless = std::numeric_limits<double>::infinity()) const;

    /// The scene of the finest, as it was made for this.
    const ray::MeshScene& scene() const { return scenes_.whole(); }
    /// The sampler of the finest; it refers to the mesh it was made from, which must still be
    /// there.
    const VisibleSampler& sampler() const { return sampler_; }
    /// The triangles of the finest that can be seen, 1 or 0 for each; empty where that was not
    /// asked for, or where the finest refracts.
    const std::vector<uint8_t>& seen_triangles() const { return seen_triangles_; }
    /// The points that the first rays of sampler() found; may be taken once.
    std::vector<CastPoints> take_cast_points() { return std::move(cast_); }

    /// The number of visible points and vertices of the finest.
    size_t visible_points() const { return seen_.points.size(); }

private:
    /// Points of the finest that can be seen.
    struct SeenSamples {
        std::vector<SurfaceSample> points;  // neighbors in the list are mostly neighbors in space
        std::unique_ptr<const VisibleLooks> looks;  // the same points, to be searched
    };
    struct Against;
    /// A mesh, and how many of its points and vertices are asked; `exact` is the solid that the
    /// mesh is about.
    struct StandIn {
        const Mesh& mesh;
        const SurfaceLooks& surface;
        uint32_t samples, vertices;
        const lodestone::Solid* exact = nullptr;
    };
    static SurfaceDeviation measure(const std::vector<SurfaceSample>& samples,
                                    const Against& against,
                                    std::span<const ray::ClosestPoint> nearest, double least,
                                    double useless, const Job& job);
    const SeenSamples& few() const;
    SurfaceDeviation compare(const SeenSamples& seen, const StandIn& stand_in,
                             const RepaintResult& known, double useless, const Job& job) const;

    DeviationOptions options_;
    LookScenes scenes_;
    VisibleSampler sampler_;
    std::vector<CastPoints> cast_;
    std::vector<uint8_t> seen_triangles_;
    const LookPalette* palette_;
    SeenSamples seen_;
    mutable std::once_flag once_;  // makes few_: mostly nobody asks for it
    mutable SeenSamples few_;
    double diameter_ = 0;
};

}  // namespace lodestone::measure
