// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/placement_grades.h"

#include <algorithm>
#include <cmath>

namespace lodestone::povray {

std::vector<double> graded(const std::vector<double>& shares) {
    // The step of square roots of shares below which placements share a grade.
    // Taste: a larger value saves copies of meshes.
    constexpr double kGradeStep = 0.1;
    double low = 1;
    double high = 0;
    for (const double share : shares) {
        low = std::min(low, std::sqrt(share));
        high = std::max(high, std::sqrt(share));
    }
    const int count =
        std::clamp(static_cast<int>(std::ceil((high - low) / kGradeStep)), 1, kPlacementGrades);
    const auto grade_of = [&](double share) {
        const double place = high > low ? (std::sqrt(share) - low) / (high - low) : 0;
        return static_cast<size_t>(std::clamp(static_cast<int>(place * count), 0, count - 1));
    };
    std::vector<double> sums(static_cast<size_t>(count), 0);
    std::vector<double> members(static_cast<size_t>(count), 0);
    for (const double share : shares) {
        sums[grade_of(share)] += share;
        members[grade_of(share)] += 1;
    }
    std::vector<double> out;
    out.reserve(shares.size());
    for (const double share : shares)
        out.push_back(sums[grade_of(share)] / members[grade_of(share)]);
    return out;
}

}  // namespace lodestone::povray
