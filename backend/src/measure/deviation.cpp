// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/deviation.h"

#include "base/parallel.h"
#include "base/random.h"
#include "measure/visible_sampler.h"

#include <algorithm>
#include <cmath>

namespace lodestone::measure {
namespace {

using Sample = DeviationReference::Sample;

constexpr double kQuantile = 0.999;
constexpr int kVertexRays = 16;
constexpr uint32_t kMostRaysPerSample = 16;  // for visible points of a mesh that is hard to hit
constexpr size_t kBlock = 256;

double area_of(const Mesh& mesh, size_t triangle) {
    const double area = 0.5 * glm::length(area_vector(mesh, triangle));
    return area > 0 && std::isfinite(area) ? area : 0;
}

/// A vertex that draws something, and one of its triangles; a third of their area.
struct Corner {
    uint32_t vertex;
    double weight;
};

/// At most `most` vertices with weight, chosen evenly over the list; the weights of those left out
/// go to the rest, so that their sum is the mesh's area.
std::vector<Corner> weighted_vertices(const Mesh& mesh, uint32_t most, uint64_t seed) {
    std::vector<double> weights(mesh.positions.size(), 0);
    double all = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const double third = area_of(mesh, i) / 3;
        all += 3 * third;
        for (int corner = 0; corner < 3; ++corner)
            weights[mesh.triangles[i][corner]] += third;
    }
    std::vector<Corner> corners;
    for (size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] > 0)
            corners.push_back({static_cast<uint32_t>(i), weights[i]});
    }
    if (corners.size() <= most)
        return corners;
    Random random(scramble(seed), 1);
    const double step = static_cast<double>(corners.size()) / most;
    double kept = 0;
    for (uint32_t i = 0; i < most; ++i) {
        // One of each run of `step` vertices; the write position never passes the read position.
        const auto pick = static_cast<size_t>((i + random.uniform()) * step);
        corners[i] = corners[std::min(pick, corners.size() - 1)];
        kept += corners[i].weight;
    }
    corners.resize(most);
    for (Corner& corner : corners)
        corner.weight *= all / kept;
    return corners;
}

/// Points uniform in area, one in each of `count` equal steps along the list of triangles.
void add_area_samples(const Mesh& mesh, uint32_t count, uint64_t seed, std::vector<Sample>& out) {
    double all = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        all += area_of(mesh, i);
    if (!(all > 0) || count == 0)
        return;
    Random random(scramble(seed), 2);
    const double step = all / count;
    uint32_t taken = 0;
    double up_to = 0;
    double next = random.uniform() * step;
    for (size_t i = 0; i < mesh.triangles.size() && taken < count; ++i) {
        up_to += area_of(mesh, i);
        while (next < up_to && taken < count) {
            const Triangle& t = mesh.triangles[i];
            const glm::dvec3 a(mesh.positions[t.x]);
            const double u = random.uniform();
            const double v = random.uniform();
            const glm::dvec2 weights = uniform_in_triangle(u, v);
            out.push_back({a + weights.x * (glm::dvec3(mesh.positions[t.y]) - a) +
                               weights.y * (glm::dvec3(mesh.positions[t.z]) - a),
                           step});
            ++taken;
            next = (taken + random.uniform()) * step;
        }
    }
}

/// Points that rays from outside hit, sharing the visible area of one side equally.
void add_visible_points(const VisibleSampler& sampler, uint32_t count, const Job& job,
                        std::vector<Sample>& out) {
    const uint64_t most = uint64_t{count} * kMostRaysPerSample;
    struct Found {
        std::array<VisiblePoint, 2> points;
        int count = 0;
    };
    std::vector<Found> found;
    std::vector<VisiblePoint> points;
    uint64_t rays = 0;
    uint64_t hits = 0;
    while (points.size() < count && rays < most) {
        const size_t batch = std::min<uint64_t>(most - rays, std::max<uint32_t>(count / 2, 1));
        found.assign(batch, {});
        parallel_for((batch + kBlock - 1) / kBlock, [&](size_t block) {
            job.check();
            for (size_t i = block * kBlock; i < std::min(batch, (block + 1) * kBlock); ++i)
                found[i].count = sampler.cast(static_cast<uint32_t>(rays + i), found[i].points);
        });
        for (const Found& ray : found) {
            hits += ray.count > 0 ? 1 : 0;
            for (int i = 0; i < ray.count; ++i)
                points.push_back(ray.points[static_cast<size_t>(i)]);
        }
        rays += batch;
    }
    if (points.empty())
        return;
    const double visible = sampler.reference_area() * static_cast<double>(hits) /
                           static_cast<double>(rays) / (sampler.sides().open ? 2 : 1);
    if (points.size() > count)
        points.resize(count);
    // Along the list of triangles, neighbors are near each other and so are their answers.
    std::stable_sort(
        points.begin(), points.end(),
        [](const VisiblePoint& a, const VisiblePoint& b) { return a.triangle < b.triangle; });
    const double weight = visible / static_cast<double>(points.size());
    for (const VisiblePoint& point : points)
        out.push_back({point.point, weight});
}

