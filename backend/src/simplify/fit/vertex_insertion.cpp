// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/vertex_insertion.h"

#include "simplify/fit/distance_outliers.h"

#include <algorithm>

namespace lodestone::simplify {
namespace {

// The most triangles around a changed vertex.
// Taste: more take longer at hubs.
constexpr size_t kMostInsertRing = 32;
/// The limits of a place's barycentric coordinates: above the first it is at the corner, below the
/// second on the edge.
/// Taste: a larger limit moves fewer vertices and inserts more.
constexpr float kAtCorner = 0.75f;
// Taste: a larger limit splits more edges, whose triangles are less slender.
constexpr float kOnEdge = 0.15f;
/// The surroundings of a changed place must miss less than this times what they did.
/// Taste: a larger factor inserts more vertices for less.
constexpr float kBetter = 0.8f;
/// Misses that grow by less than this factor count as unchanged.
/// Law: rounding of single precision, with a large margin.
constexpr float kRounding = 1.01f;
/// Twice the area over the square of the longest edge: thinner triangles are not made.
/// Taste: a larger number refuses more places and leaves fewer slivers.
constexpr float kThinnest = 4e-3f;
/// The places that are tried, for each vertex that may be inserted.
/// Taste: more insert more of the vertices that may be, more slowly.
constexpr size_t kTried = 8;

class VertexInserter {
public:
    VertexInserter(FitPlaces& places, const Adjacency& adjacency, const FitSamples& samples,
                   const Job& job)
        : places_(places),
          mesh_(places.mesh()),
          adjacency_(adjacency),
          points_(places.points()),
          strays_(places, adjacency, samples, job),
          touched_(places.mesh().triangles.size(), 0) {}
    size_t insert(size_t most, const Job& job);

private:
    bool free(std::span<const uint32_t> triangles) const {
        return std::none_of(triangles.begin(), triangles.end(),
                            [&](uint32_t t) { return touched_[t] != 0; });
    }
    bool fits(const DistanceOutlier& stray, const glm::vec3& point,
              const geometry::TrianglePoints& after, uint32_t was) const;
    bool better(const DistanceOutlier& stray, const glm::vec3& point,
                std::span<const uint32_t> before, std::span<const geometry::TrianglePoints> after,
                std::span<const uint32_t> was) const;
    bool move_corner(const DistanceOutlier& stray, uint32_t vertex, float part);
    bool split_edge(const DistanceOutlier& stray, int corner);
    bool split_triangle(const DistanceOutlier& stray);
    uint32_t add_vertex(const DistanceOutlier& stray, uint32_t beside);
    uint32_t add_wedge(const Triangle& wedges, const glm::vec3& weights);
    void add_triangle(const Triangle& t, const Triangle& wedges, uint32_t like);
    void refresh(uint32_t triangle) {
        mesh_.facets[triangle] = glm::vec3(mesh_.facet_of(mesh_.triangles[triangle]));
    }

