// SPDX-License-Identifier: GPL-3.0-or-later
// Collapse: whether an edge may be collapsed to a point, and doing it.
#pragma once

#include "simplify/collapse/corner_wedges.h"
#include "simplify/collapse/edge_queue.h"

#include <algorithm>

namespace lodestone::simplify {

/// Valid for one pass: `adjacency` and `edges` belong to its start. A vertex takes part in one
/// collapse of a pass as an end, so its list stays right for as long as it is needed. With a chunk,
/// it reads and changes nothing but what is around vertices of that: chunks may be worked on at the
/// same time.
class EdgeCollapser {
public:
    EdgeCollapser(CollapseMesh& mesh, const Adjacency& adjacency, const EdgeQueue& edges,
                  CollapseEffort effort, double max_turn, const EdgeChunk* chunk = nullptr);

    /// What collapse() returns where it would have to reach beyond the chunk.
    static constexpr size_t kOutside = ~size_t{0};
    /// Collapses the edge into its end a, or changes nothing and returns 0. Returns how many
    /// triangles went; of the mesh, `live` still counts them.
    size_t collapse(const CollapseCandidate& edge);

    /// Asks for what collapse() of this edge will need: what it reads lies anywhere, and waiting
    /// for memory is most of its time. First for the lists, some edges later for the triangles in
    /// them.
    void prefetch_lists(const CollapseCandidate& edge) const {
        for (const uint32_t end : {edge.a, edge.b})
            __builtin_prefetch(adjacency_.triangles.data() + adjacency_.first[end]);
    }
    void prefetch_triangles(const CollapseCandidate& edge) const {
        for (const uint32_t end : {edge.a, edge.b}) {
            for (const uint32_t t :
                 adjacency_.around(end).first(std::min(adjacency_.valence(end), kMostExpected)))
                __builtin_prefetch(mesh_.triangles.data() + t);
        }
    }

    /// Triangles looked at so far: what a pass may spend is bounded by it.
    size_t work() const { return work_; }

private:
    static constexpr size_t kMostExpected = 8;
    /// A live triangle around a vertex, which is its corner `at`: after it come next and last.
    struct RingCorner {
        uint32_t triangle, at, next, last;
        glm::vec3 facet;  // its area vector after the collapse; by turns_allow
        bool on(uint32_t vertex) const { return next == vertex || last == vertex; }
    };
    struct RingCorners {
        std::vector<RingCorner> room;
        size_t count = 0;
        RingCorner* begin() { return room.data(); }
        RingCorner* end() { return room.data() + count; }
        /// Empty, with room for one more than `most`.
        RingCorner* reserve(size_t most) {
            if (room.size() <= most)
                room.resize(2 * most + 1);
            return room.data();
        }
    };
    /// Around an end of the edge: triangles on the edge, and the others. False: one of their
    /// corners is not in the chunk.
    bool find_corners(uint32_t vertex, uint32_t other, RingCorners& corners,
                      RingCorners& shared) const;
    /// True when the surface stays as connected as it was. Fills doomed_ if it could be true, or
    /// always with `search`.
    bool link_allows(uint32_t a, uint32_t b, bool search);
    uint32_t& stamp(uint32_t vertex) { return stamps_[vertex - first_]; }
    /// In one pose: `from` is where the corners' vertex is. Sets the corners' new area vectors.
    bool turns_allow(const std::vector<glm::dvec3>& points, RingCorners& corners,
                     const glm::dvec3& from, const glm::dvec3& point);
    /// Both ends, in all poses.
    bool all_turns_allow(uint32_t a, uint32_t b, const glm::dvec3& point);
    /// Fills doomed_ with triangles that would coincide: opposite pairs vanish, copies stay once.
    bool find_coinciding();

    CollapseMesh& mesh_;
    const Adjacency& adjacency_;
    const EdgeQueue& edges_;
    CollapseEffort effort_;
    uint32_t first_;  // vertices it may touch, and how many
    uint32_t count_;
    double square_cosine_;
    RingCorners around_a_;  // without those on the edge
    RingCorners around_b_;
    RingCorners shared_;  // triangles on the edge, as a sees them
    RingCorners shared_b_;
    std::vector<uint32_t> stamps_;  // now_: near a; now_ + 1: near both
    uint32_t now_ = 0;
    WedgeMerge wedges_;
    std::vector<uint32_t> doomed_;
    std::vector<glm::dvec3> others_;  // where it goes in the mesh's other poses
    size_t work_ = 0;
};

}  // namespace lodestone::simplify
