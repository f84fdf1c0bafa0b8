// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/proposal_round.h"

#include <algorithm>

namespace lodestone::hierarchy {

size_t triangles_for(double bytes, uint64_t uses, const CostModel& costs) {
    const double all = bytes * static_cast<double>(std::max<uint64_t>(1, uses));
    return static_cast<size_t>(
        std::clamp(all / static_cast<double>(costs.triangle_bytes), 0.0, 1e9));
}

bool is_foliage(const prune::Crowd& crowd) {
    // Taste: a larger number compares pictures of fewer things.
    constexpr size_t kFewestLeaves = 256;
    // The most triangles of a leaf, in the mean.
    // Taste: a larger number takes things of larger parts for foliage.
    constexpr size_t kTriangles = 8;
    return crowd.parts.size() >= kFewestLeaves &&
           crowd.triangles <= kTriangles * crowd.parts.size();
}

ProposalRound::ProposalRound(const MeasuredFinest& original, FinestPictures& taken,
                             const ProposalLimits& limits_of_it, const Job& asked)
    : finest(original), pictures(taken), limits(limits_of_it), job(asked) {
    // An original that costs less than so many solids is not worth a tenth of a second of pictures.
    // Taste: a larger number compares pictures of fewer things.
    constexpr double kFewSolids = 32;
    const ReplacedObject& whole = limits.whole;
    const double least = kFewSolids * static_cast<double>(whole.costs.primitive_bytes);
    if (finest.options.environment || !(whole.bytes > least) || finest.refracts())
        return;
    if (limits.find_crowd)
        crowd = limits.find_crowd();
    by_pictures = !finest.solid() || (!crowd.empty() && (whole.many || is_foliage(crowd)));
}

}  // namespace lodestone::hierarchy
