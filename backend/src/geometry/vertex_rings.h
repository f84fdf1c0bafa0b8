// SPDX-License-Identifier: GPL-3.0-or-later
// Vertex rings: the triangles around every vertex, and the nearest of them found by walking.
#pragma once

#include "model/mesh.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>

namespace lodestone::geometry {

/// The triangles by a number of their corners: the vertex, or a number that several vertices share.
class VertexRings {
public:
    VertexRings() = default;
    template <typename NumberOf>
    VertexRings(std::span<const Triangle> all, size_t numbers, const NumberOf& number_of)
        : first_(numbers + 2, 0), triangles_(3 * all.size()) {
        for (const Triangle& t : all) {
            for (int corner = 0; corner < 3; ++corner)
                ++first_[number_of(t[corner]) + 2];
        }
        for (size_t i = 2; i < first_.size(); ++i)
            first_[i] += first_[i - 1];
        for (uint32_t i = 0; i < all.size(); ++i) {
            for (int corner = 0; corner < 3; ++corner)
                triangles_[first_[number_of(all[i][corner]) + 1]++] = i;
        }
    }

    /// The triangles around a vertex, ascending.
    std::span<const uint32_t> around(uint32_t number) const {
        return {triangles_.data() + first_[number], triangles_.data() + first_[number + 1]};
    }

    /// At most kMost of them, for callers that visit every vertex: hubs have thousands.
    std::span<const uint32_t> some_around(uint32_t number) const {
        /// Taste: more find nearer triangles at hubs, more slowly.
        constexpr size_t kMost = 64;
        const std::span<const uint32_t> all = around(number);
        return all.first(std::min(all.size(), kMost));
    }

private:
    std::vector<uint32_t> first_;
    std::vector<uint32_t> triangles_;
};

/// Searches for the nearest point of some triangles; among equally near ones the lowest. Triangles
/// with corners that are not numbers are ignored.
class NearestWalk {
public:
    static constexpr uint32_t kNone = ~uint32_t{0};

    NearestWalk(const std::vector<glm::vec3>& points, std::span<const Triangle> triangles,
                const glm::dvec3& from)
        : points_(points), triangles_(triangles), from_(from) {
        recent_.fill(kNone);
    }

    /// True when the triangle is the nearest so far.
    bool visit(uint32_t index);

    /// Visits the triangles around the corner of a triangle that has the fewest around it: the
    /// triangle itself, or the one it has become where its polygon is cut another way.
    template <typename NumberOf>
    void start(const VertexRings& rings, const NumberOf& number_of, const Triangle& corners) {
        std::span<const uint32_t> least = rings.some_around(number_of(corners.x));
        for (const uint32_t corner : {corners.y, corners.z}) {
            const std::span<const uint32_t> around = rings.some_around(number_of(corner));
            if (around.size() < least.size())
                least = around;
        }
        for (const uint32_t near : least)
            visit(near);
    }

    /// Goes on from the nearest so far to neighbors that are nearer, at most `steps` times: first
    /// along vertices, which is fast, then along triangles. `number_of`: gives the number of a
    /// vertex in the rings.
    template <typename NumberOf>
    void walk(const VertexRings& rings, const NumberOf& number_of, int steps) {
        if (triangle_ == kNone)
            return;
        const uint32_t start = triangles_[triangle_].x;
        uint32_t vertex = start;
        double least = square_to(vertex);
        for (uint32_t at = kNone; steps > 0 && vertex != at; --steps) {
            at = vertex;
            for (const uint32_t near : rings.some_around(number_of(at))) {
                for (int corner = 0; corner < 3; ++corner) {
                    const uint32_t next = triangles_[near][corner];
                    const double square = square_to(next);
                    if (square < least) {
                        least = square;
                        vertex = next;
                    }
                }
            }
        }
        if (vertex != start)
            visit(rings.around(number_of(vertex)).front());
        for (uint32_t at = kNone; steps > 0 && triangle_ != at && triangle_ != kNone; --steps) {
            at = triangle_;
            const Triangle& t = triangles_[at];
            for (int corner = 0; corner < 3; ++corner) {
                for (const uint32_t near : rings.some_around(number_of(t[corner]))) {
                    visit(near);
                }
            }
        }
    }

    bool found() const { return triangle_ != kNone; }
    uint32_t triangle() const { return triangle_; }
    const Triangle& corners() const { return triangles_[triangle_]; }
    double u() const { return u_; }
    double v() const { return v_; }
    double square() const { return square_; }  // the squared distance

private:
    double square_to(uint32_t vertex) const {
        const glm::dvec3 arm = glm::dvec3(points_[vertex]) - from_;
        return glm::dot(arm, arm);
    }

    const std::vector<glm::vec3>& points_;
    std::span<const Triangle> triangles_;
    glm::dvec3 from_;
    double square_ = std::numeric_limits<double>::infinity();
    double u_ = 0;
    double v_ = 0;
    uint32_t triangle_ = kNone;
    std::array<uint32_t, 64> recent_;  // triangles that were visited: rings overlap
};

}  // namespace lodestone::geometry
