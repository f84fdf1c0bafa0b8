// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/plane_ranges.h"

#include <algorithm>

namespace lodestone::povray {

PlaneBox box_of(const glm::dvec2 (&at)[3]) {
    return {{std::min({at[0].x, at[1].x, at[2].x}), std::min({at[0].y, at[1].y, at[2].y})},
            {std::max({at[0].x, at[1].x, at[2].x}), std::max({at[0].y, at[1].y, at[2].y})}};
}

PlaneRange range_between(const glm::dvec2 (&at)[3], double bottom, double top) {
    PlaneRange out;
    const auto add = [&](double x) {
        out.low = std::min(out.low, x);
        out.high = std::max(out.high, x);
    };
    for (int k = 0; k < 3; ++k) {
        const glm::dvec2& a = at[k];
        const glm::dvec2& b = at[(k + 1) % 3];
        if (a.y >= bottom && a.y <= top)
            add(a.x);
        for (const double y : {top, bottom}) {
            if ((a.y < y) != (b.y < y))
                add(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
        }
    }
    return out;
}

PlaneRange range_inside(const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2 (&at)[3]) {
    PlaneRange out{0, 1};
    for (int k = 0; k < 3; ++k) {
        const glm::dvec2 side = at[(k + 1) % 3] - at[k];
        const auto left = [&](const glm::dvec2& p) {
            return side.x * (p.y - at[k].y) - side.y * (p.x - at[k].x);
        };
        const double a = left(from);
        const double b = left(to);
        if (a < 0 && b < 0)
            return {};
        if (a < 0)
            out.low = std::max(out.low, a / (a - b));
        else if (b < 0)
            out.high = std::min(out.high, a / (a - b));
    }
    return out;
}

}  // namespace lodestone::povray
