// SPDX-License-Identifier: GPL-3.0-or-later
// Lens change: what of a cut is seen otherwise when detail lenses move. Inside of step.
#pragma once

#include "choose/cut_chooser.h"

namespace lodestone::choose {

/// Those of both that are not the same, place by place, as they were and as they are; names do not
/// count.
std::vector<DetailLens> changed_lenses(const std::vector<DetailLens>& before,
                                       const std::vector<DetailLens>& now);

/// Nodes that one of the changed lenses reaches, rising (`seen`: by Node::transform); `field` tells
/// what all lenses of the view now do there, and so their SeenNode::total becomes. None of the changed
/// ones may hide anything. cost: O(nodes) for their parents, and a look at each within reach
void refresh_lens_factors(const ChoiceTable& table, const View& view,
                          const std::vector<DetailLens>& changed, FactorField& field,
                          const Cut& cut, std::vector<SeenNode>& seen,
                          std::vector<uint32_t>& reached);

}  // namespace lodestone::choose
