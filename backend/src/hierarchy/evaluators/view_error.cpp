// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/evaluators/view_error.h"

#include "hierarchy/evaluators/traced_candidate.h"

#include <algorithm>

namespace lodestone::hierarchy {
namespace {

double tolerated(const StandInCandidate& candidate) {
    return kFartherInView * candidate.error;
}

/// Points and corners all over two surfaces tell how far off anything is, if not how much of a
/// picture that is; pictures do not tell it at all.
bool may_be_farther(const StandInCandidate& candidate) {
    return candidate.state == CandidateState::Pictured ||
           candidate.max_error > tolerated(candidate);
}

/// Whatever was left out of a group's meshes as hidden has no such points.
bool needs_view(const StandInCandidate& candidate, const MeasuredFinest& finest) {
    return (finest.options.group && candidate.kind == Kind::Mesh) || may_be_farther(candidate);
}

/// Whether no point of either can be farther than that from the other, wherever it is: then nobody
/// has to look.
bool surely_within(double distance, const Mesh& mesh, const ray::MeshScene& scene,
                   const MeasuredFinest& finest) {
    return !scene.see_through() && !finest.scene().see_through() &&
           measure::farthest_apart(finest.mesh, mesh) <= distance &&
           measure::farthest_apart(mesh, finest.mesh) <= distance;
}

}  // namespace

void count_views(StandInCandidate& candidate, const Mesh& mesh, const ray::MeshScene& scene,
                 const MeasuredFinest& finest, const Job& job) {
    candidate.viewed = true;
    if (!needs_view(candidate, finest))
        return;
    const double child_error = finest.options.child_error;
    const double most = tolerated(candidate);
    if (surely_within(most - child_error, mesh, scene, finest))
        return;
    const auto ways =
        may_be_farther(candidate) ? measure::ViewedWay::Both : measure::ViewedWay::ToStandIn;
    const double seen = finest.views->worst(scene, ways, most - child_error, job) + child_error;
    if (seen <= most)
        return;
    candidate.error = candidate.seen = seen;
    candidate.max_error = std::max(candidate.max_error, seen);
}

void count_views(StandInCandidate& candidate, const MeasuredFinest& finest, const Job& job) {
    candidate.viewed = true;
    if (!needs_view(candidate, finest))
        return;
    Mesh solid;
    const Mesh& mesh = traced_mesh(candidate, solid);
    count_views(candidate, mesh, ray::MeshScene(mesh, skin_of(candidate, finest)), finest, job);
}

}  // namespace lodestone::hierarchy
