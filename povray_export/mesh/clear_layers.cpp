// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/clear_layers.h"

#include <cmath>

namespace lodestone::povray {

double clear_layers(const Mesh& mesh, const std::function<bool(size_t)>& counts) {
    double area = 0;
    Box3 box;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (!counts(i))
            continue;
        const double twice = glm::length(area_vector(mesh, i));
        if (!(twice > 0) || !std::isfinite(twice))
            continue;
        area += twice / 2;
        for (int k = 0; k < 3; ++k)
            box.add(glm::dvec3(mesh.positions[mesh.triangles[i][k]]));
    }
    if (box.empty())
        return 0;
    // A line that meets a convex body meets surfaces inside of it 2 area / surface times.
    const glm::dvec3 size = box.size();
    const double surface = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
    return surface > 0 ? 2 * area / surface : 0;
}

}  // namespace lodestone::povray
