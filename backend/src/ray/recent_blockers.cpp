// SPDX-License-Identifier: GPL-3.0-or-later
#include "ray/recent_blockers.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace lodestone::ray {

void RecentBlockers::add(const std::array<glm::vec3, 3>& corners) {
    // The share of the longest edge by which a ray must pass an edge.
    // Taste: some fifty times rounding; a larger value tells fewer blockers, none wrongly.
    constexpr float kSlack = 1e-5f;
    PlueckerTriangles& four = fours_[next_ / 4];
    const size_t lane = next_ % 4;
    next_ = (next_ + 1) % (4 * kFours);
    const auto put = [&](std::array<Four, 3>& to, const glm::vec3& value) {
        for (int axis = 0; axis < 3; ++axis)
            to[static_cast<size_t>(axis)][lane] = value[axis];
    };
    float longest = 0;
    for (size_t i = 0; i < 3; ++i) {
        const glm::vec3& from = corners[i];
        const glm::vec3 edge = corners[(i + 1) % 3] - from;
        longest = std::max(longest, glm::length(edge));
        put(four.edges[i], edge);
        put(four.moments[i], glm::cross(edge, from));
    }
    const glm::vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    put(four.normal, normal);
    four.height[lane] = glm::dot(normal, corners[0]);
    four.slack[lane] = kSlack * longest;
}

bool RecentBlockers::block(const glm::vec3& origin, const glm::vec3& direction) const {
    const glm::vec3 moment = glm::cross(origin, direction);
    const auto dot = [](const std::array<Four, 3>& a, const glm::vec3& b) {
        return a[0] * b.x + a[1] * b.y + a[2] * b.z;
    };
    decltype(Four{} < Four{}) found{};
    for (const PlueckerTriangles& four : fours_) {
        // The triangle is ahead where the ray passes all edges on one side: that of the front, or
        // of the back.
        const Four below = four.height - dot(four.normal, origin);
        auto front = below < -four.slack;
        auto back = below > four.slack;
        for (size_t i = 0; i < 3; ++i) {
            const Four side = dot(four.moments[i], direction) - dot(four.edges[i], moment);
            front &= side > four.slack;
            back &= side < -four.slack;
        }
        found |= front | back;
    }
    std::array<uint64_t, 2> bits{};
    std::memcpy(bits.data(), &found, sizeof bits);
    return (bits[0] | bits[1]) != 0;
}

}  // namespace lodestone::ray
