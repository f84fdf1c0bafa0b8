// SPDX-License-Identifier: GPL-3.0-or-later
// Edge collapse: decides whether an edge may be collapsed to a point, and does it.
#pragma once

#include "simplify/collapse/corner_wedges.h"
#include "simplify/collapse/edge_queue.h"

#include <algorithm>

namespace lodestone::simplify {

/// Valid for one pass: `adjacency` and `edges` belong to its start. A vertex is an end in one
/// collapse of a pass at most, so its list stays right as long as it is needed. With a chunk, it
/// reads and changes only the surroundings of the chunk's vertices: several chunks may be worked on
/// at the same time.
class EdgeCollapser {
public:
    EdgeCollapser(CollapseMesh& mesh, const Adjacency& adjacency, const EdgeQueue& edges,
                  CollapseEffort effort, double max_turn, const EdgeChunk* chunk = nullptr);

    /// The result of collapse() where it would have to reach beyond the chunk.
    static constexpr size_t kOutside = ~size_t{0};
    /// Collapses the edge into its end a, or changes nothing and returns 0. Returns how many
    /// triangles were removed; `live` of the mesh still counts them.
    size_t collapse(const CollapseCandidate& edge);

    /// Asks for the memory that collapse() of this edge will need: it lies anywhere, and waiting
    /// for it is most of the time. The lists come first, the triangles in them some edges later.
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

    /// The number of triangles visited so far, which bounds the time of a pass.
    size_t work() const { return work_; }

private:
    /// The most triangles of a list that memory is asked for.
    /// Taste: more ask in vain, as most vertices have six triangles.
    static constexpr size_t kMostExpected = 8;
    /// A live triangle around a vertex, which is its corner `at`; after it come `next` and `last`.
    struct RingCorner {
        uint32_t triangle, at, next, last;
        glm::vec3 facet;  // its area vector after the collapse; set by turns_allow
        bool on(uint32_t vertex) const { return next == vertex || last == vertex; }
    };
    struct RingCorners {
        std::vector<RingCorner> room;
        size_t count = 0;
        RingCorner* begin() { return room.data(); }
        RingCorner* end() { return room.data() + count; }
        /// Makes it empty, with room for one more than `most`.
        RingCorner* reserve(size_t most) {
            if (room.size() <= most)
                room.resize(2 * most + 1);
            return room.data();
        }
    };
    /// Finds the corners around an end of the edge: on triangles on the edge, and on the others.
    /// False: one of them is not in the chunk.
    bool find_corners(uint32_t vertex, uint32_t other, RingCorners& corners,
                      RingCorners& shared) const;
    /// True when the surface stays as connected as it was. Fills doomed_ if it could be true, or
    /// always with `search`.
    bool link_allows(uint32_t a, uint32_t b, bool search);
    uint32_t& stamp(uint32_t vertex) { return stamps_[vertex - first_]; }
    /// Decides for one pose: `from` is the position of the corners' vertex. Sets the new area
    /// vectors.
    bool turns_allow(const std::vector<glm::dvec3>& points, RingCorners& corners,
                     const glm::dvec3& from, const glm::dvec3& point);
    /// Decides for both ends, in all poses.
    bool all_turns_allow(uint32_t a, uint32_t b, const glm::dvec3& point);
    /// Fills doomed_ with triangles that would coincide: opposite pairs vanish, of copies one
    /// stays.
    bool find_coinciding();

    CollapseMesh& mesh_;
    const Adjacency& adjacency_;
    const EdgeQueue& edges_;
    CollapseEffort effort_;
    uint32_t first_;  // the vertices it may touch, and their number
    uint32_t count_;
    double square_cosine_;
    RingCorners around_a_;  // without those on the edge
    RingCorners around_b_;
    RingCorners shared_;  // triangles on the edge, as seen from a
    RingCorners shared_b_;
    std::vector<uint32_t> stamps_;  // now_: near a; now_ + 1: near both
    uint32_t now_ = 0;
    WedgeMerge wedges_;
    std::vector<uint32_t> doomed_;
    std::vector<glm::dvec3> others_;  // its new position in the mesh's other poses
    size_t work_ = 0;
};

}  // namespace lodestone::simplify
