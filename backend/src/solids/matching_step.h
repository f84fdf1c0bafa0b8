// SPDX-License-Identifier: GPL-3.0-or-later
// Matching step: the least change of solids that makes them together show what is wanted.
#pragma once

#include "measure/visible/surface_inertia.h"
#include "model/attributes.h"
#include "model/composite.h"

#include <array>
#include <vector>

namespace lodestone::solids {

/// The differences that the visible whole still has, as shares of the area, radii of gyration, and
/// variances over their trace (only their ratios, where the size is not asked for).
struct MatchResidual {
    double area = 0;
    glm::dvec3 centroid{0.0};
    glm::dmat3 variances{0.0};
};
MatchResidual match_residual(const measure::SurfaceInertia& now, const Attributes& wanted,
                             bool size);

/// The differences between what steps did and what was expected, because solids hide each other:
/// the effect of one unknown is corrected along each step by what was observed. For one composite
/// and one `size`, measured by the same rays. source: Broyden, A class of methods for solving
/// nonlinear simultaneous equations, 1965.
class BroydenCorrection {
public:
    /// The numbers of the whole that are matched.
    /// Law: the area, three of the centroid, six of the variances.
    static constexpr size_t kNumbers = 10;
    using Row = std::array<double, kNumbers>;

    /// Learns from solids that are `at` now (moves in metres, `unit` metres for one unknown) and
    /// still have these differences. `weight`: by how much each unknown may change.
    void learn(const std::vector<double>& at, double unit, const std::vector<double>& weight,
               const Row& missing);
    /// Sets the expected effect of each unknown from there.
    void expect(const std::vector<Row>& effect) { effect_ = effect; }
    const std::vector<Row>& corrections() const { return corrections_; }

private:
    std::vector<double> at_;
    Row missing_{};
    std::vector<Row> effect_;
    std::vector<Row> corrections_;  // by unknown
};

/// Moves every solid and stretches it along its own axes, altogether as little as possible, so that
/// the differences vanish if each solid hides as much of the others as before. This is one
/// Gauss-Newton step of least norm, in ten numbers of the whole and six unknowns of every solid.
/// Where a solid would sink below `floor` it stands there, and the others do more. `each`: the
/// visible part of each. No step is larger than half of a solid or of the radius of gyration.
/// `experience`: that of the steps before, or null.
void gauss_newton_step(Composite& composite, const measure::SurfaceInertia& now,
                       const std::vector<measure::SurfaceInertia>& each,
                       const MatchResidual& missing, bool size, double floor,
                       BroydenCorrection* experience = nullptr);

}  // namespace lodestone::solids
