// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse/edge_collapse.h"

#include "simplify/collapse/edge_neighbors.h"

#include <algorithm>
#include <cmath>

namespace lodestone::simplify {
namespace {

/// The most triangles around both ends together; larger hubs are left for the last effort.
/// Taste: more take time that grows with the square.
constexpr size_t kMostAround = 1000;
/// Twice the area over the square of the longest edge: thinner triangles are not made from fatter
/// ones.
/// Taste: a larger number refuses more collapses and leaves fewer slivers.
constexpr double kThin = 2e-3;

/// The triangles whose numbers are computed at once.
/// Law: four floats are a vector of 16 bytes, which every x86-64 processor has.
constexpr size_t kEndsAtOnce = 4;
using Lanes = float __attribute__((vector_size(4 * kEndsAtOnce)));

struct EndVectors {
    Lanes x, y, z;
};

Lanes dot(const EndVectors& a, const EndVectors& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// The differences, the only numbers that single precision is enough for.
EndVectors between(const glm::dvec3* const (&ends)[kEndsAtOnce], const glm::dvec3& from) {
    using Two = double __attribute__((vector_size(16)));
    using TwoFloats = float __attribute__((vector_size(8)));
    const auto component = [&](auto member) {
        const Two low = Two{ends[0]->*member, ends[1]->*member} - from.*member;
        const Two high = Two{ends[2]->*member, ends[3]->*member} - from.*member;
        return __builtin_shufflevector(__builtin_convertvector(low, TwoFloats),
                                       __builtin_convertvector(high, TwoFloats), 0, 1, 2, 3);
    };
    return {component(&glm::dvec3::x), component(&glm::dvec3::y), component(&glm::dvec3::z)};
}

/// The edges of four triangles from the corner that they share.
struct CornerSpokes {
    EndVectors next, last;
    CornerSpokes(const glm::dvec3* const (&ends_next)[kEndsAtOnce],
                 const glm::dvec3* const (&ends_last)[kEndsAtOnce], const glm::dvec3& from)
        : next(between(ends_next, from)), last(between(ends_last, from)) {}

    /// The area vectors.
    EndVectors facet() const {
        return {0.5f * (next.y * last.z - last.y * next.z),
                0.5f * (next.z * last.x - last.z * next.x),
                0.5f * (next.x * last.y - last.x * next.y)};
    }
    /// The square of each triangle's longest edge.
    Lanes longest_square() const {
        const EndVectors across{last.x - next.x, last.y - next.y, last.z - next.z};
        const auto larger = [](const Lanes& a, const Lanes& b) { return a < b ? b : a; };
        return larger(larger(dot(next, next), dot(last, last)), dot(across, across));
    }
};

}  // namespace

EdgeCollapser::EdgeCollapser(CollapseMesh& mesh, const Adjacency& adjacency, const EdgeQueue& edges,
                             CollapseEffort effort, double max_turn, const EdgeChunk* chunk)
    : mesh_(mesh),
      adjacency_(adjacency),
      edges_(edges),
      effort_(effort),
      first_(chunk != nullptr ? chunk->first : 0),
      count_(chunk != nullptr ? chunk->last - chunk->first
                              : static_cast<uint32_t>(mesh.points.size())) {
    const double cosine =
        effort >= CollapseEffort::Rough ? 0.0 : std::cos(max_turn * 3.14159265358979 / 180);
    square_cosine_ = cosine * cosine;
    stamps_.assign(count_, 0);
}

bool EdgeCollapser::find_corners(uint32_t vertex, uint32_t other, RingCorners& corners,
                                 RingCorners& shared) const {
    const std::span<const uint32_t> around = adjacency_.around(vertex);
    RingCorner* to = corners.reserve(around.size());
    RingCorner* on = shared.reserve(around.size());
    bool inside = true;
    for (const uint32_t t : around) {
        const Triangle& c = mesh_.triangles[t];
        const CornerEnds ends = ends_of(c, vertex);
        // It is written to both and counted in one: here, too, there are no branches.
        const bool live = c.x != kNone;
        const bool shares = (ends.next == other) | (ends.last == other);
        to->triangle = on->triangle = t;
        to->at = on->at = ends.at;
        to->next = on->next = ends.next;
        to->last = on->last = ends.last;
        const bool near = (ends.next - first_ < count_) & (ends.last - first_ < count_);
        inside &= near | !live;
        to += live & !shares;
        on += live & shares;
    }
    corners.count = static_cast<size_t>(to - corners.room.data());
    shared.count = static_cast<size_t>(on - shared.room.data());
    return inside;
}

bool EdgeCollapser::link_allows(uint32_t a, uint32_t b, bool search) {
    now_ += 2;
    for (const RingCorner& corner : around_a_)
        stamp(corner.next) = stamp(corner.last) = now_;
    for (const RingCorner& corner : shared_)
        stamp(corner.next == b ? corner.last : corner.next) = now_;
    size_t common = 0;
    const auto count = [&](uint32_t vertex) {
        uint32_t& mark = stamp(vertex);
        const bool met = mark == now_;
        mark += met;
        common += met;
    };
    for (const RingCorner& corner : around_b_) {
        count(corner.next);
        count(corner.last);
    }
    for (const RingCorner& corner : shared_)
        count(corner.next == b ? corner.last : corner.next);
    if (!search && common != shared_.count)
        return false;
    // The coinciding triangles of a hub stay: finding them takes quadratic time.
    const bool hub = adjacency_.valence(a) + adjacency_.valence(b) > kMostAround;
    const bool left = around_a_.count + around_b_.count > 0;
    return left && (hub || !find_coinciding()) && common == shared_.count;
}

bool EdgeCollapser::turns_allow(const std::vector<glm::dvec3>& points, RingCorners& corners,
                                const glm::dvec3& from, const glm::dvec3& point) {
    for (size_t first = 0; first < corners.count; first += kEndsAtOnce) {
        RingCorner* const some = corners.begin() + first;
        const size_t count = std::min(kEndsAtOnce, corners.count - first);
        const glm::dvec3* ends_next[kEndsAtOnce];
        const glm::dvec3* ends_last[kEndsAtOnce];
        for (size_t i = 0; i < kEndsAtOnce; ++i) {
            const RingCorner& corner = some[std::min(i, count - 1)];
            ends_next[i] = &points[corner.next];
            ends_last[i] = &points[corner.last];
        }
        const CornerSpokes spokes(ends_next, ends_last, point);
        const EndVectors facets = spokes.facet();
        // It is computed again, because it lies where no other data are read.
        const CornerSpokes old_spokes(ends_next, ends_last, from);
        const EndVectors old_facets = old_spokes.facet();
        const Lanes squares = dot(facets, facets);
        const Lanes old_squares = dot(old_facets, old_facets);
        const Lanes dots = dot(facets, old_facets);
        const Lanes longest_squares = spokes.longest_square();
        for (size_t i = 0; i < count; ++i) {
            some[i].facet = glm::vec3(facets.x[i], facets.y[i], facets.z[i]);
            // Products of areas leave the range of single precision.
            const double square = squares[i];
            const double old_square = old_squares[i];
            const double longest = longest_squares[i];
            const double dot = dots[i];
            const double thin = kThin * kThin * longest * longest;
            if (dot > 0 && dot * dot >= square_cosine_ * square * old_square && 4 * square >= thin)
                continue;
            const double old_longest = old_spokes.longest_square()[i];
            // A triangle without area had no side to keep.
            if (old_square <= 1e-20 * old_longest * old_longest)
                continue;
            if (square <= 1e-20 * longest * longest)
                return false;
            if (dot <= 0 || dot * dot < square_cosine_ * square * old_square)
                return false;
            if (effort_ < CollapseEffort::Rough && 4 * square < thin &&
                square * old_longest * old_longest < old_square * longest * longest)
                return false;
        }
    }
    return true;
}

bool EdgeCollapser::all_turns_allow(uint32_t a, uint32_t b, const glm::dvec3& point) {
    const auto both = [&](const std::vector<glm::dvec3>& points, const glm::dvec3& to) {
        return turns_allow(points, around_a_, points[a], to) &&
               turns_allow(points, around_b_, points[b], to);
    };
    for (size_t i = 0; i < others_.size(); ++i) {
        if (!both(mesh_.others[i].points, others_[i]))
            return false;
    }
    return both(mesh_.points, point);  // last, because its area vectors are kept
}

bool EdgeCollapser::find_coinciding() {
    doomed_.clear();
    const auto near_a = [&](uint32_t u) { return stamp(u) - now_ <= 1; };
    for (const RingCorner& corner : around_b_) {
        if (!near_a(corner.next) || !near_a(corner.last))
            continue;
        for (const RingCorner& other : around_a_) {
            if (!other.on(corner.next) || !other.on(corner.last) ||
                std::find(doomed_.begin(), doomed_.end(), other.triangle) != doomed_.end())
                continue;
            // Triangles of one side both stay: their edges then have four triangles, as pinches
            // have.
            if (other.next != corner.last && effort_ == CollapseEffort::Topology)
                continue;
            doomed_.push_back(corner.triangle);
            if (other.next == corner.last)
                doomed_.push_back(other.triangle);
            break;
        }
    }
    return !doomed_.empty();
}

size_t EdgeCollapser::collapse(const CollapseCandidate& edge) {
    const uint32_t a = edge.a;
    const uint32_t b = edge.b;
    const size_t around = adjacency_.valence(a) + adjacency_.valence(b);
    work_ += around;
    if (around > kMostAround && effort_ < CollapseEffort::Anything)
        return 0;
    if (!find_corners(a, b, around_a_, shared_) || !find_corners(b, a, around_b_, shared_b_))
        return kOutside;
    // An earlier collapse of this pass took the edge's triangles: it is no edge any more.
    if (shared_.count == 0)
        return 0;
    doomed_.clear();
    const bool fits = link_allows(a, b, effort_ >= CollapseEffort::Topology);
    if (effort_ < CollapseEffort::Topology && !fits)
        return 0;
    if (around_a_.count + around_b_.count <= doomed_.size())
        return 0;
    const glm::dvec3 point = edges_.point(mesh_, edge, effort_);
    if (!mesh_.others.empty()) {
        std::vector<uint32_t> shared;
        for (const RingCorner& corner : shared_)
            shared.push_back(corner.triangle);
        edges_.other_points(mesh_, a, b, shared, effort_, others_);
    }
    if (effort_ < CollapseEffort::Anything && !all_turns_allow(a, b, point))
        return 0;
    const bool carried = !mesh_.wedges.empty();
    if (carried && !wedges_.plan(mesh_, adjacency_, a, b, point, effort_ >= CollapseEffort::Rough))
        return 0;
    for (const uint32_t t : doomed_)
        mesh_.triangles[t].x = kNone;
    for (const RingCorner& corner : shared_)
        mesh_.triangles[corner.triangle].x = kNone;
    mesh_.points[a] = point;
    for (size_t i = 0; i < others_.size(); ++i)
        mesh_.others[i].points[a] = others_[i];
    // On borders of chunks it matters which vertex goes.
    if (!mesh_.chunks.empty() && edges_.held(a, b, effort_) > 0)
        std::swap(mesh_.ids[a], mesh_.ids[b]);
    mesh_.merged[mesh_.ids[b]] = mesh_.ids[a];
    for (RingCorners* corners : {&around_a_, &around_b_}) {
        for (const RingCorner& corner : *corners) {
            const uint32_t t = corner.triangle;
            Triangle& ends = mesh_.triangles[t];
            if (ends.x == kNone)  // it is doomed
                continue;
            (&ends.x)[corner.at] = a;
            if (carried) {
                uint32_t& wedge = (&mesh_.wedges[t].x)[corner.at];
                wedge = wedges_.wedge_of(wedge);
            }
            mesh_.facets[t] =
                effort_ < CollapseEffort::Anything ? corner.facet : glm::vec3(mesh_.facet_of(ends));
            for (OtherPose& other : mesh_.others)
                other.facets[t] = glm::vec3(CollapseMesh::facet_of(other.points, ends));
        }
    }
    if (carried)
        wedges_.apply(mesh_);
    return doomed_.size() + shared_.count;
}

}  // namespace lodestone::simplify
