// SPDX-License-Identifier: GPL-3.0-or-later
// Collapse: whether an edge may be collapsed to a point, and doing it.
#pragma once

#include "approximate/edges.h"
#include "approximate/wedges.h"

namespace lodestone::approximate {

/// Valid for one pass: `adjacency` belongs to its start. A vertex takes part in one collapse of a
/// pass as an end, so its list stays right for as long as it is needed.
class Collapser {
public:
    Collapser(CollapseMesh& mesh, const Adjacency& adjacency, Effort effort, double max_turn);

    /// Collapses a and b into a at `point`, or changes nothing and returns 0. Returns how many
    /// triangles went. `others`: where it goes in each of the mesh's other poses.
    size_t collapse(uint32_t a, uint32_t b, const glm::dvec3& point,
                    std::span<const glm::dvec3> others = {});

    /// Triangles looked at so far: what a pass may spend is bounded by it.
    size_t work() const { return work_; }

private:
    /// A live triangle around a vertex: after it come the corners next and last.
    struct Corner {
        uint32_t triangle, next, last;
        bool on(uint32_t vertex) const { return next == vertex || last == vertex; }
    };
    using Corners = std::vector<Corner>;
    void find_corners(uint32_t vertex, Corners& corners) const;
    /// True when the surface stays as connected as it was. Counts left_ and shared_; fills doomed_
    /// if it could be true, or always with `search`.
    bool link_allows(uint32_t a, uint32_t b, bool search);
    /// In one pose: `from` is where the corners' vertex is. Appends the new area vectors.
    bool turns_allow(const std::vector<glm::dvec3>& points, const std::vector<glm::vec3>& facets,
                     const Corners& corners, uint32_t other, const glm::dvec3& from,
                     const glm::dvec3& point);
    /// Both ends, in all poses.
    bool all_turns_allow(uint32_t a, uint32_t b, const glm::dvec3& point,
                         std::span<const glm::dvec3> others);
    /// Fills doomed_ with triangles that would coincide: opposite pairs vanish, copies stay once.
    bool find_coinciding(uint32_t a, uint32_t b);

    CollapseMesh& mesh_;
    const Adjacency& adjacency_;
    Effort effort_;
    double square_cosine_;
    Corners around_a_;
    Corners around_b_;
    std::vector<uint32_t> stamps_;  // now_: near a; now_ + 1: near both
    uint32_t now_ = 0;
    WedgeMerge wedges_;
    std::vector<uint32_t> doomed_;
    size_t left_ = 0;    // triangles around the edge that are not on it
    size_t shared_ = 0;  // triangles on it
    size_t work_ = 0;
};

}  // namespace lodestone::approximate
