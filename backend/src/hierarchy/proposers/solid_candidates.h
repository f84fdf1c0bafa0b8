// SPDX-License-Identifier: GPL-3.0-or-later
// Solid candidates: pruned meshes, primitives and composites of one mesh.
#pragma once

#include "hierarchy/build_settings.h"
#include "hierarchy/candidate.h"
#include "hierarchy/evaluators/picture_error.h"
#include "hierarchy/finest.h"
#include "prune/part_pruning.h"

#include <functional>

namespace lodestone::hierarchy {

/// Where collapsing keeps a fifth of the triangles near the surface, parts are details of it.
inline constexpr double kCollapsed = 0.2;
inline constexpr double kNear = 1.0 / 8;  // over the radius
/// A composite of eight is off by a fifth of the radius, more or less.
inline constexpr double kOff = 0.2;

/// Triangles of a mesh that costs so many bytes for each of its occurrences.
size_t triangles_for(double bytes, uint64_t uses);

/// What replacements must be better than.
struct ReplacedObject {
    Bound bound;
    uint64_t uses = 1;
    double bytes = 0;     // as one mesh
    double most = 0;      // bytes of an occurrence that are no use any more
    bool many = false;    // its parts are objects
    bool ground = false;  // some of it is: no solid stands for that
    /// The error from which on its parts cost less than so many bytes; empty: never.
    std::function<double(double bytes)> cheaper_from = {};
};

/// Of what is no environment. All that is given must last.
class SolidCandidates {
public:
    /// Measures what costs little: a box and an ellipsoid, by distance, where that tells enough.
    SolidCandidates(const Mesh& mesh, const std::function<prune::Crowd()>& crowd_in_mesh,
                    const ReplacedObject& whole, const MeasuredFinest& finest,
                    FinestPictures& pictures, const Job& job);

    /// The error of the nearest of them, which cost less than any level; infinite without one.
    double nearest_solid() const;
    /// Pruned levels, primitives and composites, where they promise more than the levels, which
    /// `candidates` has.
    void add(std::vector<StandInCandidate>& candidates, double level_ratio, const Job& job);

private:
    const Mesh& mesh_;
    const ReplacedObject& whole_;
    const MeasuredFinest& finest_;
    FinestPictures& pictures_;
    prune::Crowd crowd_;
    bool by_pictures_ = false;  // whatever the levels are like
    std::vector<StandInCandidate> solids_;
};

}  // namespace lodestone::hierarchy
