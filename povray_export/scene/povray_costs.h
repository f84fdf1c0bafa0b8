// SPDX-License-Identifier: GPL-3.0-or-later
// POV-Ray's costs: what drawing takes of its memory and time.
#pragma once

#include "model/cost_model.h"

namespace lodestone::povray {

/// The costs of POV-Ray 3.7 on one machine, the only place where its numbers stand.
CostModel povray_costs();

}  // namespace lodestone::povray
