// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/ring_triangulation.h"

#include "base/maths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace lodestone {
namespace {

using Corner = uint32_t;  // of the list around an island, which may pass a point twice

struct ListedCorner {
    uint32_t point;
    Corner previous;
    Corner next;
};

struct RingBox {
    glm::dvec2 low{kInfinity};
    glm::dvec2 high{-kInfinity};
};

RingBox box_of(const Ring& ring) {
    RingBox box;
    for (const glm::dvec2& at : ring) {
        box.low = {std::min(box.low.x, at.x), std::min(box.low.y, at.y)};
        box.high = {std::max(box.high.x, at.x), std::max(box.high.y, at.y)};
    }
    return box;
}

double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool contains(const Ring& ring, const glm::dvec2& at) {
    bool inside = false;
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        const glm::dvec2& a = ring[i];
        const glm::dvec2& b = ring[j];
        if ((a.y > at.y) != (b.y > at.y) && at.x < (b.x - a.x) * (at.y - a.y) / (b.y - a.y) + a.x)
            inside = !inside;
    }
    return inside;
}

/// The corners of a list by where they lie: those within a box are found without the others.
class CornerGrid {
public:
    /// `places[i]`: where `corners[i]` lies.
    CornerGrid(const std::vector<Corner>& corners, const Ring& places) {
        const RingBox box = box_of(places);
        low_ = box.low;
        // About as many cells as corners.
        side_ = static_cast<size_t>(std::sqrt(static_cast<double>(corners.size()))) + 1;
        const glm::dvec2 size = box.high - box.low;
        for (int axis = 0; axis < 2; ++axis)
            cells_of_unit_[axis] = size[axis] > 0 ? static_cast<double>(side_) / size[axis] : 0;
        first_.resize(side_ * side_ + 1, 0);
        for (const glm::dvec2& place : places)
            ++first_[cell(place) + 1];
        for (size_t i = 1; i < first_.size(); ++i)
            first_[i] += first_[i - 1];
        corners_.resize(corners.size());
        std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
        for (size_t i = 0; i < corners.size(); ++i)
            corners_[next[cell(places[i])]++] = corners[i];
    }

    /// Whether a test of the corners in cells that meet a box holds for any.
    template <typename Test>
    bool any(const RingBox& box, const Test& test) const {
        const size_t left = along(box.low, 0);
        const size_t right = along(box.high, 0);
        for (size_t row = along(box.low, 1); row <= along(box.high, 1); ++row) {
            for (size_t i = first_[row * side_ + left]; i < first_[row * side_ + right + 1]; ++i) {
                if (test(corners_[i]))
                    return true;
            }
        }
        return false;
    }

private:
    size_t along(const glm::dvec2& at, int axis) const {
        const double cell = (at[axis] - low_[axis]) * cells_of_unit_[axis];
        return static_cast<size_t>(limited(cell, 0, static_cast<double>(side_ - 1)));
    }
    size_t cell(const glm::dvec2& at) const { return along(at, 1) * side_ + along(at, 0); }

    glm::dvec2 low_{0.0};
    glm::dvec2 cells_of_unit_{0.0};
    size_t side_ = 1;
    std::vector<uint32_t> first_;  // of corners_, by cell; one more at the end
    std::vector<Corner> corners_;
};

/// Cuts the ears of one island.
class EarCutter {
public:
    EarCutter(const std::vector<glm::dvec2>& points, std::vector<glm::uvec3>& out, const Job& job)
        : points_(points), out_(out), job_(job) {}

    /// The points of a ring have the numbers from `first`. Returns its corner farthest left.
    Corner add(size_t first, size_t count) {
        const auto begin = static_cast<Corner>(list_.size());
        Corner leftmost = begin;
        for (size_t i = 0; i < count; ++i) {
            list_.push_back({static_cast<uint32_t>(first + i),
                             static_cast<Corner>(begin + (i + count - 1) % count),
                             static_cast<Corner>(begin + (i + 1) % count)});
            const glm::dvec2& at = points_[first + i];
            const glm::dvec2& best = point(leftmost);
            if (at.x < best.x || (at.x == best.x && at.y < best.y))
                leftmost = static_cast<Corner>(begin + i);
        }
        return leftmost;
    }