    FitPlaces& places_;
    CollapseMesh& mesh_;
    const Adjacency& adjacency_;
    std::vector<glm::vec3>& points_;
    DistanceOutliers strays_;
    std::vector<uint8_t> touched_;  // by triangle: its surroundings are out of date
};

/// Whether a triangle is not thin, not turned over and not far from the original, nor are its edges
/// at `point`; `was`: the triangle it replaces.
bool VertexInserter::fits(const DistanceOutlier& stray, const glm::vec3& point,
                          const geometry::TrianglePoints& after, uint32_t was) const {
    const float limit = kBetter * kBetter * stray.square;
    const auto& [a, b, c] = after;
    const glm::vec3 facet = glm::cross(b - a, c - a);
    const float square = glm::dot(facet, facet);
    const float longest =
        std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
    if (!(square >= kThinnest * kThinnest * longest * longest))
        return false;
    const geometry::TriangleSpot middle = strays_.walk((a + b + c) * (1.0f / 3), stray.source);
    if (!(middle.square <= stray.square))
        return false;
    const auto agrees = [&](const glm::vec3& normal) {
        const float dot = glm::dot(facet, normal);
        return dot > 0 && 4 * dot * dot >= square * glm::dot(normal, normal);
    };
    const geometry::TrianglePoints under = strays_.original(middle.triangle);
    if (!agrees(mesh_.facets[was]) && !agrees(glm::cross(under[1] - under[0], under[2] - under[0])))
        return false;
    for (int k = 0; k < 3; ++k) {
        const glm::vec3& from = after[static_cast<size_t>(k)];
        const glm::vec3& to = after[static_cast<size_t>((k + 1) % 3)];
        if ((from == point || to == point) &&
            !(strays_.walk(0.5f * (from + to), stray.source).square <= limit))
            return false;
    }
    return true;
}

/// Whether the triangles `after`, of which `point` is new, fit, and the original's vertices nearest
/// to `before` then miss less.
bool VertexInserter::better(const DistanceOutlier& stray, const glm::vec3& point,
                            std::span<const uint32_t> before,
                            std::span<const geometry::TrianglePoints> after,
                            std::span<const uint32_t> was) const {
    for (size_t i = 0; i < after.size(); ++i) {
        if (!fits(stray, point, after[i], was[i]))
            return false;
    }
    const float limit = kBetter * kBetter * stray.square;
    for (const uint32_t t : before) {
        for (const uint32_t v : strays_.on(t)) {
            const glm::vec3 missed = places_.original(v);
            float least = 1e30f;
            for (const geometry::TrianglePoints& c : after)
                least = std::min(least, geometry::nearest_spot(c, missed).square);
            if (!(least <= limit) &&
                !(least <= kRounding * strays_.square_of(v) && v != stray.vertex))
                return false;
        }
    }
    return true;
}

bool VertexInserter::move_corner(const DistanceOutlier& stray, uint32_t vertex, float part) {
    const glm::vec3 to = points_[vertex] + part * (stray.point - points_[vertex]);
    const std::span<const uint32_t> around = adjacency_.around(vertex);
    if (around.size() > kMostInsertRing || !free(around))
        return false;
    std::vector<geometry::TrianglePoints> after;
    for (const uint32_t t : around) {
        after.push_back(strays_.corners(t));
        for (int k = 0; k < 3; ++k) {
            if (mesh_.triangles[t][k] == vertex)
                after.back()[static_cast<size_t>(k)] = to;
        }
    }
    if (!better(stray, to, around, after, around))
        return false;
    points_[vertex] = to;
    mesh_.points[vertex] = glm::dvec3(to);
    for (const uint32_t t : around) {
        refresh(t);
        touched_[t] = 1;
    }
    return true;
}

uint32_t VertexInserter::add_wedge(const Triangle& wedges, const glm::vec3& weights) {
    const auto mix = [&](auto& values) {
        auto value = values[wedges.x] * weights.x;
        value += values[wedges.y] * weights.y;
        value += values[wedges.z] * weights.z;
        values.push_back(value);
        return static_cast<uint32_t>(values.size() - 1);
    };
    uint32_t made = kNone;
    if (!mesh_.normals.empty()) {
        made = mix(mesh_.normals);
        glm::vec3& normal = mesh_.normals.back();
        const float length = glm::length(normal);
        normal = length > 0 ? normal / length : mesh_.normals[wedges.x];
    }
    if (!mesh_.uvs.empty())
        made = mix(mesh_.uvs);
    if (!mesh_.colors.empty())
        made = mix(mesh_.colors);
    return made;
}

uint32_t VertexInserter::add_vertex(const DistanceOutlier& stray, uint32_t beside) {
    const auto vertex = static_cast<uint32_t>(points_.size());
    mesh_.points.emplace_back(stray.point);
    mesh_.parts.push_back(uint32_t{mesh_.parts[beside]});
    points_.push_back(stray.point);
    places_.add(vertex, stray.vertex);
    return vertex;
}

void VertexInserter::add_triangle(const Triangle& t, const Triangle& wedges, uint32_t like) {
    mesh_.triangles.push_back(t);
    mesh_.facets.emplace_back(mesh_.facet_of(t));
    if (!mesh_.wedges.empty())
        mesh_.wedges.push_back(wedges);
    if (!mesh_.slots.empty())
        mesh_.slots.push_back(uint16_t{mesh_.slots[like]});
    ++mesh_.live;
}

bool VertexInserter::split_triangle(const DistanceOutlier& stray) {
    const uint32_t t = stray.triangle;
    if (touched_[t] != 0)
        return false;
    const geometry::TrianglePoints c = strays_.corners(t);
    const glm::vec3& p = stray.point;
    const std::array<geometry::TrianglePoints, 3> after{geometry::TrianglePoints{p, c[1], c[2]},
                                                        geometry::TrianglePoints{c[0], p, c[2]},
                                                        geometry::TrianglePoints{c[0], c[1], p}};
    const std::array<uint32_t, 3> was{t, t, t};
    if (!better(stray, p, std::span(&t, 1), after, was))
        return false;
    const Triangle old = mesh_.triangles[t];
    const uint32_t n = add_vertex(stray, old.x);
    Triangle w(0, 0, 0);
    uint32_t wedge = 0;
    if (!mesh_.wedges.empty()) {
        w = mesh_.wedges[t];
        wedge = add_wedge(w, stray.weights);
        mesh_.wedges[t] = Triangle(wedge, w.y, w.z);
    }
    mesh_.triangles[t] = Triangle(n, old.y, old.z);
    refresh(t);
    add_triangle(Triangle(old.x, n, old.z), Triangle(w.x, wedge, w.z), t);
    add_triangle(Triangle(old.x, old.y, n), Triangle(w.x, w.y, wedge), t);
    touched_[t] = 1;
    return true;
}

bool VertexInserter::split_edge(const DistanceOutlier& stray, int corner) {
    // The edge runs from a to b in the first triangle, from b to a in the second.
    std::array<uint32_t, 2> on{stray.triangle, kNone};
    std::array<int, 2> at{corner, 0};
    const uint32_t a = mesh_.triangles[on[0]][corner];
    const uint32_t b = mesh_.triangles[on[0]][(corner + 1) % 3];
    if (adjacency_.valence(a) > kMostInsertRing)
        return false;
    size_t sides = 1;
    for (const uint32_t t : adjacency_.around(a)) {
        // A triangle that was made or changed meanwhile has other neighbors.
        if (touched_[t] != 0)
            return false;
        if (t == on[0])
            continue;
        for (int k = 0; k < 3; ++k) {
            const uint32_t u = mesh_.triangles[t][k];
            const uint32_t w = mesh_.triangles[t][(k + 1) % 3];
            if (!((u == a && w == b) || (u == b && w == a)))
                continue;
            if (u == a || sides == 2)
                return false;
            on[1] = t;
            at[1] = k;
            sides = 2;
        }
    }
    std::array<geometry::TrianglePoints, 4> after;
    std::array<uint32_t, 4> was{};
    for (size_t i = 0; i < sides; ++i) {
        after[2 * i] = after[2 * i + 1] = strays_.corners(on[i]);
        after[2 * i][static_cast<size_t>((at[i] + 1) % 3)] = stray.point;
        after[2 * i + 1][static_cast<size_t>(at[i])] = stray.point;
        was[2 * i] = was[2 * i + 1] = on[i];
    }
    if (!better(stray, stray.point, std::span(on).first(sides), std::span(after).first(2 * sides),
                was))
        return false;
    const float sum = stray.weights[corner] + stray.weights[(corner + 1) % 3];
    const float of_a = sum > 0 ? stray.weights[corner] / sum : 0.5f;
    const uint32_t n = add_vertex(stray, a);
    const Triangle first = mesh_.wedges.empty() ? Triangle(0, 0, 0) : mesh_.wedges[stray.triangle];
    uint32_t shared = kNone;
    for (size_t i = 0; i < sides; ++i) {
        const uint32_t t = on[i];
        const int from = at[i];
        const int to = (from + 1) % 3;
        Triangle fresh = mesh_.triangles[t];
        Triangle wedges(0, 0, 0);
        if (!mesh_.wedges.empty()) {
            wedges = mesh_.wedges[t];
            const bool same =
                i == 1 && wedges[from] == first[(corner + 1) % 3] && wedges[to] == first[corner];
            glm::vec3 weights(0.0f);
            weights[from] = i == 0 ? of_a : 1 - of_a;
            weights[to] = 1 - weights[from];
            const uint32_t wedge = same ? shared : add_wedge(wedges, weights);
            shared = wedge;
            mesh_.wedges[t][to] = wedge;
            wedges[from] = wedge;
        }
        mesh_.triangles[t][to] = n;
        refresh(t);
        fresh[from] = n;
        add_triangle(fresh, wedges, t);
        touched_[t] = 1;
    }
    return true;
}

size_t VertexInserter::insert(size_t most, const Job& job) {
    const size_t tried = kTried * most;
    std::vector<DistanceOutlier> strays = strays_.list_farthest(tried, job);
    size_t moved = 0;
    size_t inserted = 0;
    for (size_t i = 0; i < strays.size() && inserted < most && i < tried; ++i) {
        DistanceOutlier& stray = strays[i];
        if (touched_[stray.triangle] != 0 || !strays_.confirm(stray) ||
            touched_[stray.triangle] != 0)
            continue;
        const glm::vec3& w = stray.weights;
        const int high = w.x >= w.y ? (w.x >= w.z ? 0 : 2) : (w.y >= w.z ? 1 : 2);
        const int low = w.x <= w.y ? (w.x <= w.z ? 0 : 2) : (w.y <= w.z ? 1 : 2);
        const uint32_t corner = mesh_.triangles[stray.triangle][high];
        if (w[high] > kAtCorner &&
            (move_corner(stray, corner, 1) || move_corner(stray, corner, 0.5f))) {
            ++moved;
            continue;
        }
        if ((w[low] < kOnEdge && split_edge(stray, (low + 1) % 3)) || split_triangle(stray))
            ++inserted;
    }
    return inserted + moved;
}

}  // namespace

size_t insert_vertices(FitPlaces& places, const Adjacency& adjacency, const FitSamples& samples,
                       size_t most, const Job& job) {
    if (most == 0 || samples.empty())
        return 0;
    return VertexInserter(places, adjacency, samples, job).insert(most, job);
}

}  // namespace lodestone::simplify
