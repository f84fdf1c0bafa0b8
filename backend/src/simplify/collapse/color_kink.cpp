// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse/color_kink.h"

#include "simplify/collapse/edge_neighbors.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::simplify {

double color_kink(const CollapseMesh& mesh, const Triangle& t0, const Triangle& w0,
                  const Triangle& t1, const Triangle& w1, uint32_t a, uint32_t b) {
    bool one = true;  // in color: no kink
    for (int corner = 0; corner < 3; ++corner)
        one = one && mesh.colors[w0[corner]] == mesh.colors[w0.x] &&
              mesh.colors[w1[corner]] == mesh.colors[w0.x];
    if (one)
        return 0;
    const auto color = [&](uint32_t wedge) {
        return glm::sqrt(glm::clamp(mesh.colors[wedge], 0.0f, 1.0f));
    };
    const glm::dvec3 edge = mesh.points[b] - mesh.points[a];
    const double square = glm::dot(edge, edge);
    if (!(square > 0))
        return 0;
    glm::vec4 slopes[2];
    double heights[2] = {0, 0};
    for (int side = 0; side < 2; ++side) {
        const Triangle& t = side == 0 ? t0 : t1;
        const Triangle& w = side == 0 ? w0 : w1;
        const int at_a = corner_of(t, a);
        const int at_b = corner_of(t, b);
        const int opposite = 3 - at_a - at_b;
        const glm::dvec3 arm = mesh.points[t[opposite]] - mesh.points[a];
        const double along = glm::dot(arm, edge) / square;
        heights[side] = glm::length(arm - along * edge);
        const auto s = static_cast<float>(along);
        slopes[side] = color(w[opposite]) - (1 - s) * color(w[at_a]) - s * color(w[at_b]);
    }
    const double least = std::min(heights[0], heights[1]);
    if (!(least > 1e-9 * std::sqrt(square)))
        return 0;
    const glm::vec4 kink = glm::abs(slopes[0] * static_cast<float>(least / heights[0]) +
                                    slopes[1] * static_cast<float>(least / heights[1]));
    return std::min(1.0, static_cast<double>(std::max({kink.x, kink.y, kink.z, kink.w})));
}

}  // namespace lodestone::simplify
