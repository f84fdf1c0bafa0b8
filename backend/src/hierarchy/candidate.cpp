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
    return cost_of(candidate.kind, candidate.payload, costs).bytes;
}

double tracing_of(const StandInCandidate& candidate, const CostModel& costs) {
    if (!(candidate.error > 0))
        return 0;
    const auto clear_area = [&](const Solid& solid) {
        if (solid.slot >= candidate.materials.size())
            return 0.0;
        const Material& material = candidate.materials[solid.slot];
        if (material.alpha_mode != AlphaMode::Blend || !(material.alpha < 1))
            return 0.0;
        const glm::dvec3& half_size = solid.primitive.half_size;
        return (solid.box ? solids::box_shell(half_size) : solids::ellipsoid_shell(half_size)).area;
    };
    const double area =
        visit_payload(candidate.kind, candidate.payload,
                      Overloaded{[&](const Mesh&) { return candidate.clear_area; }, clear_area,
                                 [&](const Composite& composite) {
                                     double sum = 0;
                                     for (const Solid& solid : composite.solids)
                                         sum += clear_area(solid);
                                     return sum;
                                 },
                                 [](const Assembly&) { return 0.0; }});
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
