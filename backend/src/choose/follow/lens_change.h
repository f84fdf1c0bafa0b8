// SPDX-License-Identifier: GPL-3.0-or-later
// Lens change: the nodes of a cut that moved detail lenses affect. Only follow uses it.
#pragma once

#include "choose/cut_chooser.h"

namespace lodestone::choose {

/// The lenses that differ between the two lists, compared place by place, in both their old and
/// their new form. Names are not compared.
std::vector<DetailLens> changed_lenses(const std::vector<DetailLens>& before,
                                       const std::vector<DetailLens>& now);

/// Finds the nodes that one of the changed lenses reaches, rising (`seen`: by CutNode::transform).
/// `field` tells the effect of all lenses of the view there, from which SeenNode::total is set.
/// None of the changed lenses may hide anything. cost: O(nodes) for their parents, and a visit of
/// each node within reach
void refresh_lens_factors(const ChoiceTable& table, const View& view,
                          const std::vector<DetailLens>& changed, FactorField& field,
                          const Cut& cut, std::vector<SeenNode>& seen,
                          std::vector<uint32_t>& reached);

}  // namespace lodestone::choose
