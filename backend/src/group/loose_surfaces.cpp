// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/loose_surfaces.h"

#include "base/disjoint_sets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <tuple>

namespace lodestone::group {
namespace {

/// Faces of one edge that are told apart.
/// Taste: a larger value tells denser fans apart, for time that grows with its square.
constexpr size_t kMostAround = 64;

/// A triangle's edge.
struct EdgeSide {
    uint64_t edge;  // the two welded vertices, the lower one first
    uint32_t triangle;
    uint32_t opposite;  // the opposite vertex
    bool forward;       // the triangle goes around the edge from the lower vertex to the higher
    double angle = 0;   // the angle around the edge
};

/// Joins faces where several surfaces meet in one edge: a face goes on in the first one that closes
/// the same solid. Boxes that touch stay apart, and so do the two sides of a sheet.
template <typename Join>
void join_surfaces(const Mesh& mesh, std::span<EdgeSide> around, const Join& join) {
    // Faces within this angle in radians lie in one plane.
    // Taste: rounding of positions turns faces by less; a larger value joins wedges.
    constexpr double kSamePlane = 1e-4;
    // Law: a full turn in radians.
    constexpr double kTurn = 2 * std::numbers::pi;
    const glm::dvec3 from(mesh.positions[around[0].edge >> 32u]);
    const glm::dvec3 to(mesh.positions[around[0].edge & 0xffffffffu]);
    const glm::dvec3 axis = to - from;
    const double length = glm::length(axis);
    if (!(length > 0) || !std::isfinite(length))
        return;
    const glm::dvec3 along = axis / length;
    const glm::dvec3 off = std::abs(along.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(along, off));
    const glm::dvec3 up = glm::cross(along, right);
    for (EdgeSide& side : around) {
        const glm::dvec3 arm = glm::dvec3(mesh.positions[side.opposite]) - from;
        side.angle = std::atan2(glm::dot(arm, up), glm::dot(arm, right));
    }
    // A face that goes forward has its inside on the side where angles fall.
    const auto inside = [&](const EdgeSide& face, const EdgeSide& other) {
        const double turn = std::fmod(face.angle - other.angle + kTurn, kTurn);
        return turn < kSamePlane ? turn + kTurn : turn;
    };
    for (const EdgeSide& face : around) {
        if (!face.forward)
            continue;
        double least = std::numeric_limits<double>::infinity();
        for (const EdgeSide& other : around) {
            if (!other.forward)
                least = std::min(least, inside(face, other));
        }
        for (const EdgeSide& other : around) {
            if (!other.forward && inside(face, other) < least + kSamePlane)
                join(face, other);
        }
    }
}

}  // namespace

std::vector<uint32_t> loose_parts(const Mesh& mesh) {
    const std::vector<uint32_t> welded = weld(mesh);
    std::vector<EdgeSide> sides;
    sides.reserve(3 * mesh.triangles.size());
    std::vector<uint32_t> parents(mesh.triangles.size());
    std::iota(parents.begin(), parents.end(), 0u);
    for (uint32_t i = 0; i < parents.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            const Triangle& t = mesh.triangles[i];
            const uint64_t a = welded[t[corner]];
            const uint64_t b = welded[t[(corner + 1) % 3]];
            sides.push_back(
                {std::min(a, b) << 32u | std::max(a, b), i, t[(corner + 2) % 3], a < b});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const EdgeSide& a, const EdgeSide& b) {
        return std::tie(a.edge, a.triangle) < std::tie(b.edge, b.triangle);
    });
    const auto join_sides = [&](const EdgeSide& x, const EdgeSide& y) {
        join(parents, x.triangle, y.triangle);
    };
    for (size_t begin = 0; begin < sides.size();) {
        size_t end = begin + 1;
        while (end < sides.size() && sides[end].edge == sides[begin].edge)
            ++end;
        const std::span<EdgeSide> around(&sides[begin], end - begin);
        if (around.size() <= 3) {
            for (const EdgeSide& side : around.subspan(1))
                join_sides(around[0], side);
        } else if (around.size() <= kMostAround) {
            join_surfaces(mesh, around, join_sides);
        }
        begin = end;
    }
    uint32_t next = 0;
    std::vector<uint32_t> numbers(parents.size());
    for (uint32_t i = 0; i < parents.size(); ++i) {
        const uint32_t root = root_of(parents, i);  // never after i
        numbers[i] = root == i ? next++ : numbers[root];
    }
    return numbers;
}

}  // namespace lodestone::group
