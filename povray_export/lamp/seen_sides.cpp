// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/seen_sides.h"

#include "base/maths.h"
#include "geometry/closest_on_triangle.h"
#include "light/seen/seen_parts.h"
#include "light/sky/sky_shares.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::povray {

namespace {

// The pixels that something seen covers, at least.
// Law: nothing that is seen is nothing.
constexpr double kLeastPixels = 1e-6;

}  // namespace

bool SeenSides::closed(const Mesh& mesh) {
    if (!closed_)
        closed_ = lodestone::closed(mesh);
    return *closed_;
}

void SeenSides::add(const Mesh& mesh, const Affine& world, const Camera& camera, double pixels,
                    std::span<const uint8_t> seen) {
    if (seen.size() != mesh.triangles.size()) {
        seen = {};
        if (closed(mesh))
            return;
    }
    const glm::dmat3 to_own = glm::inverse(world.linear);
    const glm::dvec3 eye = to_own * (camera.position - world.offset);
    const glm::dvec3 toward_eye = -(to_own * camera.direction);
    // The pixels of an area that faces the camera, at distance 1.
    const double pixels_of_area =
        0.5 * pixels / (glm::length(camera.right) * glm::length(camera.up));
    // A volume before it is placed becomes one that is larger by the determinant.
    const double enlarged = std::abs(glm::determinant(world.linear)) * pixels_of_area;
    if (!finite(eye) || !finite(toward_eye) || !std::isfinite(enlarged))
        return;
    fronts_.resize(mesh.triangles.size(), 0);
    sizes_.resize(mesh.triangles.size(), 0);
    for (size_t i = 0; i < fronts_.size(); ++i) {
        if (!seen.empty() && (seen[i] & light::kSeen) == 0)
            continue;
        const Triangle& t = mesh.triangles[i];
        // The closest place: a ground that reaches far is seen largest there.
        const glm::dvec3 at = geometry::closest_on_triangle(eye, glm::dvec3(mesh.positions[t.x]),
                                                            glm::dvec3(mesh.positions[t.y]),
                                                            glm::dvec3(mesh.positions[t.z]))
                                  .point;
        const glm::dvec3 way = camera.orthographic ? toward_eye : eye - at;
        const double side = glm::dot(area_vector(mesh, i), way);
        const double away = camera.orthographic ? 1 : glm::length(world.linear * way);
        const double size =
            limited(enlarged * std::abs(side) / (away * away * away), kLeastPixels, pixels);
        if (side != 0)
            fronts_[i] += static_cast<float>(side > 0 ? size : -size);
        sizes_[i] = std::max(sizes_[i], static_cast<float>(size));
    }
}

bool SeenSides::add_sizes(std::span<uint8_t> seen) const {
    if (seen.empty() || seen.size() != sizes_.size())
        return false;
    for (size_t i = 0; i < seen.size(); ++i) {
        if (seen[i] != 0)
            seen[i] = light::size_byte(static_cast<double>(sizes_[i]));
    }
    return true;
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
