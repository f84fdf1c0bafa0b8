// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/strand_tubes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lodestone {
namespace {

// The bend that is straightened, in parts of the strand's largest radius.
// Taste: a larger one saves triangles; 0.25 is half a pixel where the strand is four pixels wide.
constexpr double kStraight = 0.25;
// The parts of a bent segment.
// Taste: more are smoother and more triangles, before straightening.
constexpr int kParts = 4;
// The most points that are straightened together.
// Taste: longer runs keep fewer points; the time grows with their square.
constexpr size_t kLongestRun = 256;
// The sides of a tube.
// Taste: more are rounder and more triangles; strands are a few pixels wide at most.
constexpr uint32_t kSides = 3;
// The distance of the corners from the axis, in radii.
// Law: an equilateral triangle with this one has the perimeter 2 pi r.
constexpr double kWiden = 2 * std::numbers::pi / (3 * std::numbers::sqrt3);
// The most vertices of a mesh.
// Law: indices have 32 bits, and some numbers above are marks.
constexpr uint64_t kMostVertices = uint64_t{1} << 31u;

struct StrandPoint {
    glm::dvec3 point;
    double radius;
};

/// Collects the strand's points that can be drawn: finite, each a little away from the one before.
void collect(const HairStrands& strands, size_t first, size_t count,
             std::vector<StrandPoint>& keys) {
    keys.clear();
    for (size_t i = first; i < first + count; ++i) {
        const glm::dvec3 point(strands.points[i]);
        if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z))
            continue;
        const double given = strands.radii[i];
        const double radius = std::isfinite(given) ? std::max(given, 0.0) : 0.0;
        if (!keys.empty() && keys.back().point == point)
            keys.back().radius = std::max(keys.back().radius, radius);
        else
            keys.push_back({point, radius});
    }
}

/// Bends the line through its keys as Blender draws hair: by Catmull and Rom's curve. The ends
/// continue as they began; radii stay between their neighbors'.
void bend(std::vector<StrandPoint>& keys) {
    if (keys.size() < 3)
        return;
    std::vector<StrandPoint> bent;
    bent.reserve(keys.size() * kParts);
    for (size_t i = 0; i + 1 < keys.size(); ++i) {
        const glm::dvec3& b = keys[i].point;
        const glm::dvec3& c = keys[i + 1].point;
        const glm::dvec3 a = i > 0 ? keys[i - 1].point : 2.0 * b - c;
        const glm::dvec3 d = i + 2 < keys.size() ? keys[i + 2].point : 2.0 * c - b;
        bent.push_back(keys[i]);
        for (int part = 1; part < kParts; ++part) {
            const double t = static_cast<double>(part) / kParts;
            const glm::dvec3 point =
                0.5 * (2.0 * b + t * (c - a) + t * t * (2.0 * a - 5.0 * b + 4.0 * c - d) +
                       t * t * t * (3.0 * (b - c) + d - a));
            bent.push_back({point, keys[i].radius + t * (keys[i + 1].radius - keys[i].radius)});
        }
    }
    bent.push_back(keys.back());
    keys = std::move(bent);
}

/// The distance of a key from the cone between two others.
double distance(const StrandPoint& key, const StrandPoint& from, const StrandPoint& to) {
    const glm::dvec3 along = to.point - from.point;
    const double square = glm::dot(along, along);
    const double part =
        square > 0 ? std::clamp(glm::dot(key.point - from.point, along) / square, 0.0, 1.0) : 0.0;
    const double aside = glm::length(key.point - (from.point + part * along));
    return std::max(aside, std::abs(key.radius - (from.radius + part * (to.radius - from.radius))));
}

/// Keeps the keys where the line bends (Douglas and Peucker); true when there is a tube to draw.
bool straighten(std::vector<StrandPoint>& keys) {
    double widest = 0;
    for (const StrandPoint& key : keys)
        widest = std::max(widest, key.radius);
    if (keys.size() < 2 || !(widest > 0))
        return false;
    std::vector<uint8_t> keep(keys.size(), 0);
    std::vector<std::pair<size_t, size_t>> open;
    for (size_t low = 0; low + 1 < keys.size(); low += kLongestRun) {  // the runs bound the time
        const size_t high = std::min(low + kLongestRun, keys.size() - 1);
        keep[low] = keep[high] = 1;
        open.emplace_back(low, high);
    }
    while (!open.empty()) {
        const auto [low, high] = open.back();
        open.pop_back();
        double worst = kStraight * widest;
        size_t at = 0;
        for (size_t i = low + 1; i < high; ++i) {
            const double here = distance(keys[i], keys[low], keys[high]);
            if (here > worst) {
                worst = here;
                at = i;
            }
        }
        if (at == 0)
            continue;
        keep[at] = 1;
        open.emplace_back(low, at);
        open.emplace_back(at, high);
    }
    size_t kept = 0;
    for (size_t i = 0; i < keys.size(); ++i) {
        if (keep[i] != 0)
            keys[kept++] = keys[i];
    }
    keys.resize(kept);
    return true;
}

glm::dvec3 any_normal_to(const glm::dvec3& way) {
    const glm::dvec3 size = glm::abs(way);
    glm::dvec3 least(1, 0, 0);
    if (size.y < size.x && size.y <= size.z)
        least = {0, 1, 0};
    else if (size.z < size.x && size.z < size.y)
        least = {0, 0, 1};
    return glm::normalize(glm::cross(way, least));
}

