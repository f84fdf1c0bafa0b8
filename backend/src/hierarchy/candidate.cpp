// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/candidate.h"

#include "base/error.h"
#include "solids/solid_replacement.h"

#include <algorithm>
#include <limits>

namespace lodestone::hierarchy {

bool may_follow(CandidateState from, CandidateState to) {
    switch (to) {
        case CandidateState::Unproven:
            return false;
        case CandidateState::Measured:
            return from == CandidateState::Unproven;
        case CandidateState::Matched:
        case CandidateState::Pictured:
            return from == CandidateState::Measured;
        case CandidateState::Sealed:
            return from != CandidateState::Unproven && from != CandidateState::Sealed;
    }
    return false;
}

void come_to(StandInCandidate& candidate, CandidateState next) {
    if (!may_follow(candidate.state, next))
        fail(Status::Internal, "a candidate skips a state or goes back");
    candidate.state = next;
}

uint64_t bytes_of(const StandInCandidate& candidate, const CostModel& costs) {
    switch (candidate.kind) {
        case Kind::Mesh:
            return candidate.mesh->triangles.size() * costs.triangle_bytes;
        case Kind::Composite:
            return candidate.composite->solids.size() * costs.primitive_bytes;
        default:
            return costs.primitive_bytes;
    }
}

double tracing_of(const StandInCandidate& candidate, const CostModel& costs) {
    const auto clear_area = [&](const Primitive& primitive, bool box, uint16_t slot) {
        if (slot >= candidate.materials.size() || !(candidate.error > 0))
            return 0.0;
        const Material& material = candidate.materials[slot];
        if (material.alpha_mode != AlphaMode::Blend || !(material.alpha < 1))
            return 0.0;
        return (box ? solids::box_shell(primitive.half_size)
                    : solids::ellipsoid_shell(primitive.half_size))
            .area;
    };
    double area = 0;
    if (candidate.kind == Kind::Composite) {
        for (const Solid& solid : candidate.composite->solids)
            area += clear_area(solid.primitive, solid.box, solid.slot);
    } else if (candidate.kind != Kind::Mesh) {
        area = clear_area(candidate.primitive, candidate.kind == Kind::Box, 0);
    } else {
        area = candidate.error > 0 ? candidate.clear_area : 0;
    }
    if (!(area > 0))
        return 0;
    // A convex surface shows a quarter of its area from any side, in the mean, and is crossed
    // twice.
    return costs.crossing_bytes * 0.5 * area / (candidate.error * candidate.error);
}

double bytes_of(const StandInCandidate& candidate, uint64_t uses, const CostModel& costs) {
    const auto count = static_cast<double>(std::max<uint64_t>(1, uses));
    return count * (bytes_per_occurrence(candidate.kind, bytes_of(candidate, costs), uses) +
                    tracing_of(candidate, costs));
}

double bytes_within(const std::vector<StandInCandidate>& candidates, double error, uint64_t uses,
                    const CostModel& costs) {
    double out = std::numeric_limits<double>::infinity();
    for (const StandInCandidate& candidate : candidates) {
        if (candidate.error <= error)
            out = std::min(out, bytes_of(candidate, uses, costs));
    }
    return out;
}

}  // namespace lodestone::hierarchy
