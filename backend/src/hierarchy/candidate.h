// SPDX-License-Identifier: GPL-3.0-or-later
// Candidate: a stand-in on its way into the model, and which of several are worth keeping.
#pragma once

#include "model/model.h"

#include <memory>
#include <vector>

namespace lodestone::hierarchy {

/// Its materials are its own until it is added.
struct StandInCandidate {
    Kind kind = Kind::Mesh;
    double error = 0;
    double max_error = 0;
    std::shared_ptr<const Mesh> mesh;  // of a mesh
    Primitive primitive;               // of a box or ellipsoid
    std::shared_ptr<const Composite> composite;
    std::vector<Material> materials;  // by slot
    double clear_area = 0;            // of a mesh: of clear boxes that stand for what is thin
    bool pictured = false;            // compared by pictures, and as bright as they are
    bool matched = false;             // likewise, but its error is a distance, if that is larger
    bool sealed = false;              // as RepresentationSummary's
    bool unproven = false;   // nobody has looked yet whether it shows as much as the finest
    bool unsettled = false;  // solids that are matched in area and centroid, but by few rays
};

/// In POV-Ray's memory, of one.
uint64_t bytes_of(const StandInCandidate& candidate);
/// What tracing clear surfaces takes, over opaque ones: the bytes that POV-Ray reads in that time,
/// of one occurrence where it is used first, as far away that its error is a pixel. Measured
/// (POV-Ray 3.7, trees, hedges and fences of 4 to 32 clear solids): each surface that a sample
/// crosses takes 1.7 to 2.4 microseconds, mostly of shadow rays, a byte of a mesh 15 ns to read.
double tracing_of(const StandInCandidate& candidate);
/// Of all its occurrences together, tracing included.
double bytes_of(const StandInCandidate& candidate, uint64_t uses);

/// The cheapest candidate within an error; infinite when there is none.
double bytes_within(const std::vector<StandInCandidate>& candidates, double error, uint64_t uses);

/// Sorts by cost and drops every candidate that is no better than a cheaper one (Pareto front of
/// bytes and error), and those that cost no less than `finest_bytes`; with so many occurrences.
void keep_pareto_front(std::vector<StandInCandidate>& candidates, uint64_t finest_bytes,
                       uint64_t uses = 1);

}  // namespace lodestone::hierarchy
