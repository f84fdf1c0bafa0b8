// SPDX-License-Identifier: GPL-3.0-or-later
// Least change: what to do to solids so that together they show what is wanted.
#pragma once

#include "measure/visible/surface_inertia.h"
#include "model/attributes.h"
#include "model/composite.h"

#include <array>
#include <vector>

namespace lodestone::solids {

/// What is missing of what is seen of the whole: shares of the area, radii of gyration, variances
/// over their trace (of their ratios alone, where the size is not asked for).
struct MatchResidual {
    double area = 0;
    glm::dvec3 centroid{0.0};
    glm::dmat3 variances{0.0};
};
MatchResidual match_residual(const measure::SurfaceInertia& now, const Attributes& wanted,
                             bool size);

/// What steps did otherwise than they should have, because solids hide each other: what one unknown
/// does is corrected along each step by what that one was seen to do. Of one composite and one
/// `size`, measured by the same rays.
/// source: Broyden, A class of methods for solving nonlinear simultaneous equations, 1965.
class BroydenCorrection {
public:
    static constexpr size_t kNumbers = 10;  // area, three of the centroid, six of the variances
    using Row = std::array<double, kNumbers>;

    /// Of solids that are `at` now (moves in metres, of which `unit` is one unknown's) and miss so
    /// much. `weight`: by how much each unknown may change.
    void learn(const std::vector<double>& at, double unit, const std::vector<double>& weight,
               const Row& missing);
    /// What each unknown should do from there.
    void expect(const std::vector<Row>& effect) { effect_ = effect; }
    const std::vector<Row>& corrections() const { return corrections_; }

private:
    std::vector<double> at_;
    Row missing_{};
    std::vector<Row> effect_;
    std::vector<Row> corrections_;  // of each unknown
};

/// Moves every solid and stretches it along its own axes, altogether as little as possible, so that
/// what is missing is made up for, were each to hide as much of the others as before: one step of
/// Gauss and Newton of least norm, in ten numbers of the whole and six unknowns of every solid.
/// Where a solid would sink below `floor` it stands there, and the others do more. `each`: what is
/// seen of each. No step is larger than half of a solid or of the radius of gyration.
/// `experience`: of the steps before, or null.
void gauss_newton_step(Composite& composite, const measure::SurfaceInertia& now,
                       const std::vector<measure::SurfaceInertia>& each,
                       const MatchResidual& missing, bool size, double floor,
                       BroydenCorrection* experience = nullptr);

}  // namespace lodestone::solids
