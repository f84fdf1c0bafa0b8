// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/proposers.h"

#include "hierarchy/proposers/composite_solids.h"
#include "hierarchy/proposers/environment_stand_ins.h"
#include "hierarchy/proposers/masked_cards.h"
#include "hierarchy/proposers/measured_levels.h"
#include "hierarchy/proposers/painted_boxes.h"
#include "hierarchy/proposers/primitive_solids.h"
#include "hierarchy/proposers/pruned_levels.h"
#include "hierarchy/proposers/widened_levels.h"

namespace lodestone::hierarchy {
namespace {

// Each sees what those above it found out: a level is measured only where it may be nearer than the
// solids above it, parts are pruned where levels cost too much and until cards are nearer,
// composites are made where nothing above them is as good.
constexpr StandInProposer kProposers[] = {
    {"near solids", ProposalStage::All, propose_near_solids},
    {"collapse", ProposalStage::All, propose_levels},
    {"cards", ProposalStage::All, propose_cards},
    {"prune", ProposalStage::All, propose_pruned_levels},
    {"painted boxes", ProposalStage::All, propose_painted_boxes},
    {"solids", ProposalStage::All, propose_primitives},
    {"composites", ProposalStage::All, propose_composites},
    {"environment", ProposalStage::All, propose_environment_stand_ins},
    {"widen", ProposalStage::Kept, propose_widened_levels},
};

}  // namespace

std::span<const StandInProposer> stand_in_proposers() {
    return kProposers;
}

void propose(ProposalStage stage, ProposalRound& round) {
    for (const StandInProposer& proposer : kProposers) {
        if (proposer.stage == stage)
            proposer.propose(round);
    }
}

}  // namespace lodestone::hierarchy
