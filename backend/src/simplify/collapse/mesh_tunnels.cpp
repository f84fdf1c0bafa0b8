// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse/mesh_tunnels.h"

#include "base/disjoint_sets.h"
#include "simplify/collapse/edge_neighbors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>

namespace lodestone::simplify {
namespace {

/// The rounds for fans within fans, and for rows of edges: each takes the innermost, or the ends.
/// Taste: more cut deeper nests, which are rare.
constexpr int kMostNested = 8;
// Taste: more cut longer rows of edges in one call.
constexpr int kMostSweeps = 16;
/// How far a copy moves towards the middle of its fan, so that it has a position of its own.
/// Taste: a larger share is farther from the surface; a smaller one may be lost in rounding.
constexpr double kApart = 1.0 / 64;

/// The fans around one vertex.
class PinchCutter {
public:
    explicit PinchCutter(CollapseMesh& mesh) : mesh_(mesh) {}
    /// Gives all fans that close, except one, vertices of their own; with `loops` then those that
    /// close where the four triangles of an edge are taken as two pairs. False: there were none.
    bool cut(uint32_t vertex, std::span<const uint32_t> ring, bool loops);

private:
    /// A side of a triangle at the vertex.
    struct FanSide {
        uint32_t neighbor;
        uint32_t at;  // the triangle's index in the ring
        bool leaving;
    };
    /// The sides that are not shared by two triangles, where a fan ends.
    struct FanEnds {
        uint32_t count = 0;
        uint32_t neighbor = kNone;
        uint32_t leaving = 0;
        bool split = false;  // it ends at two edges where other fans end, too
        bool closes() const { return !split && (count == 0 || (count == 2 && leaving == 1)); }
    };
    void find_fans(uint32_t vertex, bool pairs);
    /// Makes two triangles of each side a pair with the solid between them.
    bool makes_pairs(size_t begin, size_t end) const;
    void join_pairs(uint32_t vertex, size_t begin);
    uint32_t copy(uint32_t vertex);
    /// Moves the triangles in fan_ from a vertex to its copy.
    void give(uint32_t vertex, uint32_t to);
    uint32_t copy_wedge(uint32_t wedge, uint32_t to);
    /// Moves the copy that has the triangles in fan_, unless a triangle would turn over.
    void set_apart(uint32_t fresh);

