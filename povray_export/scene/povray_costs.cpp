// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene/povray_costs.h"

namespace lodestone::povray {

CostModel povray_costs() {
    CostModel costs;
    // Fitted: to the peak memory of POV-Ray 3.7 for meshes, primitives and placed objects.
    costs.triangle_bytes = 245;
    costs.primitive_bytes = 1500;
    costs.occurrence_bytes = 1500;
    // Fitted: to trees, hedges and fences of 4 to 32 clear solids. Each surface that a sample
    // crosses takes 1.7 to 2.4 microseconds, mostly of shadow rays, a byte of a mesh 15 ns to read.
    costs.crossing_bytes = 150;
    // Fitted: to the sample scenes. They decide what is built first and need not be right by more
    // than a factor of two.
    costs.triangle_s = 2e-6;
    costs.occurrence_s = 2e-5;
    costs.pixel_s = 1e-5;
    costs.start_s = 0.2;
    return costs;
}

}  // namespace lodestone::povray
