// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/deviation.h"

#include "base/parallel.h"
#include "base/random.h"
#include "measure/visible_sampler.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace lodestone::measure {
namespace {

using Sample = DeviationReference::Sample;

constexpr double kQuantile = 0.999;
// Of the places of one look; and looks of a smaller share of the area than this are details, which
// their places alone answer for.
constexpr double kLookQuantile = 0.99;
constexpr double kLeastLookShare = 0.002;
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
                           step, DeviationReference::kAnyLook});
            ++taken;
            next = (taken + random.uniform()) * step;
        }
    }
}

glm::dvec3 side_of(const Mesh& mesh, const VisiblePoint& point) {
    const glm::dvec3 area = area_vector(mesh, point.triangle);
    const double length = glm::length(area);
    if (!(length > 0))
        return glm::dvec3(0.0);
    return (glm::dot(area, point.seen_from) < 0 ? -area : area) / length;
}

/// Points that rays from outside hit, sharing the visible area of one side equally.
void add_visible_points(const Mesh& mesh, const VisibleSampler& sampler, const LookScenes& scenes,
                        uint32_t count, const Job& job, std::vector<Sample>& out) {
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
        out.push_back({point.point, weight, scenes.look_of(point.triangle), side_of(mesh, point),
                       mesh.slot(point.triangle)});
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
            out.push_back({glm::dvec3(mesh.positions[corners[i].vertex]), corners[i].weight,
                           DeviationReference::kAnyLook});
    }
}

double weight_of(const std::vector<Sample>& samples, const std::vector<size_t>& indices) {
    double sum = 0;
    for (const size_t i : indices)
        sum += samples[i].weight;
    return sum;
}

/// The smallest distance that `share` of the weight of the samples in `order` does not exceed.
double quantile(const std::vector<Sample>& samples, const std::vector<double>& distances,
                std::vector<size_t> order, double share) {
    const double all = weight_of(samples, order);
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
        return distances[a] != distances[b] ? distances[a] > distances[b] : a < b;
    });
    double above = 0;
    double out = 0;
    for (const size_t i : order) {
        out = distances[i];
        above += samples[i].weight;
        if (above > (1 - share) * all)
            break;
    }
    return out;
}

/// `places`: how far every sample is from the other surface; `moves`: how far its look was moved.
Deviation summary(const std::vector<Sample>& samples, const std::vector<double>& places,
                  const std::vector<double>& moves) {
    Deviation out;
    std::vector<size_t> all(samples.size());
    std::map<uint16_t, std::vector<size_t>> moved;  // looks of which anything moved
    for (size_t i = 0; i < all.size(); ++i) {
        all[i] = i;
        out.max = std::max({out.max, places[i], moves[i]});
        if (moves[i] > 0)
            moved[samples[i].look];
    }
    for (size_t i = 0; i < samples.size(); ++i) {
        const auto at = moved.find(samples[i].look);
        if (at != moved.end())
            at->second.push_back(i);
    }
    const double least = kLeastLookShare * weight_of(samples, all);
    out.error = quantile(samples, places, std::move(all), kQuantile);
    for (const auto& [look, indices] : moved) {
        if (weight_of(samples, indices) >= least)
            out.error = std::max(out.error, quantile(samples, moves, indices, kLookQuantile));
    }
    return out;
}

/// Whether two places can be seen at once: not the grass from above and the road from below.
bool face_alike(const glm::dvec3& a, const glm::dvec3& b) {
    constexpr double kUnknown = 0.5;  // square of a length; sides are unit vectors
    return glm::dot(a, a) < kUnknown || glm::dot(b, b) < kUnknown || glm::dot(a, b) > 0;
}

/// Distance to the nearest point of look `look` that can be seen of the finest, from the same side.
double nearest_visible(const std::vector<Sample>& visible, const Sample& from, uint16_t look) {
    double square = std::numeric_limits<double>::infinity();
    for (const Sample& sample : visible) {
        const glm::dvec3 arm = sample.point - from.point;
        const double here = glm::dot(arm, arm);
        if (here < square && sample.look == look && face_alike(sample.side, from.side))
            square = here;
    }
    return std::sqrt(square);
}

/// The radius around a point within which the visible colors of the finest mix to `color`; never
/// (infinity) when not even all of them do.
double mixing_radius(const std::vector<Sample>& visible, const Looks& palette, const Sample& from,
                     const glm::dvec3& color) {
    // Every so many of the visible points are enough for a mean.
    constexpr size_t kMostPoints = 512;
    const size_t step = std::max<size_t>(1, visible.size() / kMostPoints);
    std::vector<std::pair<double, uint16_t>> near;
    for (size_t i = 0; i < visible.size(); i += step) {
        const glm::dvec3 arm = visible[i].point - from.point;
        if (visible[i].look != DeviationReference::kAnyLook &&
            face_alike(visible[i].side, from.side))
            near.emplace_back(glm::dot(arm, arm), visible[i].look);
    }
    std::sort(near.begin(), near.end());
    glm::dvec3 sum(0.0);
    double count = 0;
    for (const auto& [square, look] : near) {
        sum += palette.color(look);
        ++count;
        const glm::dvec3 off = glm::abs(sum / count - color);
        if (std::max({off.x, off.y, off.z}) <= Looks::kSameLook)
            return std::sqrt(square);
    }
    return std::numeric_limits<double>::infinity();
}