    /// Joins a hole, by its corner farthest left, to what is around it. Holes must come from left
    /// to right.
    void join(Corner outer, Corner hole) {
        const Corner bridge = visible_from(outer, hole);
        if (bridge == kNoCorner)
            return;
        // bridge -> hole ... hole again -> bridge again -> what followed
        const auto hole2 = static_cast<Corner>(list_.size());
        list_.push_back(list_[hole]);
        const auto bridge2 = static_cast<Corner>(list_.size());
        list_.push_back(list_[bridge]);
        list_[list_[hole].previous].next = hole2;
        list_[list_[bridge].next].previous = bridge2;
        list_[bridge].next = hole;
        list_[hole].previous = bridge;
        list_[hole2].next = bridge2;
        list_[bridge2].previous = hole2;
    }

    /// A corner that is no ear becomes one only when a neighbor of it is cut, so that each is
    /// looked at about three times.
    void cut(Corner start) {
        // The rounds in which all corners are looked at again.
        // Law: none is needed but for rings that touch or cross.
        int rounds = 4;
        enum class EarRound : uint8_t { Usual, Again, Forced };
        EarRound round = EarRound::Usual;
        std::vector<uint8_t> no_ear(list_.size(), 0);
        const CornerGrid grid = grid_around(start);
        Corner ear = start;
        Corner stop = start;
        size_t steps = 0;
        while (list_[ear].previous != list_[ear].next) {
            if ((++steps & 0xffu) == 0)
                job_.check();
            const Corner before = list_[ear].previous;
            const Corner after = list_[ear].next;
            const double area = turn(point(before), point(ear), point(after));
            const bool flat = area == 0;
            const bool forced = round == EarRound::Forced;
            if (area > 0 && !forced && no_ear[ear] == 0)
                no_ear[ear] = is_ear(grid, before, ear, after) ? 0 : 1;
            if (flat || (area > 0 && (forced || no_ear[ear] == 0))) {
                if (!flat)
                    out_.emplace_back(list_[before].point, list_[ear].point, list_[after].point);
                list_[before].next = after;
                list_[after].previous = before;
                list_[ear].next = list_[ear].previous = ear;  // it is cut
                no_ear[before] = no_ear[after] = 0;
                stop = after;
                round = EarRound::Usual;
                ear = after;
                continue;
            }
            ear = after;
            if (ear != stop)
                continue;
            if (forced)
                return;  // the rest has no corner that turns outward
            if (round == EarRound::Usual && rounds-- > 0) {
                round = EarRound::Again;
                std::fill(no_ear.begin(), no_ear.end(), uint8_t{0});
            } else {
                round = EarRound::Forced;  // rings that cross: whatever comes first
            }
        }
    }

private:
    static constexpr Corner kNoCorner = ~Corner{0};  // Law: no list is so long.

    const glm::dvec2& point(Corner corner) const { return points_[list_[corner].point]; }

    CornerGrid grid_around(Corner start) const {
        std::vector<Corner> corners;
        Ring places;
        Corner i = start;
        do {
            corners.push_back(i);
            places.push_back(point(i));
            i = list_[i].next;
        } while (i != start);
        return {corners, places};
    }

