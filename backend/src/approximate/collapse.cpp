// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/collapse.h"

#include <algorithm>
#include <cmath>

namespace lodestone::approximate {
namespace {

/// Both ends together; larger hubs are left for the last effort.
constexpr size_t kMostAround = 1000;
/// Twice the area over the longest edge squared: thinner triangles are not made from fatter ones.
constexpr double kThin = 2e-3;

double longest_square(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
}

}  // namespace

Collapser::Collapser(CollapseMesh& mesh, const Adjacency& adjacency, const Edges& edges,
                     Effort effort, double max_turn, const Chunk* chunk)
    : mesh_(mesh),
      adjacency_(adjacency),
      edges_(edges),
      effort_(effort),
      first_(chunk != nullptr ? chunk->first : 0),
      count_(chunk != nullptr ? chunk->last - chunk->first
                              : static_cast<uint32_t>(mesh.points.size())) {
    const double cosine =
        effort >= Effort::Rough ? 0.0 : std::cos(max_turn * 3.14159265358979 / 180);
    square_cosine_ = cosine * cosine;
    stamps_.assign(count_, 0);
}

bool Collapser::find_corners(uint32_t vertex, Corners& corners) const {
    const std::span<const uint32_t> around = adjacency_.around(vertex);
    if (corners.room.size() < around.size())
        corners.room.resize(2 * around.size());
    Corner* to = corners.room.data();
    bool inside = true;
    for (const uint32_t t : around) {
        const Triangle& c = mesh_.triangles[t];
        // No branches: which corner it is nobody can predict.
        const bool first = c.x == vertex;
        const bool second = c.y == vertex;
        to->triangle = t;
        to->next = first ? c.y : (second ? c.z : c.x);
        to->last = first ? c.z : (second ? c.x : c.y);
        const bool live = c.x != kNone;
        inside &= !live || (to->next - first_ < count_ && to->last - first_ < count_);
        to += live;
    }
    corners.count = static_cast<size_t>(to - corners.room.data());
    return inside;
}

bool Collapser::link_allows(uint32_t a, uint32_t b, bool search) {
    now_ += 2;
    shared_.clear();
    left_ = 0;
    for (const Corner& corner : around_a_) {
        if (corner.on(b))
            shared_.push_back(corner.triangle);
        stamp(corner.next) = stamp(corner.last) = now_;
    }
    size_t common = 0;
    size_t on_a = 0;
    for (const Corner& corner : around_b_) {
        on_a += corner.on(a);
        for (const uint32_t u : {corner.next, corner.last}) {
            if (stamp(u) != now_)
                continue;
            stamp(u) = now_ + 1;
            ++common;
        }
    }
    left_ = around_a_.count - shared_.size() + around_b_.count - on_a;
    if (!search && common != shared_.size())
        return false;
    // A hub's coinciding triangles are left: finding them takes quadratic time.
    const bool hub = adjacency_.valence(a) + adjacency_.valence(b) > kMostAround;
    return left_ > 0 && (hub || !find_coinciding(a, b)) && common == shared_.size();
}

bool Collapser::turns_allow(const std::vector<glm::dvec3>& points,
                            const std::vector<glm::vec3>& facets, Corners& corners, uint32_t other,
                            const glm::dvec3& from, const glm::dvec3& point) {
    for (Corner& corner : corners) {
        if (corner.on(other))
            continue;
        const glm::dvec3& next = points[corner.next];
        const glm::dvec3& last = points[corner.last];
        const glm::dvec3 facet = 0.5 * glm::cross(next - point, last - point);
        corner.facet = glm::vec3(facet);
        const glm::dvec3 old(facets[corner.triangle]);
        const double square = glm::dot(facet, facet);
        const double old_square = glm::dot(old, old);
        const double longest = longest_square(point, next, last);
        const double dot = glm::dot(facet, old);
        const double thin = kThin * kThin * longest * longest;
        if (dot > 0 && dot * dot >= square_cosine_ * square * old_square && 4 * square >= thin)
            continue;
        const double old_longest = longest_square(from, next, last);
        // Where there was no area there is no side to keep.
        if (old_square <= 1e-20 * old_longest * old_longest)
            continue;
        if (square <= 1e-20 * longest * longest)
            return false;
        if (dot <= 0 || dot * dot < square_cosine_ * square * old_square)
            return false;
        if (effort_ < Effort::Rough && 4 * square < thin &&
            square * old_longest * old_longest < old_square * longest * longest)
            return false;
    }
    return true;
}

bool Collapser::all_turns_allow(uint32_t a, uint32_t b, const glm::dvec3& point) {
    const auto both = [&](const std::vector<glm::dvec3>& points,
                          const std::vector<glm::vec3>& facets, const glm::dvec3& to) {
        return turns_allow(points, facets, around_a_, b, points[a], to) &&
               turns_allow(points, facets, around_b_, a, points[b], to);
    };
    for (size_t i = 0; i < others_.size(); ++i) {
        if (!both(mesh_.others[i].points, mesh_.others[i].facets, others_[i]))
            return false;
    }
    return both(mesh_.points, mesh_.facets, point);  // last: its area vectors are kept
}

bool Collapser::find_coinciding(uint32_t a, uint32_t b) {
    doomed_.clear();
    const auto near_a = [&](uint32_t u) { return stamp(u) - now_ <= 1; };
    for (const Corner& corner : around_b_) {
        if (corner.on(a) || !near_a(corner.next) || !near_a(corner.last))
            continue;
        for (const Corner& other : around_a_) {
            if (!other.on(corner.next) || !other.on(corner.last) || other.on(b) ||
                std::find(doomed_.begin(), doomed_.end(), other.triangle) != doomed_.end())
                continue;
            doomed_.push_back(corner.triangle);
            if (other.next == corner.last)
                doomed_.push_back(other.triangle);
            break;
        }
    }
    return !doomed_.empty();
}

size_t Collapser::collapse(uint32_t a, uint32_t b) {
    const size_t around = adjacency_.valence(a) + adjacency_.valence(b);
    work_ += around;
    if (around > kMostAround && effort_ < Effort::Anything)
        return 0;
    if (!find_corners(a, around_a_) || !find_corners(b, around_b_))
        return kOutside;
    doomed_.clear();
    const bool fits = link_allows(a, b, effort_ >= Effort::Topology);
    if (effort_ < Effort::Topology && !fits)
        return 0;
    if (left_ <= doomed_.size())
        return 0;
    // An earlier collapse of this pass took the edge's triangles: it is none any more.
    if (shared_.empty())
        return 0;
    const glm::dvec3 point = edges_.optimum(mesh_, a, b, shared_, effort_).point;
    edges_.other_points(mesh_, a, b, shared_, effort_, others_);
    if (effort_ < Effort::Anything && !all_turns_allow(a, b, point))
        return 0;
    const bool carried = !mesh_.wedges.empty();
    if (carried && !wedges_.plan(mesh_, adjacency_, a, b, point, effort_ >= Effort::Rough))
        return 0;
    size_t gone = 0;
    for (const uint32_t t : doomed_) {
        mesh_.triangles[t].x = kNone;
        ++gone;
    }
    mesh_.points[a] = point;
    for (size_t i = 0; i < others_.size(); ++i)
        mesh_.others[i].points[a] = others_[i];
    mesh_.merged[mesh_.ids[b]] = mesh_.ids[a];
    for (const uint32_t end : {a, b}) {
        for (const Corner& corner : end == a ? around_a_ : around_b_) {
            const uint32_t t = corner.triangle;
            Triangle& corners = mesh_.triangles[t];
            if (corners.x == kNone)  // doomed, or on the edge and met before
                continue;
            if (corner.on(end == a ? b : a)) {
                corners.x = kNone;
                ++gone;
                continue;
            }
            const int at = corners.x == end ? 0 : (corners.y == end ? 1 : 2);
            corners[at] = a;
            if (carried)
                mesh_.wedges[t][at] = wedges_.wedge_of(mesh_.wedges[t][at]);
            mesh_.facets[t] =
                effort_ < Effort::Anything ? corner.facet : glm::vec3(mesh_.facet_of(corners));
            for (OtherPose& other : mesh_.others)
                other.facets[t] = glm::vec3(CollapseMesh::facet_of(other.points, corners));
        }
    }
    if (carried)
        wedges_.apply(mesh_);
    return gone;
}

}  // namespace lodestone::approximate
