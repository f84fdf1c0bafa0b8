// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/deviation/surface_samples.h"

#include "base/parallel.h"
#include "base/random.h"

#include <algorithm>
#include <cmath>

namespace lodestone::measure {
namespace {

/// Rays by which a vertex may be seen.
/// Taste: a larger value finds vertices that are seen through narrower gaps.
constexpr int kVertexRays = 16;
/// The rays for a point that is wanted, at most: a mesh may be hard to hit.
/// Taste: a larger value finds more points on such meshes, and takes longer.
constexpr uint32_t kMostRaysPerSample = 16;

double area_of(const Mesh& mesh, size_t triangle) {
    const double area = 0.5 * glm::length(area_vector(mesh, triangle));
    return area > 0 && std::isfinite(area) ? area : 0;
}

glm::dvec3 side_of(const Mesh& mesh, const VisiblePoint& point) {
    const glm::dvec3 area = area_vector(mesh, point.triangle);
    const double length = glm::length(area);
    if (!(length > 0))
        return glm::dvec3(0.0);
    return (glm::dot(area, point.seen_from) < 0 ? -area : area) / length;
}

/// The sample of a point that is seen.
SurfaceSample shown_at(const Mesh& mesh, const SurfaceLooks& surface, const VisiblePoint& point,
                       double weight) {
    SurfaceSample out{point.point, weight};
    out.look = surface.looks.empty() ? uint16_t{0} : surface.looks[point.triangle];
    out.slot = mesh.slot(point.triangle);
    out.side = side_of(mesh, point);
    if (surface.palette == nullptr || surface.looks.empty())
        return out;
    out.color = surface.palette->color(out.look);
    if (!surface.skin || !surface.skin->varies(mesh, out.slot))
        return out;
    out.varies = true;
    out.color = LookPalette::color_of(surface.skin->at(mesh, point.triangle, point.u, point.v));
    if (mesh.uvs.empty())
        return out;
    out.uv = ray::uv_at(mesh, point.triangle, point.u, point.v);
    const Triangle& t = mesh.triangles[point.triangle];
    const glm::dvec2 a(mesh.uvs[t.x]);
    const glm::dvec2 ab = glm::dvec2(mesh.uvs[t.y]) - a;
    const glm::dvec2 ac = glm::dvec2(mesh.uvs[t.z]) - a;
    const double square = std::abs(ab.x * ac.y - ab.y * ac.x) / 2;
    out.metres_per_uv = std::sqrt(area_of(mesh, point.triangle) / square);  // flat: infinite
    return out;
}

/// The triangles around each vertex.
class TrianglesOf {
public:
    explicit TrianglesOf(const Mesh& mesh)
        : first_(mesh.positions.size() + 2, 0), list_(mesh.triangles.size() * 3) {
        for (const Triangle& t : mesh.triangles) {
            for (int corner = 0; corner < 3; ++corner)
                ++first_[t[corner] + 2];
        }
        for (size_t i = 2; i < first_.size(); ++i)
            first_[i] += first_[i - 1];
        for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            for (int corner = 0; corner < 3; ++corner)
                list_[first_[mesh.triangles[i][corner] + 1]++] = i;
        }
    }

