// SPDX-License-Identifier: GPL-3.0-or-later
// Deviation: how far a solid stand-in is from the finest surface, as far as that can be seen.
#pragma once

#include "base/job.h"
#include "ray/scene.h"

namespace lodestone::measure {

/// Distances in metres, of both directions together: from the visible surface of the finest to the
/// stand-in, and from the stand-in (all of it) to the finest (all of it).
struct Deviation {
    double error = 0;  // the larger of the two directions' 99.9 % quantiles
    double max = 0;    // the largest distance that was seen
};

struct DeviationOptions {
    uint32_t samples = 8192;        // points uniform in area, each direction
    uint32_t most_vertices = 8192;  // of either mesh; a larger one is represented by so many
    uint64_t seed = 1;
};

/// The finest surface made ready to be compared with. A direction's quantile is over two sets of
/// equal weight: points uniform in (visible) area, which share it equally, and (visible) vertices,
/// each with a third of its triangles' area. A point of the finest is visible when a ray from
/// outside its bound hits it; a vertex when one of 16 rays from beside it sees infinity.
class DeviationReference {
public:
    /// Keeps what it needs of the mesh. Throws Error: InvalidArgument, RaysUnavailable, Cancelled.
    DeviationReference(const Mesh& finest, const DeviationOptions& options, const Job& job = {});

    /// Same bits on any number of threads. Where one of the two meshes has nothing to measure to,
    /// both numbers are the diameter of the other's bounding sphere; two empty ones agree. May be
    /// called from any thread.
    Deviation of(const Mesh& stand_in, const Job& job = {}) const;

    /// How many visible points and vertices of the finest there are.
    size_t visible_points() const { return visible_.size(); }

    /// A point and its share of a direction's weight.
    struct Sample {
        glm::dvec3 point;
        double weight;
    };

private:
    DeviationOptions options_;
    ray::Scene scene_;
    std::vector<Sample> visible_;  // neighbors in the list are mostly neighbors in space
    double diameter_ = 0;
};

}  // namespace lodestone::measure
