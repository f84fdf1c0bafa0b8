// SPDX-License-Identifier: GPL-3.0-or-later
#include "solids/widened_boxes.h"

#include "solids/keep_on_floor.h"

#include <algorithm>
#include <limits>

namespace lodestone::solids {

double ThinPart::thickness() const {
    return 2 * std::max(box.half_size.y, box.half_size.z);
}

std::optional<ThinPart> find_thin_part(const Mesh& part, const Attributes& attributes) {
    // The least length over the thickness.
    // Taste: a smaller one widens parts whose ends are seen.
    constexpr double kLongest = 12;
    const std::optional<ClearSolid> shell = shell_box(attributes);
    if (!shell)
        return std::nullopt;
    ThinPart out{shell->primitive, attributes.visible_area};
    // The variances are those of a box as thick all along; the ends are the part's own.
    const glm::dvec3 along = out.box.axes[0];
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const glm::vec3& position : part.positions) {
        const double at = glm::dot(glm::dvec3(position) - out.box.center, along);
        low = std::min(low, at);
        high = std::max(high, at);
    }
    out.box.center += 0.5 * (low + high) * along;
    out.box.half_size.x = 0.5 * (high - low);
    const double thickness = out.thickness();
    if (!(thickness > 0 && 2 * out.box.half_size.x >= kLongest * thickness))
        return std::nullopt;
    return out;
}

ClearSolid widened_box(const ThinPart& thin, double width, double floor) {
    ClearSolid out{thin.box, 1};
    out.primitive.half_size.y = out.primitive.half_size.z = 0.5 * width;
    out.primitive = kept_above(out.primitive, true, floor);
    out.opacity = std::min(1.0, thin.visible_area / box_shell(out.primitive.half_size).area);
    return out;
}

}  // namespace lodestone::solids
