// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/masked_cards.h"

#include "cards/crossed_cards.h"

#include <algorithm>

namespace lodestone::hierarchy {
namespace {

/// Whether something stands upright, as cards do: no carpet of grass.
bool is_upright(const Bound& bound) {
    // The least height over the width.
    // Taste: a smaller value makes cards of wider bushes, whose sides they show less well.
    constexpr double kLeastHeight = 0.5;
    const glm::dvec3 size = bound.box.size();
    return size.z >= kLeastHeight * std::max(size.x, size.y);
}

/// Groups have none: their children's are shared by all trees of a kind, and are found once.
bool stands_for_masks(const ProposalRound& round) {
    const MeasuredFinest& finest = round.finest;
    return !finest.options.group && is_upright(round.limits.whole.bound) &&
           !finest.options.environment && !round.limits.whole.ground && !finest.refracts() &&
           !finest.glows && !finest.solid() && finest.scene().see_through();
}

}  // namespace

void propose_cards(ProposalRound& round) {
    if (!stands_for_masks(round))
        return;
    const MeasuredFinest& finest = round.finest;
    const cards::CardOptions options{finest.options.seed, cards::CardOptions{}.texels};
    const auto triangles =
        static_cast<double>(cards::kCardTriangles * round.limits.whole.costs.triangle_bytes);
    if (cards::picture_bytes(finest.mesh, finest.attributes.centroid, options) + triangles >=
        round.limits.whole.bytes)
        return;
    std::optional<cards::CrossedCards> made = cards::crossed_cards(
        finest.mesh, finest.scene(), *finest.skin, finest.attributes, options, round.job);
    if (!made)
        return;
    StandInCandidate candidate;
    candidate.payload = std::make_shared<const Mesh>(made->mesh);
    candidate.materials = {made->material};
    candidate.means = {finest.attributes.shares};
    compare_crowns(candidate, finest, round.pictures, round.job);
    round.candidates.push_back(std::move(candidate));
}

}  // namespace lodestone::hierarchy