    std::span<const uint32_t> operator[](uint32_t vertex) const {
        return std::span(list_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }

private:
    std::vector<uint32_t> first_;
    std::vector<uint32_t> list_;
};

/// Whether the scene shows a triangle at one of its corners, a little inside: at the very corner of
/// a card a repeated picture shows its other side.
bool shows_corner(const Mesh& mesh, const ray::MeshScene& scene, uint32_t triangle,
                  uint32_t vertex) {
    // The share of the way from the corner to the triangle's middle.
    // Taste: a larger value may step over a narrow edge that shows.
    constexpr double kInside = 0.05;
    const Triangle& t = mesh.triangles[triangle];
    const auto weight = [&](uint32_t corner) {
        return kInside / 3 + (corner == vertex ? 1 - kInside : 0);
    };
    return scene.shows(triangle, weight(t.y), weight(t.z));
}

/// Adds points uniform in area, one in each of `count` equal steps along a list of triangles.
template <typename TriangleAt>
void add_samples_of(const Mesh& mesh, const ray::MeshScene& scene, size_t triangles,
                    const TriangleAt& triangle_at, uint32_t count, uint64_t seed,
                    std::vector<SurfaceSample>& out) {
    double all = 0;
    for (size_t i = 0; i < triangles; ++i)
        all += area_of(mesh, triangle_at(i));
    if (!(all > 0) || count == 0)
        return;
    PcgRandom random(scramble(seed), 2);
    const double step = all / count;
    uint32_t taken = 0;
    double up_to = 0;
    double next = random.uniform() * step;
    for (size_t i = 0; i < triangles && taken < count; ++i) {
        const size_t triangle = triangle_at(i);
        up_to += area_of(mesh, triangle);
        while (next < up_to && taken < count) {
            const Triangle& t = mesh.triangles[triangle];
            const glm::dvec3 a(mesh.positions[t.x]);
            const double u = random.uniform();
            const double v = random.uniform();
            const glm::dvec2 weights = uniform_in_triangle(u, v);
            if (scene.shows(static_cast<uint32_t>(triangle), weights.x, weights.y))
                out.push_back({a + weights.x * (glm::dvec3(mesh.positions[t.y]) - a) +
                                   weights.y * (glm::dvec3(mesh.positions[t.z]) - a),
                               step});
            ++taken;
            next = (taken + random.uniform()) * step;
        }
    }
}

}  // namespace

std::vector<WeightedVertex> weighted_vertices(const Mesh& mesh, uint32_t most, uint64_t seed) {
    std::vector<double> weights(mesh.positions.size(), 0);
    double all = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const double third = area_of(mesh, i) / 3;
        all += 3 * third;
        for (int corner = 0; corner < 3; ++corner)
            weights[mesh.triangles[i][corner]] += third;
    }
    std::vector<WeightedVertex> corners;
    for (size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] > 0)
            corners.push_back({static_cast<uint32_t>(i), weights[i]});
    }
    if (corners.size() <= most)
        return corners;
    PcgRandom random(scramble(seed), 1);
    const double step = static_cast<double>(corners.size()) / most;
    double kept = 0;
    for (uint32_t i = 0; i < most; ++i) {
        // The pick is one of each run of `step` vertices; the write position never passes the read
        // position.
        const auto pick = static_cast<size_t>((i + random.uniform()) * step);
        corners[i] = corners[std::min(pick, corners.size() - 1)];
        kept += corners[i].weight;
    }
    corners.resize(most);
    for (WeightedVertex& corner : corners)
        corner.weight *= all / kept;
    return corners;
}

void add_area_samples(const Mesh& mesh, const ray::MeshScene& scene, uint32_t count, uint64_t seed,
                      std::vector<SurfaceSample>& out) {
    add_samples_of(
        mesh, scene, mesh.triangles.size(), [](size_t i) { return i; }, count, seed, out);
}

void add_area_samples(const Mesh& mesh, const ray::MeshScene& scene,
                      std::span<const uint32_t> triangles, uint32_t count, uint64_t seed,
                      std::vector<SurfaceSample>& out) {
    add_samples_of(
        mesh, scene, triangles.size(), [&](size_t i) { return size_t{triangles[i]}; }, count, seed,
        out);
}

void add_box_samples(const Primitive& box, std::vector<SurfaceSample>& out) {
    // The points along an edge.
    // Taste: an odd number, for the middle is farthest from what an open box is made of; more know
    // the sides better, in time in proportion to its square.
    constexpr int kAlong = 5;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        const double area = 4 * box.half_size[u] * box.half_size[v] / (kAlong * kAlong);
        for (int number = 0; number < 2 * kAlong * kAlong; ++number) {
            const int in_row = number % kAlong;
            const int row = number / kAlong % kAlong;
            glm::dvec3 at(0.0);
            at[axis] = number < kAlong * kAlong ? -1 : 1;
            at[u] = (2.0 * in_row + 1) / kAlong - 1;
            at[v] = (2.0 * row + 1) / kAlong - 1;
            out.push_back({box.center + box.axes * (at * box.half_size), area});
        }
    }
}

void add_vertex_samples(const Mesh& mesh, const ray::MeshScene& scene,
                        const std::vector<WeightedVertex>& vertices,
                        std::vector<SurfaceSample>& out) {
    std::vector<uint8_t> hidden(mesh.positions.size(), scene.see_through() ? 1 : 0);
    for (uint32_t i = 0; scene.see_through() && i < mesh.triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = mesh.triangles[i][corner];
            if (hidden[vertex] != 0 && shows_corner(mesh, scene, i, vertex))
                hidden[vertex] = 0;
        }
    }
    for (const WeightedVertex& at : vertices) {
        if (hidden[at.vertex] == 0)
            out.push_back({glm::dvec3(mesh.positions[at.vertex]), at.weight});
    }
}