/// Vertices from beside which some ray sees infinity.
void add_visible_vertices(const Mesh& mesh, const ray::Scene& scene, const Sides& sides,
                          const std::vector<Corner>& corners, double lift, uint64_t seed,
                          const Job& job, std::vector<Sample>& out) {
    // The triangles of each vertex: those of vertex i are list[first[i]]...list[first[i + 1] - 1].
    std::vector<uint32_t> first(mesh.positions.size() + 2, 0);
    for (const Triangle& t : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner)
            ++first[t[corner] + 2];
    }
    for (size_t i = 2; i < first.size(); ++i)
        first[i] += first[i - 1];
    std::vector<uint32_t> list(mesh.triangles.size() * 3);
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner)
            list[first[mesh.triangles[i][corner] + 1]++] = i;
    }
    const auto sees = [&](uint32_t vertex) {
        const uint32_t begin = first[vertex];
        const uint32_t count = first[vertex + 1] - begin;
        const glm::dvec3 point(mesh.positions[vertex]);
        Random random(scramble(seed) + vertex, 3);
        for (int ray = 0; ray < kVertexRays; ++ray) {
            const uint32_t triangle = list[begin + static_cast<uint32_t>(ray) % count];
            const glm::dvec3 area = area_vector(mesh, triangle);
            const double length = glm::length(area);
            const double u = random.uniform();
            const double v = random.uniform();
            const bool coin = (random.next() & 1u) != 0;
            if (!(length > 0))
                continue;
            const bool back = sides.open ? coin : sides.turned[triangle] != 0;
            const glm::dvec3 outward = (back ? -area : area) / length;
            // A hundredth towards the middle: a ray from the corner itself could slip between the
            // surfaces that meet there.
            const Triangle& t = mesh.triangles[triangle];
            const glm::dvec3 middle =
                (glm::dvec3(mesh.positions[t.x]) + glm::dvec3(mesh.positions[t.y]) +
                 glm::dvec3(mesh.positions[t.z])) /
                3.0;
            const glm::dvec3 origin = point + 0.01 * (middle - point) + lift * outward;
            if (!scene.occluded(origin, cosine_direction(outward, u, v)))
                return true;
        }
        return false;
    };
    std::vector<uint8_t> seen(corners.size(), 0);
    parallel_for((corners.size() + kBlock - 1) / kBlock, [&](size_t block) {
        job.check();
        for (size_t i = block * kBlock; i < std::min(corners.size(), (block + 1) * kBlock); ++i)
            seen[i] = sees(corners[i].vertex) ? 1 : 0;
    });
    for (size_t i = 0; i < corners.size(); ++i) {
        if (seen[i] != 0)
            out.push_back({glm::dvec3(mesh.positions[corners[i].vertex]), corners[i].weight});
    }
}

/// The smallest distance that samples of 99.9 % of the weight do not exceed, and the largest.
Deviation summary(const std::vector<Sample>& samples, const std::vector<double>& distances) {
    Deviation out;
    std::vector<size_t> order(samples.size());
    double all = 0;
    for (size_t i = 0; i < order.size(); ++i) {
        order[i] = i;
        all += samples[i].weight;
        out.max = std::max(out.max, distances[i]);
    }
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
        return distances[a] != distances[b] ? distances[a] > distances[b] : a < b;
    });
    double above = 0;
    for (const size_t i : order) {
        out.error = distances[i];
        above += samples[i].weight;
        if (above > (1 - kQuantile) * all)
            break;
    }
    return out;
}

/// From the samples to the nearest points of the scene; `none` where there is nothing to find.
Deviation measure(const std::vector<Sample>& samples, const ray::Scene& scene, double none,
                  const Job& job) {
    std::vector<double> distances(samples.size(), 0);
    parallel_for((samples.size() + kBlock - 1) / kBlock, [&](size_t block) {
        job.check();
        double radius = std::numeric_limits<double>::infinity();
        glm::dvec3 last(0.0);
        for (size_t i = block * kBlock; i < std::min(samples.size(), (block + 1) * kBlock); ++i) {
            const glm::dvec3& point = samples[i].point;
            // The last answer is a point of the surface, so the next one cannot be further.
            if (std::isfinite(radius))
                radius = glm::length(point - last) * (1 + 1e-9);
            ray::Closest closest = scene.closest_point(point, radius);
            if (!std::isfinite(closest.distance))
                closest = scene.closest_point(point);
            // Nothing in reach at all: a scene of triangles that have no finite corners.
            distances[i] = std::isfinite(closest.distance) ? closest.distance : none;
            last = closest.point;
            radius = closest.distance;
        }
    });
    return summary(samples, distances);
}

}  // namespace

DeviationReference::DeviationReference(const Mesh& finest, const DeviationOptions& options,
                                       const Job& job)
    : options_(options), scene_(finest), diameter_(2 * radius_of(finest)) {
    const VisibleSampler sampler(finest, scene_, options.seed);
    if (sampler.empty())
        return;
    add_visible_points(sampler, options.samples, job, visible_);
    add_visible_vertices(finest, scene_, sampler.sides(),
                         weighted_vertices(finest, options.most_vertices, options.seed),
                         ray_lift(diameter_ / 2), options.seed, job, visible_);
}

Deviation DeviationReference::of(const Mesh& stand_in, const Job& job) const {
    const ray::Scene scene(stand_in);
    const double none = std::max(diameter_, 2 * radius_of(stand_in));
    if (scene.triangles() == 0 || scene_.triangles() == 0)
        return {none, none};
    std::vector<Sample> samples;
    add_area_samples(stand_in, options_.samples, options_.seed, samples);
    for (const Corner& corner : weighted_vertices(stand_in, options_.most_vertices, options_.seed))
        samples.push_back({glm::dvec3(stand_in.positions[corner.vertex]), corner.weight});
    const Deviation there = measure(visible_, scene, none, job);
    const Deviation back = measure(samples, scene_, none, job);
    return {std::max(there.error, back.error), std::max(there.max, back.max)};
}

}  // namespace lodestone::measure
