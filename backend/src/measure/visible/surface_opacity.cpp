// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/visible/surface_opacity.h"

#include "base/random.h"
#include "measure/visible/convex_bound.h"
#include "measure/visible/sobol_points.h"

#include <cmath>

namespace lodestone::measure {

double mean_opacity(const Mesh& mesh, const ray::MeshSkin& skin, uint64_t seed) {
    // Points that opacity is a mean of.
    // Taste: a larger value knows patterns better; this one knows half coverage to 0.8 %.
    constexpr int kPoints = 4096;
    if (!skin.transmits() && !skin.see_through(mesh))
        return 1;
    std::vector<double> areas(mesh.triangles.size(), 0);
    double all = 0;
    for (size_t i = 0; i < areas.size(); ++i) {
        const double area = 0.5 * glm::length(area_vector(mesh, i));
        areas[i] = area > 0 && std::isfinite(area) ? area : 0;
        all += areas[i];
    }
    // The points lie one in each of equal steps along the list of triangles.
    PcgRandom random(scramble(seed), 5);
    double up_to = 0;
    double sum = 0;
    int taken = 0;
    for (size_t i = 0; i < areas.size(); ++i) {
        up_to += areas[i];
        for (; taken < kPoints && (taken + 0.5) * all < up_to * kPoints; ++taken) {
            const double u = random.uniform();
            const double v = random.uniform();
            const glm::dvec2 at = uniform_in_triangle(u, v);
            sum += skin.opacity(mesh, static_cast<uint32_t>(i), at.x, at.y);
        }
    }
    return taken > 0 ? sum / taken : 1;
}

}  // namespace lodestone::measure
