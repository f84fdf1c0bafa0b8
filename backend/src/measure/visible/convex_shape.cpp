// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/visible/convex_shape.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lodestone::measure {
namespace {

// An edge that rises above its neighbor by less than this share of its length is flat: light at
// this angle is 2 % of the whole.
// Taste: a larger value takes bent surfaces for convex ones, which then lose more light.
constexpr double kGrazing = 0.02;
/// Normals that part by less along an edge, over its length, are parallel.
/// Taste: rounding of normals of 16 bits; a larger value takes curved mirrors for flat ones.
constexpr double kFlatAngle = 1e-3;
/// Heights below this share of the mesh's size are rounding.
/// Taste: some ten times single precision's 6e-8; a larger value flattens fine relief.
constexpr double kFlatSize = 1e-6;
// The directions that gaps are looked for in.
// Taste: a larger value needs a smaller kBetween, for time in proportion.
constexpr int kDirections = 768;
/// Between these directions gaps are at most this factor larger.
/// Fitted: 4,000 random directions each of 24 solids never found more.
constexpr double kBetween = 1.03;

bool usable(const Mesh& mesh) {
    if (mesh.triangles.empty() ||
        (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size()))
        return false;
    return std::all_of(mesh.positions.begin(), mesh.positions.end(), [](const glm::vec3& at) {
        return std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z);
    });
}

/// The corners of the triangles, each once, from a center.
std::vector<glm::dvec3> corners_from(const Mesh& mesh, const glm::dvec3& center) {
    std::vector<uint8_t> used(mesh.positions.size(), 0);
    for (const Triangle& t : mesh.triangles)
        used[t.x] = used[t.y] = used[t.z] = 1;
    std::vector<glm::dvec3> out;
    for (size_t i = 0; i < used.size(); ++i) {
        if (used[i] != 0)
            out.push_back(glm::dvec3(mesh.positions[i]) - center);
    }
    return out;
}

/// A tree that tells how far points reach along a direction, and is asked for hundreds of them. It
/// is our own: libraries have trees for the nearest point, not for the farthest along a direction.
class SupportTree {
public:
    explicit SupportTree(std::vector<glm::dvec3> points) : points_(std::move(points)) {
        if (!points_.empty())
            build(0, points_.size());
    }

    double along(const glm::dvec3& direction) const {
        double most = -std::numeric_limits<double>::infinity();
        if (!parts_.empty())
            look(0, direction, most);
        return most;
    }

private:
    struct SupportNode {
        Box3 box;
        size_t first = 0;
        size_t count = 0;  // 0: an inner node
        std::array<size_t, 2> children{};
    };

    size_t build(size_t first, size_t count) {
        const size_t index = parts_.size();
        SupportNode part{{}, first, count, {}};
        for (size_t i = first; i < first + count; ++i)
            part.box.add(points_[i]);
        parts_.push_back(part);
        if (count <= 16)
            return index;
        const int axis = part.box.longest_axis();
        const auto begin = points_.begin() + static_cast<std::ptrdiff_t>(first);
        const auto half = static_cast<std::ptrdiff_t>(count / 2);
        std::nth_element(
            begin, begin + half, begin + static_cast<std::ptrdiff_t>(count),
            [axis](const glm::dvec3& a, const glm::dvec3& b) { return a[axis] < b[axis]; });
        const size_t low = build(first, count / 2);
        const size_t high = build(first + count / 2, count - count / 2);
        parts_[index].count = 0;
        parts_[index].children = {low, high};
        return index;
    }

    static double most_of(const Box3& box, const glm::dvec3& direction) {
        return glm::dot(glm::max(direction * box.low, direction * box.high), glm::dvec3(1.0));
    }

    void look(size_t index, const glm::dvec3& direction, double& most) const {
        const SupportNode& part = parts_[index];
        for (size_t i = part.first; i < part.first + part.count; ++i)
            most = std::max(most, glm::dot(points_[i], direction));
        if (part.count > 0)
            return;
        std::array<size_t, 2> order = part.children;
        std::array<double, 2> reach{most_of(parts_[order[0]].box, direction),
                                    most_of(parts_[order[1]].box, direction)};
        if (reach[1] > reach[0]) {
            std::swap(order[0], order[1]);
            std::swap(reach[0], reach[1]);
        }
        for (size_t i = 0; i < 2; ++i) {
            if (reach[i] > most)
                look(order[i], direction, most);
        }
    }

    std::vector<glm::dvec3> points_;
    std::vector<SupportNode> parts_;
};

/// A directed edge of a triangle between welded vertices.
struct WeldedEdge {
    uint32_t low, high;
    uint32_t triangle;
    bool forward;  // runs from low to high

    bool operator<(const WeldedEdge& other) const {
        return low != other.low ? low < other.low : high < other.high;
    }
};