    bool is_ear(const CornerGrid& grid, Corner before, Corner ear, Corner after) const {
        const glm::dvec2& a = point(before);
        const glm::dvec2& b = point(ear);
        const glm::dvec2& c = point(after);
        const RingBox box{{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})},
                          {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})}};
        return !grid.any(box, [&](Corner i) {
            const glm::dvec2& p = point(i);
            if (p.x < box.low.x || p.x > box.high.x || p.y < box.low.y || p.y > box.high.y)
                return false;
            if (list_[i].next == i || p == a || p == b || p == c)
                return false;
            return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0 &&
                   turn(point(list_[i].previous), p, point(list_[i].next)) <= 0;
        });
    }

    /// Whether the direction to `to` lies within the corner.
    bool within(Corner corner, const glm::dvec2& to) const {
        const glm::dvec2& at = point(corner);
        const glm::dvec2& before = point(list_[corner].previous);
        const glm::dvec2& after = point(list_[corner].next);
        if (turn(before, at, after) < 0)
            return turn(at, to, before) >= 0 || turn(at, after, to) >= 0;
        return turn(at, to, before) >= 0 && turn(at, after, to) >= 0;
    }

    /// The corner around a hole that its leftmost corner sees (Eberly: Triangulation by ear
    /// clipping, 2008).
    Corner visible_from(Corner outer, Corner hole) const {
        const glm::dvec2& from = point(hole);
        double best = -kInfinity;
        Corner found = kNoCorner;
        Corner i = outer;
        do {
            const Corner next = list_[i].next;
            const glm::dvec2& a = point(i);
            const glm::dvec2& b = point(next);
            // The inside is to the left, so what is seen to the left runs downward.
            if (from.y <= a.y && from.y >= b.y && a.y != b.y) {
                const double x = a.x + (from.y - a.y) * (b.x - a.x) / (b.y - a.y);
                if (x <= from.x && x > best) {
                    best = x;
                    found = a.x < b.x ? i : next;
                }
            }
            i = next;
        } while (i != outer);
        if (found == kNoCorner)
            return found;
        // Corners that stand between: the one at the least angle is seen.
        const glm::dvec2 hit(best, from.y);
        const glm::dvec2 tip = point(found);
        double least = kInfinity;
        const Corner stop = found;
        i = stop;
        do {
            const glm::dvec2& p = point(i);
            if (p.x <= from.x && p.x >= tip.x && p.x != from.x && in_triangle(hit, from, tip, p)) {
                const double slope = std::abs(from.y - p.y) / (from.x - p.x);
                if ((slope < least || (slope == least && p.x > point(found).x)) &&
                    within(i, from)) {
                    found = i;
                    least = slope;
                }
            }
            i = list_[i].next;
        } while (i != stop);
        return found;
    }

    static bool in_triangle(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                            const glm::dvec2& p) {
        const double ab = turn(a, b, p);
        const double bc = turn(b, c, p);
        const double ca = turn(c, a, p);
        return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
    }

    const std::vector<glm::dvec2>& points_;
    std::vector<glm::uvec3>& out_;
    const Job& job_;
    std::vector<ListedCorner> list_;
};

/// Turns inner edges until all are locally Delaunay (Lawson 1977).
class EdgeTurner {
public:
    EdgeTurner(const std::vector<glm::dvec2>& points, std::vector<glm::uvec3>& triangles)
        : points_(points), triangles_(triangles) {}

    void run(const std::vector<size_t>& ring_starts) {
        for (size_t r = 0; r + 1 < ring_starts.size(); ++r) {
            const size_t begin = ring_starts[r];
            const size_t count = ring_starts[r + 1] - begin;
            for (size_t i = 0; i < count; ++i)
                edges_[key(static_cast<uint32_t>(begin + i),
                           static_cast<uint32_t>(begin + (i + 1) % count))]
                    .fixed = true;
        }
        std::vector<uint64_t> waiting;
        for (uint32_t t = 0; t < triangles_.size(); ++t) {
            for (int k = 0; k < 3; ++k) {
                const uint64_t edge = key(triangles_[t][k], triangles_[t][(k + 1) % 3]);
                TurnedEdge& sides = edges_[edge];
                if (sides.count < 2)
                    sides.triangles[sides.count] = t;
                ++sides.count;
                if (sides.count == 2 && !sides.fixed)
                    waiting.push_back(edge);
            }
        }
        // The turns of an edge on average.
        // Law: Lawson's turns end; rounding could make them go around, and this ends them.
        constexpr size_t kTurns = 16;
        for (size_t left = kTurns * waiting.size(); left > 0 && !waiting.empty(); --left) {
            const uint64_t edge = waiting.back();
            waiting.pop_back();
            turn_edge(edge, waiting);
        }
    }

private:
    struct TurnedEdge {
        std::array<uint32_t, 2> triangles{};
        int count = 0;
        bool fixed = false;
    };

    static uint64_t key(uint32_t a, uint32_t b) {
        return uint64_t{std::min(a, b)} << 32u | std::max(a, b);
    }

    static int opposite(const glm::uvec3& triangle, uint32_t a, uint32_t b) {
        for (int k = 0; k < 3; ++k) {
            if (triangle[k] != a && triangle[k] != b)
                return k;
        }
        return 0;
    }

