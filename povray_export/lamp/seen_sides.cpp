// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/seen_sides.h"

#include "light/seen/seen_parts.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::povray {

bool SeenSides::closed(const Mesh& mesh) {
    if (!closed_)
        closed_ = lodestone::closed(mesh);
    return *closed_;
}

void SeenSides::add(const Mesh& mesh, const Affine& world, const Bound& bound, const Camera& camera,
                    std::span<const uint8_t> seen) {
    if (seen.size() != mesh.triangles.size()) {
        seen = {};
        if (closed(mesh))
            return;
    }
    const glm::dmat3 to_own = glm::inverse(world.linear);
    const glm::dvec3 eye = to_own * (camera.position - world.offset);
    const glm::dvec3 toward_eye = -(to_own * camera.direction);
    const double away = std::max(glm::length(camera.position - bound.box.center()), bound.radius);
    const double size = camera.orthographic ? bound.radius : bound.radius / away;
    if (!finite(eye) || !finite(toward_eye) || !(size > 0) || !std::isfinite(size))
        return;
    fronts_.resize(mesh.triangles.size(), 0);
    for (size_t i = 0; i < fronts_.size(); ++i) {
        if (!seen.empty() && (seen[i] & light::kSeen) == 0)
            continue;
        const glm::dvec3 at(mesh.positions[mesh.triangles[i].x]);
        const double side =
            glm::dot(area_vector(mesh, i), camera.orthographic ? toward_eye : eye - at);
        if (side != 0)
            fronts_[i] += static_cast<float>(side > 0 ? size * size : -size * size);
    }
}

std::vector<uint8_t> SeenSides::behind() const {
    std::vector<uint8_t> out(fronts_.size());
    std::transform(fronts_.begin(), fronts_.end(), out.begin(),
                   [](float front) { return front < 0 ? 1 : 0; });
    if (std::find(out.begin(), out.end(), 1) == out.end())
        out.clear();
    return out;
}

}  // namespace lodestone::povray
