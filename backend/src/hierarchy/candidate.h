// SPDX-License-Identifier: GPL-3.0-or-later
// StandInCandidate: a stand-in on its way into the model, and what it costs.
#pragma once

#include "model/model.h"

#include <memory>
#include <vector>

namespace lodestone::hierarchy {

/// How far the way of a candidate into the model has come, and so what its error is.
enum class CandidateState : uint8_t {
    Unproven,  // The error is a distance: nobody has looked whether as much is shown.
    Measured,  // The error is a distance, or that of patches, if that is larger.
    Matched,  // As Measured, made as bright as the finest, and no nearer than gaps in pictures say.
    Pictured,  // The error is that of pictures, in which it was made as bright as the finest.
    Sealed,    // The last step, from any state but the first: RepresentationSummary::sealed.
};

/// Whether a candidate in the state `from` may come to `to` next. Nothing goes back: what is made
/// of a candidate is another one, and begins anew.
bool may_follow(CandidateState from, CandidateState to);

/// A stand-in whose materials are its own until it is added.
struct StandInCandidate {
    Kind kind = Kind::Mesh;
    double error = 0;
    double max_error = 0;
    /// Two of the things that the error of a mesh is the largest of, metres: how far its looks were
    /// moved, and what is seen from the worst side (0: no more than all else says).
    double moved = 0;
    double seen = 0;
    /// The error is that or more: measuring stopped where it was of no use any more.
    bool at_least = false;
    Payload payload;
    std::shared_ptr<const SurfaceLevel> surface;  // as Representation::surface
    std::vector<Material> materials;              // by slot
    MaterialMeans means;                          // of the last of them
    double clear_area = 0;                        // of a mesh's boxes that stand for what is thin
    CandidateState state = CandidateState::Measured;
    /// Solids that are matched in area and centroid, but by few rays: settle() uses more. No state:
    /// solids in all states may be so, those that stay are settled once, and nothing depends on it.
    bool by_few_rays = false;
    /// It was looked at from all sides (evaluators/view_error.h). No state: in each it is so once.
    bool viewed = false;

    /// Each throws Error(Internal) where it is another kind's.
    const Mesh& mesh() const { return held<Mesh>(kind, payload, "mesh"); }
    const Primitive& primitive() const { return held_primitive(kind, payload); }
    const Composite& composite() const { return held<Composite>(kind, payload, "composite"); }
};

/// Brings a candidate to its next state. Throws Error: Internal, where may_follow() says no.
void come_to(StandInCandidate& candidate, CandidateState next);

/// The bytes of one in the renderer's memory.
uint64_t bytes_of(const StandInCandidate& candidate, const CostModel& costs);
/// The time that tracing clear surfaces takes, over opaque ones: the bytes that the renderer reads
/// in that time, for one occurrence where it is used first, as far away that its error is a pixel.
double tracing_of(const StandInCandidate& candidate, const CostModel& costs);
/// The bytes of all its occurrences together, tracing included.
double bytes_of(const StandInCandidate& candidate, uint64_t uses, const CostModel& costs);

/// The cheapest candidate within an error; infinite when there is none.
double bytes_within(const std::vector<StandInCandidate>& candidates, double error, uint64_t uses,
                    const CostModel& costs);

}  // namespace lodestone::hierarchy
