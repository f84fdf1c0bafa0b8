// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/doubled_triangles.h"

#include "base/hash.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <unordered_map>

namespace lodestone::povray {
namespace {

/// The corners of a triangle by their positions, the first one least.
std::array<uint32_t, 3> ordered(const Mesh& mesh, uint32_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    std::array<uint32_t, 3> corners{t.x, t.y, t.z};
    std::sort(corners.begin(), corners.end(), [&](uint32_t a, uint32_t b) {
        const glm::vec3& p = mesh.positions[a];
        const glm::vec3& q = mesh.positions[b];
        return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    });
    return corners;
}

}  // namespace

std::optional<std::vector<uint32_t>> take_doubles(const Mesh& mesh,
                                                  std::vector<uint32_t>& triangles) {
    std::unordered_map<Hash, uint32_t> known;
    std::vector<uint32_t> own;
    std::vector<uint32_t> doubles;
    for (const uint32_t triangle : triangles) {
        const std::array<uint32_t, 3> corners = ordered(mesh, triangle);
        Hasher place;
        for (const uint32_t corner : corners) {
            for (int i = 0; i < 3; ++i)
                place.value(mesh.positions[corner][i] + 0.0f);  // -0 is 0
        }
        const auto [at, fresh] = known.try_emplace(place.result(), triangle);
        if (fresh) {
            own.push_back(triangle);
            continue;
        }
        const std::array<uint32_t, 3> others = ordered(mesh, at->second);
        for (size_t k = 0; k < 3; ++k) {
            if (mesh.uvs[corners[k]] != mesh.uvs[others[k]] ||
                (!mesh.colors.empty() && mesh.colors[corners[k]] != mesh.colors[others[k]]))
                return {};
        }
        doubles.push_back(triangle);
    }
    triangles = std::move(own);
    return doubles;
}

}  // namespace lodestone::povray