class TubeMaker {
public:
    explicit TubeMaker(Mesh& mesh) : mesh_(mesh) {}

    void add(const std::vector<StrandPoint>& keys, uint16_t slot) {
        // Straightening may leave two ends in one place, where the strand returns to its root.
        glm::dvec3 side(0.0);
        TubeRing before;
        for (size_t i = 0; i < keys.size(); ++i) {
            const glm::dvec3 in = i > 0 ? way(keys[i - 1], keys[i]) : glm::dvec3(0.0);
            const glm::dvec3 out = i + 1 < keys.size() ? way(keys[i], keys[i + 1]) : in;
            glm::dvec3 tangent = i > 0 ? in + out : out;
            const double length = glm::length(tangent);
            tangent = length > 1e-6 ? tangent / length : out;  // the strand turns back on itself
            if (tangent == glm::dvec3(0.0))
                tangent = {0, 0, 1};
            // The side is carried along, so that the tube does not twist.
            side -= tangent * glm::dot(side, tangent);
            const double left = glm::length(side);
            side = left > 1e-6 ? side / left : any_normal_to(tangent);
            const bool end = i == 0 || i + 1 == keys.size();
            const TubeRing ring = ring_at(keys[i], tangent, side);
            if (i > 0)
                join(before, ring, slot);
            if (end && !ring.point)
                cap(ring, i == 0, slot);
            before = ring;
        }
    }

private:
    struct TubeRing {
        uint32_t first = 0;
        bool point = false;  // the tube has no radius there
    };

    static glm::dvec3 way(const StrandPoint& from, const StrandPoint& to) {
        const glm::dvec3 along = to.point - from.point;
        const double length = glm::length(along);
        return length > 0 ? along / length : glm::dvec3(0.0);
    }

    /// A ring without radius has a vertex for each side, with the normal of that side's middle: a
    /// normal along the tube would shade all of a straight strand as if it turned to its tip.
    TubeRing ring_at(const StrandPoint& key, const glm::dvec3& tangent, const glm::dvec3& side) {
        const auto first = static_cast<uint32_t>(mesh_.positions.size());
        const bool point = !(key.radius > 0);
        const glm::dvec3 other = glm::cross(tangent, side);
        for (uint32_t i = 0; i < kSides; ++i) {
            const double angle = 2 * std::numbers::pi * (i + (point ? 0.5 : 0.0)) / kSides;
            const glm::dvec3 outward = std::cos(angle) * side + std::sin(angle) * other;
            mesh_.positions.emplace_back(key.point + kWiden * key.radius * outward);
            mesh_.normals.emplace_back(outward);
        }
        return {first, point};
    }

    void join(const TubeRing& from, const TubeRing& to, uint16_t slot) {
        for (uint32_t i = 0; i < kSides; ++i) {
            const uint32_t next = (i + 1) % kSides;
            if (!from.point)
                add_triangle({from.first + i, from.first + next, to.first + i}, slot);
            if (!to.point) {
                const uint32_t corner = from.first + (from.point ? i : next);
                add_triangle({corner, to.first + next, to.first + i}, slot);
            }
        }
    }

    void cap(const TubeRing& ring, bool root, uint16_t slot) {
        const uint32_t at = ring.first;
        add_triangle(root ? Triangle(at, at + 2, at + 1) : Triangle(at, at + 1, at + 2), slot);
    }

    void add_triangle(const Triangle& triangle, uint16_t slot) {
        mesh_.triangles.push_back(triangle);
        mesh_.slots.push_back(slot);
    }

    Mesh& mesh_;
};

}  // namespace

Mesh tubes_of(const HairStrands& strands) {
    if (strands.radii.size() != strands.points.size())
        fail(Status::InvalidArgument, strands.points.size(), " points of strands have ",
             strands.radii.size(), " radii");
    if (!strands.uvs.empty() && strands.uvs.size() != strands.counts.size())
        fail(Status::InvalidArgument, strands.counts.size(), " strands have ", strands.uvs.size(),
             " uvs");
    if (!strands.slots.empty() && strands.slots.size() != strands.counts.size())
        fail(Status::InvalidArgument, strands.counts.size(), " strands have ", strands.slots.size(),
             " slots");
    uint64_t sum = 0;
    for (const uint32_t count : strands.counts)
        sum += count;
    if (sum != strands.points.size())
        fail(Status::InvalidArgument, "strands of ", sum, " points in all have ",
             strands.points.size());
    if (sum * kParts * kSides > kMostVertices)
        fail(Status::InvalidArgument, "strands of ", sum, " points are too many for one mesh");
    Mesh mesh;
    TubeMaker maker(mesh);
    std::vector<StrandPoint> keys;
    size_t first = 0;
    for (size_t i = 0; i < strands.counts.size(); ++i) {
        collect(strands, first, strands.counts[i], keys);
        first += strands.counts[i];
        bend(keys);
        if (straighten(keys))
            maker.add(keys, strands.slots.empty() ? uint16_t{0} : strands.slots[i]);
        if (!strands.uvs.empty())
            mesh.uvs.resize(mesh.positions.size(), strands.uvs[i]);
    }
    if (std::all_of(mesh.slots.begin(), mesh.slots.end(), [](uint16_t s) { return s == 0; }))
        mesh.slots.clear();
    return mesh;
}

}  // namespace lodestone