std::vector<CastPoints> add_visible_points(const Mesh& mesh, const VisibleSampler& sampler,
                                           const SurfaceLooks& surface, uint32_t count,
                                           const Job& job, std::vector<SurfaceSample>& out) {
    const uint64_t most = uint64_t{count} * kMostRaysPerSample;
    std::vector<CastPoints> found;
    std::vector<CastPoints> first;
    std::vector<VisiblePoint> points;
    uint64_t rays = 0;
    uint64_t hits = 0;
    // Behind glass everything can be seen.
    const bool through = surface.skin && surface.skin->transmits();
    const auto cast = [&](uint32_t ray, CastPoints& out_of_ray) {
        if (!through) {
            out_of_ray.count = sampler.cast(ray, out_of_ray.points);
            return;
        }
        const VisiblePoint point = sampler.on_surface(ray);
        out_of_ray.points[0] = point;
        out_of_ray.count = surface.skin->alpha(mesh, point.triangle, point.u, point.v) > 0 ? 1 : 0;
    };
    while (points.size() < count && rays < most) {
        const size_t batch = std::min<uint64_t>(most - rays, std::max<uint32_t>(count / 2, 1));
        found.assign(batch, {});
        parallel_for((batch + kBlock - 1) / kBlock, [&](size_t block) {
            job.check();
            for (size_t i = block * kBlock; i < std::min(batch, (block + 1) * kBlock); ++i)
                cast(static_cast<uint32_t>(rays + i), found[i]);
        });
        for (const CastPoints& ray : found) {
            hits += ray.count > 0 ? 1 : 0;
            for (int i = 0; i < ray.count; ++i)
                points.push_back(ray.points[static_cast<size_t>(i)]);
            if (!through && first.size() < 2 * size_t{count})
                first.push_back(ray);
        }
        rays += batch;
    }
    if (points.empty())
        return first;
    const double visible = (through ? sampler.possible_area() : sampler.reference_area()) *
                           static_cast<double>(hits) / static_cast<double>(rays);
    if (points.size() > count)
        points.resize(count);
    // Along the list of triangles, neighbors are near each other and so are their answers.
    std::stable_sort(
        points.begin(), points.end(),
        [](const VisiblePoint& a, const VisiblePoint& b) { return a.triangle < b.triangle; });
    const double weight = visible / static_cast<double>(points.size());
    // An open sheet is seen from two sides and there once.
    const OutsideSides& sides = sampler.sides();
    for (const VisiblePoint& point : points)
        out.push_back(
            shown_at(mesh, surface, point, (sides.both(point.triangle) ? 0.5 : 1) * weight));
    return first;
}

void add_visible_vertices(const Mesh& mesh, const ray::MeshScene& scene, const OutsideSides& sides,
                          std::span<const uint8_t> seen,
                          const std::vector<WeightedVertex>& vertices, double lift, uint64_t seed,
                          const Job& job, std::vector<SurfaceSample>& out) {
    const TrianglesOf triangles_of(mesh);
    const auto sees = [&](uint32_t vertex, ray::RecentBlockers& blockers) {
        const std::span<const uint32_t> around = triangles_of[vertex];
        if (!seen.empty() && std::none_of(around.begin(), around.end(),
                                          [&](uint32_t triangle) { return seen[triangle] != 0; }))
            return false;
        const glm::dvec3 point(mesh.positions[vertex]);
        PcgRandom random(scramble(seed) + vertex, 3);
        for (int ray = 0; ray < kVertexRays; ++ray) {
            const uint32_t triangle = around[static_cast<uint32_t>(ray) % around.size()];
            const glm::dvec3 area = area_vector(mesh, triangle);
            const double length = glm::length(area);
            const double u = random.uniform();
            const double v = random.uniform();
            const bool coin = (random.next() & 1u) != 0;
            if (!(length > 0) || !shows_corner(mesh, scene, triangle, vertex))
                continue;
            const bool back = sides.both(triangle) ? coin : sides.of[triangle] == VisibleSide::Back;
            const glm::dvec3 outward = (back ? -area : area) / length;
            // A hundredth towards the middle: a ray from the corner itself could slip between the
            // surfaces that meet there.
            const Triangle& t = mesh.triangles[triangle];
            const glm::dvec3 middle =
                (glm::dvec3(mesh.positions[t.x]) + glm::dvec3(mesh.positions[t.y]) +
                 glm::dvec3(mesh.positions[t.z])) /
                3.0;
            const glm::dvec3 origin = point + 0.01 * (middle - point) + lift * outward;
            if (!scene.occluded(origin, cosine_direction(outward, u, v), blockers))
                return true;
        }
        return false;
    };
    std::vector<uint8_t> visible(vertices.size(), 0);
    parallel_for((vertices.size() + kBlock - 1) / kBlock, [&](size_t block) {
        job.check();
        const ray::FlushDenormals burst;
        ray::RecentBlockers blockers;
        for (size_t i = block * kBlock; i < std::min(vertices.size(), (block + 1) * kBlock); ++i)
            visible[i] = sees(vertices[i].vertex, blockers) ? 1 : 0;
    });
    for (size_t i = 0; i < vertices.size(); ++i) {
        if (visible[i] != 0)
            out.push_back({glm::dvec3(mesh.positions[vertices[i].vertex]), vertices[i].weight});
    }
}

}  // namespace lodestone::measure
