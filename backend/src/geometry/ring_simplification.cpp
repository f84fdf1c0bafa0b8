// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/ring_simplification.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <tuple>

namespace lodestone {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

double square_distance(const glm::dvec2& point, const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 along = b - a;
    const double square = glm::dot(along, along);
    const double at = square > 0 ? std::clamp(glm::dot(point - a, along) / square, 0.0, 1.0) : 0;
    const glm::dvec2 away = point - a - at * along;
    return glm::dot(away, away);
}

/// The place where the line through `a` along `along` meets the line through `b` along `other`.
std::optional<glm::dvec2> meeting(const glm::dvec2& a, const glm::dvec2& along, const glm::dvec2& b,
                                  const glm::dvec2& other) {
    const double turn = cross(along, other);
    // The sine of the least angle between the lines.
    // Taste: a smaller one makes corners far away, which the tolerance refuses anyway.
    constexpr double kLeastTurn = 1e-6;
    if (!(std::abs(turn) > kLeastTurn * glm::length(along) * glm::length(other)))
        return {};
    return a + cross(b - a, other) / turn * along;
}

/// The sides of the frame that a point is on, a bit each.
unsigned sides_of(const glm::dvec2& at, const RingFrame& frame) {
    return (at.x == 0 ? 1u : 0u) | (at.x == frame.width ? 2u : 0u) | (at.y == 0 ? 4u : 0u) |
           (at.y == frame.height ? 8u : 0u);
}

/// Whether a point lies on the way from one to another, where nothing needs it.
bool is_between(const glm::dvec2& before, const glm::dvec2& at, const glm::dvec2& after,
                const RingFrame& frame) {
    const unsigned sides = sides_of(at, frame);
    if (sides != 0)
        return (sides & sides_of(before, frame) & sides_of(after, frame)) != 0;
    // The distance from a line, as a part of its length, of a point that is on it.
    // Law: some steps of a double; points between two texels are rounded by as much.
    constexpr double kOnLine = 1e-12;
    const glm::dvec2 along = after - before;
    return glm::dot(at - before, after - at) >= 0 &&
           std::abs(cross(at - before, along)) <= kOnLine * glm::dot(along, along);
}

/// The ring without points between others on one straight line, of which no step of RingCollapser
/// can tell where their one corner were.
Ring without_between(const Ring& ring, const RingFrame& frame) {
    Ring out;
    size_t left = ring.size();
    for (size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2& before = out.empty() ? ring.back() : out.back();
        const glm::dvec2& after = ring[(i + 1) % ring.size()];
        if (left > 3 && is_between(before, ring[i], after, frame))
            --left;
        else
            out.push_back(ring[i]);
    }
    return out;
}

class RingCollapser {
public:
    RingCollapser(const Ring& ring, double tolerance, const RingFrame& frame)
        : ring_(ring), square_(tolerance * tolerance) {
        const auto count = static_cast<uint32_t>(ring.size());
        corners_.resize(count);
        for (uint32_t i = 0; i < count; ++i)
            corners_[i] = {ring[i],
                           (i + count - 1) % count,
                           (i + 1) % count,
                           i,
                           0,
                           sides_of(ring[i], frame) != 0,
                           true};
        left_ = count;
    }

