// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/placement_grades.h"

#include <algorithm>
#include <cmath>

namespace lodestone::povray {

std::vector<PlacementShade> graded(const std::vector<PlacementShade>& shades) {
    // The step of square roots of shares below which placements share a grade.
    // Taste: a larger value saves copies of meshes.
    constexpr double kGradeStep = 0.1;
    double low = 1;
    double high = 0;
    for (const PlacementShade& shade : shades) {
        low = std::min(low, std::sqrt(shade.share));
        high = std::max(high, std::sqrt(shade.share));
    }
    const int count =
        std::clamp(static_cast<int>(std::ceil((high - low) / kGradeStep)), 1, kPlacementGrades);
    const auto grade_of = [&](const PlacementShade& shade) {
        const double place = high > low ? (std::sqrt(shade.share) - low) / (high - low) : 0;
        return static_cast<size_t>(std::clamp(static_cast<int>(place * count), 0, count - 1));
    };
    std::vector<PlacementShade> means(static_cast<size_t>(count), PlacementShade{0, 0, {}});
    std::vector<double> members(static_cast<size_t>(count), 0);
    for (const PlacementShade& shade : shades) {
        PlacementShade& mean = means[grade_of(shade)];
        mean.share += shade.share;
        mean.middle += shade.middle;
        mean.slope += shade.slope;
        members[grade_of(shade)] += 1;
    }
    for (size_t i = 0; i < means.size(); ++i) {
        const double divisor = std::max(members[i], 1.0);
        means[i].share /= divisor;
        means[i].middle /= divisor;
        means[i].slope /= divisor;
    }
    std::vector<PlacementShade> out;
    out.reserve(shades.size());
    for (const PlacementShade& shade : shades)
        out.push_back(means[grade_of(shade)]);
    return out;
}

}  // namespace lodestone::povray