class ConvexityTest {
public:
    explicit ConvexityTest(const Mesh& mesh) : mesh_(mesh), welded_(weld(mesh)) {
        Box3 box;
        for (const Triangle& t : mesh.triangles) {
            for (int corner = 0; corner < 3; ++corner)
                box.add(at(t[corner]));
        }
        size_ = glm::length(box.size());
        middle_ = box.center();
        for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
            add(i);
        std::sort(edges_.begin(), edges_.end());
    }

    /// Whether every edge is used twice, in opposite directions.
    bool closed() const {
        for (size_t i = 0; i < edges_.size(); i += 2) {
            if (i + 1 == edges_.size() || edges_[i] < edges_[i + 1] ||
                edges_[i].forward == edges_[i + 1].forward ||
                (i + 2 < edges_.size() && !(edges_[i] < edges_[i + 2])))
                return false;
        }
        return !edges_.empty();
    }

    /// Whether the mesh is one sphere by Euler's formula: a sphere has two corners more than half
    /// its faces. Two spheres have four more.
    bool sphere() const {
        std::vector<uint8_t> used(welded_.size(), 0);
        for (const WeldedEdge& edge : edges_)
            used[edge.low] = used[edge.high] = 1;
        const auto corners = static_cast<size_t>(std::count(used.begin(), used.end(), 1));
        return 2 * corners == faces_ + 4;
    }

    double volume() const {
        double six = 0;
        for (const Triangle& t : mesh_.triangles)
            six += glm::dot(at(t.x) - middle_, glm::cross(at(t.y) - middle_, at(t.z) - middle_));
        return six / 6;
    }

    /// Whether no edge of a closed mesh rises above the triangles beside it.
    bool convex() const {
        for (size_t i = 0; i + 1 < edges_.size(); i += 2) {
            if (rises(edges_[i], edges_[i + 1]) || rises(edges_[i + 1], edges_[i]))
                return false;
        }
        return true;
    }

    /// The depth of the deepest corner below the hull, in metres, seen along the mean normal of its
    /// triangles.
    double hollow() const {
        std::vector<glm::dvec3> normals(welded_.size(), glm::dvec3(0.0));
        for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
            const Triangle& t = mesh_.triangles[i];
            const glm::dvec3 area = area_vector(mesh_, i);
            for (const uint32_t corner : {t.x, t.y, t.z})
                normals[welded_[corner]] += area;
        }
        const SupportTree reach(corners_from(mesh_, middle_));
        double most = 0;
        for (uint32_t i = 0; i < normals.size(); ++i) {
            const double length = glm::length(normals[i]);
            if (length > 0) {
                const glm::dvec3 out = normals[i] / length;
                most = std::max(most, reach.along(out) - glm::dot(at(i) - middle_, out));
            }
        }
        return most;
    }

    bool flat() const {
        glm::dvec3 normal(0.0);
        double most = 0;
        for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
            const glm::dvec3 area = area_vector(mesh_, i);
            if (glm::length(area) > most) {
                most = glm::length(area);
                normal = area / most;
            }
        }
        return most > 0 &&
               std::all_of(mesh_.triangles.begin(), mesh_.triangles.end(), [&](const Triangle& t) {
                   return std::abs(glm::dot(normal, at(t.x) - middle_)) <= kFlatSize * size_ &&
                          std::abs(glm::dot(normal, at(t.y) - middle_)) <= kFlatSize * size_ &&
                          std::abs(glm::dot(normal, at(t.z) - middle_)) <= kFlatSize * size_;
               });
    }

    /// Whether normals go apart along every edge as those of a convex solid; `parallel`: they do
    /// neither.
    bool normals_apart(bool parallel) const {
        if (mesh_.normals.empty())
            return true;
        for (const Triangle& t : mesh_.triangles) {
            for (int corner = 0; corner < 3; ++corner) {
                const uint32_t a = t[corner];
                const uint32_t b = t[(corner + 1) % 3];
                const glm::dvec3 way = at(b) - at(a);
                const double apart =
                    glm::dot(glm::dvec3(mesh_.normals[b]) - glm::dvec3(mesh_.normals[a]), way);
                const double least = kFlatAngle * glm::length(way);
                if (apart < -least || (parallel && apart > least))
                    return false;
            }
        }
        return true;
    }

private:
    glm::dvec3 at(uint32_t vertex) const { return glm::dvec3(mesh_.positions[vertex]); }

    void add(uint32_t triangle) {
        const Triangle& t = mesh_.triangles[triangle];
        const std::array<uint32_t, 3> corner{welded_[t.x], welded_[t.y], welded_[t.z]};
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0])
            return;
        ++faces_;
        for (size_t i = 0; i < 3; ++i) {
            const uint32_t from = corner[i];
            const uint32_t to = corner[(i + 1) % 3];
            edges_.push_back({std::min(from, to), std::max(from, to), triangle, from < to});
        }
    }

    /// Whether the far corner of the other triangle is above the plane of this one.
    bool rises(const WeldedEdge& from, const WeldedEdge& to) const {
        const glm::dvec3 area = area_vector(mesh_, from.triangle);
        const double length = glm::length(area);
        if (!(length > 0))
            return false;
        const Triangle& t = mesh_.triangles[to.triangle];
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = welded_[t[corner]];
            if (vertex == from.low || vertex == from.high)
                continue;
            const glm::dvec3 arm = at(vertex) - at(from.low);
            if (glm::dot(area, arm) / length >
                std::max(kGrazing * glm::length(arm), kFlatSize * size_))
                return true;
        }
        return false;
    }

    const Mesh& mesh_;
    std::vector<uint32_t> welded_;
    std::vector<WeldedEdge> edges_;
    size_t faces_ = 0;
    glm::dvec3 middle_{0.0};
    double size_ = 0;
};