    Ring run() {
        for (uint32_t i = 0; i < corners_.size(); ++i) {
            if (corners_[i].alive)
                push(i);
        }
        while (!queue_.empty()) {
            const Collapse best = queue_.top();
            queue_.pop();
            const uint32_t b = best.corner;
            const uint32_t c = corners_[b].next;
            // The window has changed since, or there are too few corners left.
            if (!corners_[b].alive || best.version != corners_[b].version || left_ < 4)
                continue;
            RingListCorner& kept = corners_[b];
            kept.at = best.at;
            kept.origin = best.origin;
            kept.next = corners_[c].next;
            corners_[c].alive = false;
            corners_[kept.next].previous = b;
            --left_;
            const uint32_t a = kept.previous;
            // These edges have one of the two in their window.
            for (const uint32_t first : {corners_[a].previous, a, b, kept.next})
                push(first);
        }
        Ring out;
        for (const RingListCorner& corner : corners_) {
            if (corner.alive)
                out.push_back(corner.at);
        }
        return out;
    }

private:
    struct RingListCorner {
        glm::dvec2 at;
        uint32_t previous;
        uint32_t next;
        uint32_t origin;   // the point of the given ring that it stands for
        uint32_t version;  // of what the queue holds of the edge to the next corner
        bool fixed;
        bool alive;
    };
    /// The edge from a corner to the next one as one corner `at`.
    struct Collapse {
        double square;
        uint32_t corner;
        uint32_t version;
        glm::dvec2 at;
        uint32_t origin;
        bool operator<(const Collapse& other) const {  // the queue's top is the largest
            return std::tie(square, corner, version) >
                   std::tie(other.square, other.corner, other.version);
        }
    };

    void push(uint32_t b) {
        ++corners_[b].version;
        if (left_ < 4)
            return;
        const RingListCorner& first = corners_[b];
        const RingListCorner& second = corners_[first.next];
        if (first.fixed || second.fixed)
            return;
        const RingListCorner& before = corners_[first.previous];
        const RingListCorner& after = corners_[second.next];
        const glm::dvec2 base = after.at - before.at;
        const double size = glm::length(base);
        if (!(size > 0))
            return;
        // All places on one line parallel to the base give the same area.
        const double twice =
            cross(first.at - before.at, second.at - before.at) + cross(second.at - before.at, base);
        const glm::dvec2 on_line =
            before.at + glm::dvec2(base.y, -base.x) * (twice / (size * size));
        std::optional<Collapse> best;
        for (const auto& [from, along] : {std::pair(before.at, first.at - before.at),
                                          std::pair(after.at, second.at - after.at)}) {
            const std::optional<glm::dvec2> at = meeting(on_line, base, from, along);
            if (!at)
                continue;
            const Collapse found = priced(b, *at, before, after);
            if (found.square <= square_ && (!best || found.square < best->square))
                best = found;
        }
        if (best)
            queue_.push(*best);
    }

    /// The square of the largest distance between the new corner's two edges and the points of the
    /// given ring that they replace, and between the corner and that ring.
    Collapse priced(uint32_t b, const glm::dvec2& at, const RingListCorner& before,
                    const RingListCorner& after) const {
        const RingListCorner& first = corners_[b];
        const uint32_t last = corners_[first.next].origin;
        Collapse out{0, b, first.version, at, first.origin};
        const auto count = static_cast<uint32_t>(ring_.size());
        double nearest = kFar;
        double nearest_origin = kFar;
        bool own = false;  // between the two corners that become one
        for (uint32_t i = before.origin;; i = (i + 1) % count) {
            const glm::dvec2& point = ring_[i];
            out.square = std::max(out.square, std::min(square_distance(point, before.at, at),
                                                       square_distance(point, at, after.at)));
            if (out.square > square_)
                return out;
            own = own || i == first.origin;
            const double away = glm::dot(at - point, at - point);
            if (own && away < nearest_origin) {
                nearest_origin = away;
                out.origin = i;
            }
            own = own && i != last;
            if (i == after.origin)
                break;
            nearest = std::min(nearest, square_distance(at, point, ring_[(i + 1) % count]));
        }
        out.square = std::max(out.square, nearest);
        return out;
    }

    static constexpr double kFar = 1e300;  // Law: no square of a distance is larger.

    const Ring& ring_;
    double square_;
    std::vector<RingListCorner> corners_;
    size_t left_ = 0;
    std::priority_queue<Collapse> queue_;
};

}  // namespace

Ring simplified(const Ring& ring, double tolerance, const RingFrame& frame) {
    if (ring.size() < 4)
        return ring;
    return RingCollapser(without_between(ring, frame), tolerance, frame).run();
}

}  // namespace lodestone
