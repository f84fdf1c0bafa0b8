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

Collapser::Collapser(CollapseMesh& mesh, const Adjacency& adjacency, Effort effort, double max_turn)
    : mesh_(mesh),
      adjacency_(adjacency),
      effort_(effort),
      min_cosine_(effort >= Effort::Rough ? 0.0 : std::cos(max_turn * 3.14159265358979 / 180)) {
    near_a_.resize(mesh.points.size());
    common_.resize(mesh.points.size());
}

bool Collapser::link_allows(uint32_t a, uint32_t b, bool search) {
    near_a_.clear();
    common_.clear();
    for (const uint32_t t : adjacency_.around(a)) {
        if (mesh_.dead(t))
            continue;
        const Triangle& corners = mesh_.triangles[t];
        for (int i = 0; i < 3; ++i)
            near_a_.set(corners[i]);
    }
    size_t common = 0;
    shared_ = left_ = 0;
    for (const uint32_t t : adjacency_.around(b)) {
        if (mesh_.dead(t))
            continue;
        const Triangle& corners = mesh_.triangles[t];
        const bool on = on_edge(t, a);
        shared_ += on;
        left_ += !on;
        for (int i = 0; i < 3; ++i) {
            const uint32_t u = corners[i];
            if (u == a || u == b || !near_a_.has(u) || common_.has(u))
                continue;
            common_.set(u);
            ++common;
        }
    }
    for (const uint32_t t : adjacency_.around(a))
        left_ += !mesh_.dead(t) && !on_edge(t, b);
    if (!search && common != shared_)
        return false;
    // A hub's coinciding triangles are left: finding them takes quadratic time.
    const bool hub = adjacency_.valence(a) + adjacency_.valence(b) > kMostAround;
    return left_ > 0 && (hub || !find_coinciding(a, b)) && common == shared_;
}

bool Collapser::turns_allow(const std::vector<glm::dvec3>& points,
                            const std::vector<glm::dvec3>& facets, uint32_t moved, uint32_t other,
                            const glm::dvec3& point) const {
    for (const uint32_t t : adjacency_.around(moved)) {
        if (mesh_.dead(t) || on_edge(t, other))
            continue;
        const Triangle& corners = mesh_.triangles[t];
        glm::dvec3 p[3];
        for (int i = 0; i < 3; ++i)
            p[i] = corners[i] == moved ? point : points[corners[i]];
        const glm::dvec3 facet = 0.5 * glm::cross(p[1] - p[0], p[2] - p[0]);
        const glm::dvec3& old = facets[t];
        const double square = glm::dot(facet, facet);
        const double old_square = glm::dot(old, old);
        const double longest = longest_square(p[0], p[1], p[2]);
        const double old_longest =
            longest_square(points[corners.x], points[corners.y], points[corners.z]);
        // Where there was no area there is no side to keep.
        const bool flat_before = old_square <= 1e-20 * old_longest * old_longest;
        if (flat_before)
            continue;
        if (square <= 1e-20 * longest * longest)
            return false;
        const double dot = glm::dot(facet, old);
        if (dot <= 0 || dot * dot < min_cosine_ * min_cosine_ * square * old_square)
            return false;
        if (effort_ < Effort::Rough && 4 * square < kThin * kThin * longest * longest &&
            square * old_longest * old_longest < old_square * longest * longest)
            return false;
    }
    return true;
}

bool Collapser::all_turns_allow(uint32_t a, uint32_t b, const glm::dvec3& point,
                                std::span<const glm::dvec3> others) const {
    if (!turns_allow(mesh_.points, mesh_.facets, a, b, point) ||
        !turns_allow(mesh_.points, mesh_.facets, b, a, point))
        return false;
    for (size_t i = 0; i < others.size(); ++i) {
        const OtherPose& pose = mesh_.others[i];
        if (!turns_allow(pose.points, pose.facets, a, b, others[i]) ||
            !turns_allow(pose.points, pose.facets, b, a, others[i]))
            return false;
    }
    return true;
}

bool Collapser::find_coinciding(uint32_t a, uint32_t b) {
    doomed_.clear();
    for (const uint32_t t : adjacency_.around(b)) {
        if (mesh_.dead(t) || on_edge(t, a))
            continue;
        const Triangle& corners = mesh_.triangles[t];
        const int at = corners.x == b ? 0 : (corners.y == b ? 1 : 2);
        const uint32_t from = corners[(at + 1) % 3];
        const uint32_t to = corners[(at + 2) % 3];
        if (!near_a_.has(from) || !near_a_.has(to))
            continue;
        for (const uint32_t s : adjacency_.around(a)) {
            if (mesh_.dead(s) || !on_edge(s, from) || !on_edge(s, to) || on_edge(s, b) ||
                std::find(doomed_.begin(), doomed_.end(), s) != doomed_.end())
                continue;
            const Triangle& other = mesh_.triangles[s];
            const int at_a = other.x == a ? 0 : (other.y == a ? 1 : 2);
            doomed_.push_back(t);
            if (other[(at_a + 1) % 3] == to)
                doomed_.push_back(s);
            break;
        }
    }
    return !doomed_.empty();
}

size_t Collapser::collapse(uint32_t a, uint32_t b, const glm::dvec3& point,
                           std::span<const glm::dvec3> others) {
    const size_t around = adjacency_.valence(a) + adjacency_.valence(b);
    work_ += around;
    if (around > kMostAround && effort_ < Effort::Anything)
        return 0;
    doomed_.clear();
    const bool fits = link_allows(a, b, effort_ >= Effort::Topology);
    if (effort_ < Effort::Topology && !fits)
        return 0;
    if (left_ <= doomed_.size())
        return 0;
    // An earlier collapse of this pass took the edge's triangles: it is none any more.
    if (shared_ == 0)
        return 0;
    if (effort_ < Effort::Anything && !all_turns_allow(a, b, point, others))
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
    for (size_t i = 0; i < others.size(); ++i)
        mesh_.others[i].points[a] = others[i];
    if (!mesh_.ids.empty())
        mesh_.merged[mesh_.ids[b]] = mesh_.ids[a];
    for (const uint32_t end : {a, b}) {
        for (const uint32_t t : adjacency_.around(end)) {
            if (mesh_.dead(t))
                continue;
            Triangle& corners = mesh_.triangles[t];
            if (on_edge(t, end == a ? b : a)) {
                corners.x = kNone;
                ++gone;
                continue;
            }
            for (int i = 0; i < 3; ++i) {
                if (corners[i] != end)
                    continue;
                corners[i] = a;
                if (carried)
                    mesh_.wedges[t][i] = wedges_.wedge_of(mesh_.wedges[t][i]);
            }
            mesh_.facets[t] = mesh_.facet_of(corners);
            for (OtherPose& other : mesh_.others)
                other.facets[t] = CollapseMesh::facet_of(other.points, corners);
        }
    }
    if (carried)
        wedges_.apply(mesh_);
    mesh_.live -= gone;
    return gone;
}

}  // namespace lodestone::approximate