/// A box or ellipsoid in its own frame.
struct FramedSolid {
    const Primitive& primitive;
    bool box;

    /// The distance that the solid reaches along a unit direction from its center.
    double reach(const glm::dvec3& direction) const {
        const glm::dvec3 along = glm::transpose(primitive.axes) * direction * primitive.half_size;
        return box ? std::abs(along.x) + std::abs(along.y) + std::abs(along.z) : glm::length(along);
    }
    /// The factor by which the solid must be scaled so that its surface meets a point.
    double scale_to(const glm::dvec3& from_center) const {
        const glm::dvec3 at = glm::transpose(primitive.axes) * from_center / primitive.half_size;
        return box ? std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) : glm::length(at);
    }
    bool sound() const {
        const glm::dvec3& half = primitive.half_size;
        return half.x > 0 && half.y > 0 && half.z > 0 && std::isfinite(half.x + half.y + half.z);
    }
};

/// A direction, evenly spread over the sphere (a spiral of the golden angle).
glm::dvec3 direction(int i) {
    const double z = 1 - (2 * i + 1) / static_cast<double>(kDirections);
    const double across = std::sqrt(std::max(0.0, 1 - z * z));
    return {across * std::cos(kGoldenAngle * i), across * std::sin(kGoldenAngle * i), z};
}

/// The largest difference of the distances that both reach.
double gap(const Mesh& mesh, const FramedSolid& solid, double scale) {
    const glm::dvec3& center = solid.primitive.center;
    const std::vector<glm::dvec3> corners = corners_from(mesh, center);
    const SupportTree reach(corners);
    double most = 0;
    for (int i = 0; i < kDirections; ++i) {
        const glm::dvec3 along = direction(i);
        most = std::max(most, std::abs(reach.along(along) - scale * solid.reach(along)));
    }
    // Parts that jut out between the directions: corners out of the solid, and the solid out of
    // faces.
    for (const glm::dvec3& corner : corners) {
        const double length = glm::length(corner);
        if (length > 0)
            most = std::max(most, length - scale * solid.reach(corner / length));
    }
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::dvec3 area = area_vector(mesh, i);
        const double length = glm::length(area);
        if (!(length > 0))
            continue;
        const glm::dvec3 corner = glm::dvec3(mesh.positions[mesh.triangles[i].x]) - center;
        most = std::max(most, scale * solid.reach(area / length) - glm::dot(corner, area) / length);
    }
    return kBetween * most;
}

}  // namespace

ShapeConvexity convexity_of(const Mesh& mesh) {
    if (!usable(mesh))
        return {};
    const ConvexityTest folds(mesh);
    ShapeConvexity out;
    out.convex = folds.closed() && folds.sphere() && folds.volume() > 0 && folds.convex();
    if (out.convex)
        out.hollow = folds.hollow();
    const bool flat = !out.convex && folds.flat();
    out.flattens = (out.convex || flat) && folds.normals_apart(flat);
    return out;
}

std::optional<ScaledSolid> inside(const Mesh& convex, const Primitive& primitive, bool box) {
    const FramedSolid solid{primitive, box};
    if (!usable(convex) || !solid.sound())
        return std::nullopt;
    double scale = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < convex.triangles.size(); ++i) {
        const glm::dvec3 area = area_vector(convex, i);
        const double length = glm::length(area);
        if (!(length > 0))
            continue;
        const glm::dvec3 along = area / length;
        const double away =
            glm::dot(glm::dvec3(convex.positions[convex.triangles[i].x]) - primitive.center, along);
        scale = std::min(scale, away / solid.reach(along));
    }
    if (!(scale > 0) || !std::isfinite(scale))
        return std::nullopt;
    scale *= 1 - 1e-6;
    return ScaledSolid{scale, gap(convex, solid, scale)};
}

std::optional<ScaledSolid> around(const Mesh& mesh, const Primitive& primitive, bool box) {
    const FramedSolid solid{primitive, box};
    if (!usable(mesh) || !solid.sound())
        return std::nullopt;
    double scale = 0;
    for (const Triangle& t : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner)
            scale = std::max(
                scale, solid.scale_to(glm::dvec3(mesh.positions[t[corner]]) - primitive.center));
    }
    if (!(scale > 0) || !std::isfinite(scale))
        return std::nullopt;
    scale *= 1 + 1e-6;
    return ScaledSolid{scale, gap(mesh, solid, scale)};
}

}  // namespace lodestone::measure