    CollapseMesh& mesh_;
    std::vector<uint32_t> ring_;     // the triangles around the vertex that are left
    std::vector<uint32_t> parents_;  // fans, as sets of the ring's triangles
    std::vector<FanSide> sides_;
    std::vector<FanEnds> ends_;                                 // by root
    std::vector<std::pair<uint32_t, uint32_t>> by_fan_;         // pairs (root, triangle)
    std::vector<uint32_t> fan_;                                 // the triangles of one fan
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> wedges_;  // by copy and the wedge it had
};

void PinchCutter::find_fans(uint32_t vertex, bool pairs) {
    const auto count = static_cast<uint32_t>(ring_.size());
    sides_.clear();
    for (uint32_t i = 0; i < count; ++i) {
        const CornerEnds ends = ends_of(mesh_.triangles[ring_[i]], vertex);
        sides_.push_back({ends.next, i, true});
        sides_.push_back({ends.last, i, false});
    }
    std::sort(sides_.begin(), sides_.end(), [](const FanSide& a, const FanSide& b) {
        return std::tie(a.neighbor, a.at) < std::tie(b.neighbor, b.at);
    });
    parents_.resize(count);
    std::iota(parents_.begin(), parents_.end(), 0u);
    const auto each_edge = [&](const auto& visit) {
        for (size_t begin = 0, end = 0; begin < sides_.size(); begin = end) {
            while (end < sides_.size() && sides_[end].neighbor == sides_[begin].neighbor)
                ++end;
            visit(begin, end);
        }
    };
    each_edge([&](size_t begin, size_t end) {
        if (end - begin == 2)
            join(parents_, sides_[begin].at, sides_[begin + 1].at);
        else if (pairs && makes_pairs(begin, end))
            join_pairs(vertex, begin);
    });
    ends_.assign(count, {});
    each_edge([&](size_t begin, size_t end) {
        if (end - begin <= 2 || (pairs && makes_pairs(begin, end)))
            return;
        for (size_t i = begin; i < end; ++i) {
            FanEnds& fan = ends_[root_of(parents_, sides_[i].at)];
            fan.split |= fan.count > 0 && fan.neighbor != sides_[i].neighbor;
            fan.neighbor = sides_[i].neighbor;
            fan.leaving += sides_[i].leaving;
            ++fan.count;
        }
    });
}

bool PinchCutter::makes_pairs(size_t begin, size_t end) const {
    int leaving = 0;
    for (size_t i = begin; i < end; ++i)
        leaving += sides_[i].leaving;
    return end - begin == 4 && leaving == 2;
}

void PinchCutter::join_pairs(uint32_t vertex, size_t begin) {
    const glm::dvec3 from = mesh_.points[vertex];
    const glm::dvec3 along = mesh_.points[sides_[begin].neighbor] - from;
    std::array<std::array<uint32_t, 2>, 2> at{};  // by whether they leave
    std::array<std::array<double, 2>, 2> angles{};
    std::array<size_t, 2> found{};
    glm::dvec3 x(0.0);
    for (size_t i = begin; i < begin + 4; ++i) {
        const FanSide& side = sides_[i];
        const Triangle& t = mesh_.triangles[ring_[side.at]];
        const uint32_t third = t.x ^ t.y ^ t.z ^ vertex ^ side.neighbor;
        // It points away from the edge; with y it is as long as with x times the edge's length.
        const glm::dvec3 y = glm::cross(along, mesh_.points[third] - from);
        if (i == begin)
            x = y;
        const size_t n = found[side.leaving]++;
        at[side.leaving][n] = side.at;
        angles[side.leaving][n] =
            std::atan2(glm::dot(glm::cross(x, y), along), glm::dot(x, y) * glm::length(along));
    }
    // The angle from a triangle that leaves to one that arrives, through the solid.
    const auto solid = [&](size_t leaving, size_t arriving) {
        const double angle = angles[1][leaving] - angles[0][arriving];
        return angle < 0 ? angle + 2 * std::numbers::pi : angle;
    };
    const size_t other = solid(0, 0) + solid(1, 1) <= solid(0, 1) + solid(1, 0) ? 0 : 1;
    join(parents_, at[1][0], at[0][other]);
    join(parents_, at[1][1], at[0][1 - other]);
}

uint32_t PinchCutter::copy(uint32_t vertex) {
    const auto fresh = static_cast<uint32_t>(mesh_.points.size());
    const auto id = static_cast<uint32_t>(mesh_.merged.size());
    mesh_.points.push_back(glm::dvec3(mesh_.points[vertex]));
    for (OtherPose& other : mesh_.others)
        other.points.push_back(glm::dvec3(other.points[vertex]));
    mesh_.parts.push_back(uint32_t{mesh_.parts[vertex]});
    mesh_.sources.push_back(uint32_t{mesh_.sources[mesh_.ids[vertex]]});
    mesh_.ids.push_back(id);
    mesh_.merged.push_back(id);
    return fresh;
}

void PinchCutter::give(uint32_t vertex, uint32_t to) {
    for (const uint32_t t : fan_) {
        const int corner = corner_of(mesh_.triangles[t], vertex);
        mesh_.triangles[t][corner] = to;
        if (!mesh_.wedges.empty()) {
            uint32_t& wedge = mesh_.wedges[t][corner];
            wedge = copy_wedge(wedge, to);
        }
    }
    set_apart(to);
}

uint32_t PinchCutter::copy_wedge(uint32_t wedge, uint32_t to) {
    const auto made = wedges_.try_emplace({to, wedge}, kNone);
    const auto entry = made.first;
    const auto copy_of = [&](auto& values) {
        if (values.empty())
            return;
        const auto value = values[wedge];
        entry->second = static_cast<uint32_t>(values.size());
        values.push_back(value);
    };
    if (made.second) {
        copy_of(mesh_.normals);
        copy_of(mesh_.uvs);
        copy_of(mesh_.colors);
    }
    return entry->second;
}

void PinchCutter::set_apart(uint32_t fresh) {
    glm::dvec3 middle(0.0);
    for (const uint32_t t : fan_) {
        const Triangle& c = mesh_.triangles[t];
        middle += (mesh_.points[c.x] + mesh_.points[c.y] + mesh_.points[c.z]) / 3.0;
    }
    middle /= static_cast<double>(fan_.size());
    const glm::dvec3 before = mesh_.points[fresh];
    mesh_.points[fresh] += kApart * (middle - before);
    for (const uint32_t t : fan_) {
        if (!(glm::dot(mesh_.facet_of(mesh_.triangles[t]), glm::dvec3(mesh_.facets[t])) > 0)) {
            mesh_.points[fresh] = before;
            return;
        }
    }
    for (const uint32_t t : fan_)
        mesh_.facets[t] = glm::vec3(mesh_.facet_of(mesh_.triangles[t]));
}

bool PinchCutter::cut(uint32_t vertex, std::span<const uint32_t> ring, bool loops) {
    ring_.assign(ring.begin(), ring.end());
    wedges_.clear();
    bool pairs = false;
    for (int nested = 0; nested < kMostNested; ++nested) {
        find_fans(vertex, pairs);
        by_fan_.clear();
        for (uint32_t i = 0; i < ring_.size(); ++i)
            by_fan_.emplace_back(root_of(parents_, i), ring_[i]);
        std::sort(by_fan_.begin(), by_fan_.end());
        // One fan keeps the vertex: the first that does not close, else the first.
        uint32_t keeps = 0;
        while (keeps < ring_.size() && (parents_[keeps] != keeps || ends_[keeps].closes()))
            ++keeps;
        keeps = keeps < ring_.size() ? keeps : 0;
        ring_.clear();
        const size_t all = by_fan_.size();
        for (size_t begin = 0, end = 0; begin < all; begin = end) {
            const uint32_t fan = by_fan_[begin].first;
            fan_.clear();
            for (; end < all && by_fan_[end].first == fan; ++end)
                fan_.push_back(by_fan_[end].second);
            if (fan == keeps || !ends_[fan].closes())
                ring_.insert(ring_.end(), fan_.begin(), fan_.end());
            else
                give(vertex, copy(vertex));
        }
        if (ring_.size() < all)
            continue;
        if (pairs || !loops)
            break;
        pairs = true;
    }
    return ring_.size() < ring.size();
}

}  // namespace

bool has_tunnels(const CollapseMesh& mesh, const Adjacency& adjacency) {
    VertexNeighbors neighbors;
    std::vector<uint32_t> ends;
    for (uint32_t v = 0; v < mesh.points.size(); ++v) {
        const std::span<const uint32_t> ring = adjacency.around(v);
        if (neighbors.find_fan(mesh, ring, v) != VertexNeighbors::FanKind::None &&
            neighbors.is_one(ring.size()))
            continue;
        ends.clear();
        for (const uint32_t t : ring) {
            const CornerEnds sides = ends_of(mesh.triangles[t], v);
            ends.insert(ends.end(), {sides.next, sides.last});
        }
        std::sort(ends.begin(), ends.end());
        for (size_t i = 2; i < ends.size(); ++i) {
            if (ends[i] == ends[i - 2])
                return true;
        }
    }
    return false;
}

bool cut_tunnels(CollapseMesh& mesh, bool loops) {
    const size_t before = mesh.points.size();
    bool cut = true;
    for (int sweep = 0; cut && sweep < kMostSweeps; ++sweep) {
        cut = false;
        Adjacency adjacency;
        adjacency.build(mesh);
        VertexNeighbors neighbors;
        PinchCutter cutter(mesh);
        const auto vertices = static_cast<uint32_t>(mesh.points.size());
        for (uint32_t v = 0; v < vertices; ++v) {
            const std::span<const uint32_t> ring = adjacency.around(v);
            const bool one = neighbors.find_fan(mesh, ring, v) != VertexNeighbors::FanKind::None &&
                             neighbors.is_one(ring.size());
            if (!one && cutter.cut(v, ring, loops))
                cut = true;
        }
    }
    return mesh.points.size() > before;
}

}  // namespace lodestone::simplify
