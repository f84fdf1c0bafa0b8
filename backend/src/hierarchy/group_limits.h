// SPDX-License-Identifier: GPL-3.0-or-later
// Group limits: what the stand-ins of a group are made of, and what they must be better than.
#pragma once

#include "hierarchy/flattened_group.h"
#include "hierarchy/proposers/proposal_round.h"

#include <vector>

namespace lodestone::hierarchy {

struct StandInSurroundings;  // hierarchy/run/stand_in_surroundings.h

/// Whether one flat thing lies under most of a group, as a road lies under its markings; a town of
/// many houses is flat too, but in no layers. `layers`: by object (flat_layers.h).
bool lies_on_a_layer(const Model& model, ObjectIndex group, const std::vector<Hash>& layers);

/// The costs of a group's children within rising errors.
class ChildCosts {
public:
    /// The costs are asked for from `error` on, in metres.
    ChildCosts(OpenedGroup& group, double error, const Job& job);

    double bytes() const { return steps_.front().bytes; }
    /// Those of the coarsest children.
    double least() const { return steps_.back().bytes; }
    /// The error from which on they cost no more than `bytes`; a step too large rather than too
    /// small.
    double cheaper_from(double bytes) const;

private:
    struct CostStep {
        double error;
        double bytes;
    };
    std::vector<CostStep> steps_;
};

/// A stand-in that costs more than what the children would use instead is none: parts that many
/// groups share are cheap, one mesh for each of the groups is not. All that is given must last.
class GroupLimits {
public:
    GroupLimits(OpenedGroup& group, const FlattenedGroup& reference, const MeasuredFinest& finest,
                const StandInSurroundings& surroundings, const BuildSettings& settings,
                const Job& job);
    GroupLimits(const GroupLimits&) = delete;
    GroupLimits& operator=(const GroupLimits&) = delete;

    const ProposalLimits& limits() const { return limits_; }
    /// Drops candidates that do not pay beside others and beside the children, and those that are
    /// farther off than the group is large, as long as there is another.
    void keep_useful(std::vector<StandInCandidate>& candidates) const;

private:
    bool pays(double bytes, double error) const;

    OpenedGroup& group_;
    const Job& job_;
    std::vector<uint32_t> occurrence_;  // by triangle of the shell
    Mesh shell_;                        // what of the finest can be seen
    ChildCosts children_;
    size_t first_ = 0;  // triangles of a level that may pay
    ProposalLimits limits_;
};

}  // namespace lodestone::hierarchy
