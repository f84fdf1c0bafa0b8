// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse/part_distances.h"

#include "geometry/closest_on_triangle.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace lodestone::simplify {
namespace {

/// The live triangles of a mesh, with all of its points.
Mesh live_triangles(const CollapseMesh& mesh) {
    Mesh out;
    out.positions.assign(mesh.points.begin(), mesh.points.end());
    out.triangles.reserve(mesh.live);
    std::copy_if(mesh.triangles.begin(), mesh.triangles.end(), std::back_inserter(out.triangles),
                 [](const Triangle& t) { return t.x != kNone; });
    return out;
}

double square_to(const Box3& box, const glm::dvec3& place) {
    const glm::dvec3 beyond = box.beyond(place);
    return glm::dot(beyond, beyond);
}

}  // namespace

PartDistances::PartDistances(const CollapseMesh& mesh, std::span<const uint32_t> ranks)
    : live_(live_triangles(mesh)), tree_(live_) {
    uint32_t most = 0;
    ranks_.reserve(live_.triangles.size());
    for (const Triangle& t : live_.triangles) {
        ranks_.push_back(ranks[mesh.parts[t.x]]);
        most = std::max(most, ranks_.back());
    }
    first_.assign(size_t{most} + 2, 0);
    for (const uint32_t rank : ranks_)
        ++first_[size_t{rank} + 1];
    for (size_t i = 1; i < first_.size(); ++i)
        first_[i] += first_[i - 1];
    order_.resize(ranks_.size());
    std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
    for (uint32_t i = 0; i < ranks_.size(); ++i)
        order_[next[ranks_[i]]++] = i;
    highest_.resize(tree_.parts().size());
    for (size_t i = highest_.size(); i-- > 0;) {
        const geometry::MeshPart& part = tree_.parts()[i];
        if (tree_.leaf(i)) {
            for (const uint32_t triangle : tree_.triangles(part))
                highest_[i] = std::max(highest_[i], ranks_[triangle]);
        } else {
            highest_[i] = std::max(highest_[i + 1], highest_[tree_.parts()[i + 1].next]);
        }
    }
}

double PartDistances::farthest(uint32_t rank, double least) const {
    const std::span<const uint32_t> own =
        std::span(order_).subspan(first_[rank], first_[rank + 1] - first_[rank]);
    Box3 box;
    std::array<uint32_t, 6> ends{};  // lowest and highest of each axis
    for (const uint32_t triangle : own) {
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = live_.triangles[triangle][corner];
            const glm::dvec3 at(live_.positions[vertex]);
            for (int axis = 0; axis < 3; ++axis) {
                if (at[axis] < box.low[axis])
                    ends[2 * static_cast<size_t>(axis)] = vertex;
                if (at[axis] > box.high[axis])
                    ends[2 * static_cast<size_t>(axis) + 1] = vertex;
            }
            box.add(at);
        }
    }
    const double most = glm::dot(box.size(), box.size());
    double found = least;
    for (auto end = ends.begin(); end != ends.end() && found < most; ++end) {
        if (std::find(ends.begin(), end, *end) == end)
            found = std::max(found, nearest(live_.positions[*end], rank, {found, most}));
    }
    return std::max(least, std::min(most, found));
}

double PartDistances::nearest(const glm::vec3& place, uint32_t rank, const Limits& limits) const {
    struct TreePart {
        double square;
        uint32_t part;
    };
    const std::vector<geometry::MeshPart>& parts = tree_.parts();
    const glm::dvec3 from(place);
    // Law: each half of a part has half of its triangles, and there are less than 2^32.
    std::array<TreePart, 64> left;
    size_t count = 0;
    geometry::TriangleSpot best;
    best.square = static_cast<float>(limits.most);
    const auto push = [&](const TreePart& half) {
        if (highest_[half.part] > rank && half.square < best.square)
            left[count++] = half;
    };
    push({square_to(parts[0].box, from), 0});
    while (count > 0 && best.square > limits.enough) {
        const TreePart next = left[--count];
        if (next.square >= best.square)
            continue;
        if (!tree_.leaf(next.part)) {
            const uint32_t first = next.part + 1;
            const uint32_t second = parts[first].next;
            TreePart near{square_to(parts[first].box, from), first};
            TreePart far{square_to(parts[second].box, from), second};
            if (far.square < near.square)
                std::swap(near, far);
            push(far);
            push(near);
            continue;
        }
        std::array<uint32_t, geometry::PartTree::kFewTogether> stay;
        size_t few = 0;
        for (const uint32_t triangle : tree_.triangles(parts[next.part])) {
            if (ranks_[triangle] > rank)
                stay[few++] = triangle;
        }
        const auto corners_of = [&](uint32_t triangle) {
            const Triangle& t = live_.triangles[triangle];
            return geometry::TrianglePoints{live_.positions[t.x], live_.positions[t.y],
                                            live_.positions[t.z]};
        };
        geometry::nearest_of_triangles(std::span<const uint32_t>(stay.data(), few), place,
                                       corners_of, best);
    }
    return static_cast<double>(best.square);
}

}  // namespace lodestone::simplify