    void turn_edge(uint64_t edge, std::vector<uint64_t>& waiting) {
        const TurnedEdge sides = edges_[edge];
        if (sides.fixed || sides.count != 2)
            return;
        const auto [one, two] = sides.triangles;
        const auto a = static_cast<uint32_t>(edge >> 32u);
        const auto b = static_cast<uint32_t>(edge);
        const int k = opposite(triangles_[one], a, b);
        const uint32_t c = triangles_[one][k];
        const uint32_t from = triangles_[one][(k + 1) % 3];
        const uint32_t to = triangles_[one][(k + 2) % 3];
        const uint32_t d = triangles_[two][opposite(triangles_[two], a, b)];
        // Triangle `one` is (c, from, to), `two` is (d, to, from).
        if (!(turn(points_[c], points_[from], points_[d]) > 0) ||
            !(turn(points_[c], points_[d], points_[to]) > 0) || !in_circle(c, from, to, d))
            return;
        if (edges_[key(c, d)].count != 0)
            return;
        triangles_[one] = {c, from, d};
        triangles_[two] = {c, d, to};
        edges_.erase(edge);
        edges_[key(c, d)] = {{one, two}, 2, false};
        replace(key(from, d), two, one);
        replace(key(c, to), one, two);
        for (const uint64_t next : {key(c, from), key(from, d), key(d, to), key(to, c)})
            waiting.push_back(next);
    }

    void replace(uint64_t edge, uint32_t old, uint32_t fresh) {
        TurnedEdge& sides = edges_[edge];
        for (uint32_t& triangle : sides.triangles) {
            if (triangle == old) {
                triangle = fresh;
                return;
            }
        }
    }

    bool in_circle(uint32_t a, uint32_t b, uint32_t c, uint32_t p) const {
        const glm::dvec2 u = points_[a] - points_[p];
        const glm::dvec2 v = points_[b] - points_[p];
        const glm::dvec2 w = points_[c] - points_[p];
        const double uu = glm::dot(u, u);
        const double vv = glm::dot(v, v);
        const double ww = glm::dot(w, w);
        const double inside = uu * (v.x * w.y - v.y * w.x) - vv * (u.x * w.y - u.y * w.x) +
                              ww * (u.x * v.y - u.y * v.x);
        // Rounding must not turn an edge back and forth.
        constexpr double kSure = 1e-12;  // Law: some thousands of a double's steps.
        return inside > kSure * (uu + vv + ww) * (uu + vv + ww);
    }

    const std::vector<glm::dvec2>& points_;
    std::vector<glm::uvec3>& triangles_;
    std::unordered_map<uint64_t, TurnedEdge> edges_;
};

}  // namespace

double PlaneTriangles::area() const {
    double twice = 0;
    for (const glm::uvec3& t : triangles)
        twice += turn(points[t.x], points[t.y], points[t.z]);
    return twice / 2;
}

PlaneTriangles triangulated(const std::vector<Ring>& rings, const Job& job) {
    PlaneTriangles out;
    std::vector<size_t> starts{0};
    std::vector<RingBox> boxes;
    std::vector<double> areas;
    for (const Ring& ring : rings) {
        out.points.insert(out.points.end(), ring.begin(), ring.end());
        starts.push_back(out.points.size());
        boxes.push_back(box_of(ring));
        areas.push_back(signed_area(ring));
    }
    // A hole belongs to the smallest island around it.
    constexpr size_t kNone = ~size_t{0};  // Law: no ring has this number.
    std::vector<std::vector<size_t>> holes(rings.size());
    for (size_t i = 0; i < rings.size(); ++i) {
        if (!(areas[i] < 0))
            continue;
        size_t best = kNone;
        for (size_t j = 0; j < rings.size(); ++j) {
            if (areas[j] > -areas[i] && (best == kNone || areas[j] < areas[best]) &&
                boxes[j].low.x <= boxes[i].low.x && boxes[j].high.x >= boxes[i].high.x &&
                boxes[j].low.y <= boxes[i].low.y && boxes[j].high.y >= boxes[i].high.y &&
                contains(rings[j], rings[i].front()))
                best = j;
        }
        if (best != kNone)
            holes[best].push_back(i);
    }
    for (size_t i = 0; i < rings.size(); ++i) {
        if (!(areas[i] > 0))
            continue;
        EarCutter cutter(out.points, out.triangles, job);
        const Corner outer = cutter.add(starts[i], rings[i].size());
        std::sort(holes[i].begin(), holes[i].end(), [&](size_t a, size_t b) {
            return std::pair(boxes[a].low.x, a) < std::pair(boxes[b].low.x, b);
        });
        for (const size_t hole : holes[i])
            cutter.join(outer, cutter.add(starts[hole], rings[hole].size()));
        cutter.cut(outer);
    }
    EdgeTurner(out.points, out.triangles).run(starts);
    return out;
}

}  // namespace lodestone