/// What the samples of one mesh are compared with.
struct Against {
    const LookScenes& other;
    const std::vector<Sample>& visible;  // of the finest
    const LookScenes& finest;
    const Looks* palette;
    double none;  // the answer where there is nothing to find
};

/// How far the looks were moved at a sample where the other mesh shows `theirs`.
double moved_by(const Sample& sample, uint16_t theirs, const Against& against) {
    const double least =
        std::min(against.none, against.other.nearest(sample.look, sample.point).distance);
    if (against.finest.has(theirs))
        return std::min(least, nearest_visible(against.visible, sample, theirs));
    if (against.palette == nullptr)
        return least;
    return std::min(least, mixing_radius(against.visible, *against.palette, sample,
                                         against.palette->color(theirs)));
}

/// From the samples to the nearest points of the other mesh.
Deviation measure(const std::vector<Sample>& samples, const Against& against, const Job& job) {
    std::vector<double> places(samples.size(), 0);
    std::vector<double> moves(samples.size(), 0);
    const ray::Scene& scene = against.other.whole();
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
            places[i] = std::isfinite(closest.distance) ? closest.distance : against.none;
            last = closest.point;
            radius = closest.distance;
            if (samples[i].look == DeviationReference::kAnyLook || !std::isfinite(radius))
                continue;
            const uint16_t theirs = against.other.look_of(closest.triangle);
            if (theirs != samples[i].look)
                moves[i] = moved_by(samples[i], theirs, against);
        }
    });
    return summary(samples, places, moves);
}

}  // namespace

DeviationReference::DeviationReference(const Mesh& finest, const DeviationOptions& options,
                                       const Surface& surface, const Job& job)
    : options_(options),
      scenes_(finest, surface.looks),
      palette_(surface.palette),
      diameter_(2 * radius_of(finest)) {
    const VisibleSampler sampler(finest, scenes_.whole(), options.seed);
    if (sampler.empty())
        return;
    add_visible_points(finest, sampler, scenes_, options.samples, job, visible_);
    add_visible_vertices(finest, scenes_.whole(), sampler.sides(),
                         weighted_vertices(finest, options.most_vertices, options.seed),
                         ray_lift(diameter_ / 2), options.seed, job, visible_);
}

Deviation DeviationReference::of(const Mesh& stand_in, std::span<const uint16_t> looks,
                                 const Job& job) const {
    const LookScenes scenes(stand_in, looks);
    const double none = std::max(diameter_, 2 * radius_of(stand_in));
    if (scenes.whole().triangles() == 0 || scenes_.whole().triangles() == 0)
        return {none, none};
    // What the stand-in shows where, the visible points have asked already.
    std::vector<Sample> samples;
    add_area_samples(stand_in, options_.samples, options_.seed, samples);
    for (const Corner& corner : weighted_vertices(stand_in, options_.most_vertices, options_.seed))
        samples.push_back({glm::dvec3(stand_in.positions[corner.vertex]), corner.weight, kAnyLook});
    const Deviation there = measure(visible_, {scenes, visible_, scenes_, palette_, none}, job);
    const Deviation back = measure(samples, {scenes_, visible_, scenes_, palette_, none}, job);
    return {std::max(there.error, back.error), std::max(there.max, back.max)};
}

void DeviationReference::repaint(Mesh& level, const Job& job) const {
    constexpr uint32_t kLeastVotes = 3;
    if (level.slots.empty())
        return;
    const ray::Scene scene(level);
    std::vector<uint32_t> nearest(visible_.size(), ray::kNoTriangle);
    parallel_for((visible_.size() + kBlock - 1) / kBlock, [&](size_t block) {
        job.check();
        for (size_t i = block * kBlock; i < std::min(visible_.size(), (block + 1) * kBlock); ++i) {
            if (visible_[i].look != kAnyLook)
                nearest[i] = scene.closest_point(visible_[i].point).triangle;
        }
    });
    std::map<uint32_t, std::map<uint16_t, uint32_t>> votes;  // by triangle and slot
    for (size_t i = 0; i < nearest.size(); ++i) {
        if (nearest[i] != ray::kNoTriangle)
            ++votes[nearest[i]][visible_[i].slot];
    }
    for (const auto& [triangle, slots] : votes) {
        const auto most =
            std::max_element(slots.begin(), slots.end(),
                             [](const auto& a, const auto& b) { return a.second < b.second; });
        const auto own = slots.find(level.slots[triangle]);
        if (most->second >= kLeastVotes && (own == slots.end() || most->second > own->second))
            level.slots[triangle] = most->first;
    }
}

}  // namespace lodestone::measure
