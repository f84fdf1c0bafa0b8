// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/deviation.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace lodestone::measure {
namespace {

using Sample = SurfaceSample;

constexpr double kQuantile = 0.999;
// Of the places of one look; and looks of a smaller share of the area than this are details, which
// their places alone answer for.
constexpr double kLookQuantile = 0.99;
constexpr double kLeastLookShare = 0.002;
constexpr size_t kBlock = 256;
// Of levels as fine as scans a few vertices decide the quantile: those of the stand-in are taken
// all, up to so many at least.
constexpr uint32_t kLevelVertices = 16384;

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

/// The same for what shows a color.
double nearest_of_color(const std::vector<Sample>& visible, const Sample& from,
                        const glm::dvec3& color) {
    double square = std::numeric_limits<double>::infinity();
    for (const Sample& sample : visible) {
        const glm::dvec3 arm = sample.point - from.point;
        const double here = glm::dot(arm, arm);
        if (here < square && sample.look != kAnyLook && Looks::alike(sample.color, color) &&
            face_alike(sample.side, from.side))
            square = here;
    }
    return std::sqrt(square);
}

/// The radius around a point within which the visible colors of the finest mix (as light does, in a
/// pixel that shows them all) to `color`; never
/// (infinity) when not even all of them do.
double mixing_radius(const std::vector<Sample>& visible, const std::vector<glm::dvec3>& lights,
                     const Sample& from, const glm::dvec3& color) {
    // Every so many of the visible points are enough for a mean.
    constexpr size_t kMostPoints = 512;
    const size_t step = std::max<size_t>(1, visible.size() / kMostPoints);
    std::vector<std::tuple<double, uint16_t, size_t>> near;
    for (size_t run = 0; run < visible.size(); run += step) {
        // Any one of each run: they were drawn evenly, and every so many of such are in one place.
        const size_t i = std::min(run + scramble(run) % step, visible.size() - 1);
        const glm::dvec3 arm = visible[i].point - from.point;
        if (visible[i].look != kAnyLook && face_alike(visible[i].side, from.side))
            near.emplace_back(glm::dot(arm, arm), visible[i].look, i);
    }
    std::sort(near.begin(), near.end());
    const Looks::Lights wanted = Looks::lights_alike(color);
    glm::dvec3 sum(0.0);
    double count = 0;
    for (const auto& [square, look, index] : near) {
        sum += lights[index];
        ++count;
        if (wanted.hold(sum / count))
            return std::sqrt(square);
    }
    return std::numeric_limits<double>::infinity();
}

/// What the samples of one mesh are compared with.
struct Against {
    const LookScenes& other;
    const std::vector<Sample>& visible;     // of the finest
    const std::vector<glm::dvec3>& lights;  // of these
    const LookScenes& finest;
    const Looks* palette;
    double none;            // the answer where there is nothing to find
    const Mesh& mesh;       // the other's
    const ray::Skin* skin;  // likewise

    /// What the other shows at a point of its own; `varies`: elsewhere on the triangle other
    /// things.
    glm::dvec3 color_at(const ray::Closest& at, bool& varies) const {
        varies = skin != nullptr && skin->varies(mesh, mesh.slot(at.triangle));
        return varies ? Looks::color_of(skin->at(mesh, at.triangle, at.u, at.v))
                      : palette->color(other.look_of(at.triangle));
    }
};

/// How far a look was moved at a sample where the other mesh shows the look `theirs`.
double moved_by(const Sample& sample, uint16_t theirs, const glm::dvec3& color,
                const Against& against) {
    const double least =
        std::min(against.none, against.other.nearest(sample.look, sample.point).distance);
    if (against.finest.has(theirs))
        return std::min(least, nearest_visible(against.visible, sample, theirs));
    return std::min(least, mixing_radius(against.visible, against.lights, sample, color));
}

/// How far the same texture slid along the surface at a sample where the other shows another color.
double slid_by(const Sample& sample, const ray::Closest& at, const glm::dvec3& color,
               const Against& against) {
    double least = against.none;
    if (sample.metres_per_uv > 0 && !against.mesh.uvs.empty()) {
        const glm::dvec2 there = ray::uv_at(against.mesh, at.triangle, at.u, at.v);
        least = std::min(least, glm::length(there - sample.uv) * sample.metres_per_uv);
    }
    least = std::min(least, nearest_of_color(against.visible, sample, color));
    return std::min(least, mixing_radius(against.visible, against.lights, sample, color));
}

/// How far what a sample shows was moved on the other mesh, whose nearest point is `at`.
double move_of(const Sample& sample, const ray::Closest& at, const Against& against) {
    const uint16_t theirs = against.other.look_of(at.triangle);
    if (against.palette == nullptr)
        return 0;
    if (theirs == sample.look && !sample.varies)
        return 0;
    bool varies = false;
    const glm::dvec3 color = against.color_at(at, varies);
    if ((varies || sample.varies) && Looks::alike(color, sample.color))
        return 0;
    return theirs == sample.look ? slid_by(sample, at, color, against)
                                 : moved_by(sample, theirs, color, against);
}

/// From the samples to the nearest points of the other mesh. The first `points` of them tell which
/// distances can be the quantile; of the others, vertices, nothing else is asked than whether they
/// are farther, and how far then.
Deviation measure(const std::vector<Sample>& samples, size_t points, const Against& against,
                  const Job& job) {
    std::vector<double> places(samples.size(), 0);
    std::vector<double> moves(samples.size(), 0);
    const ray::Scene& scene = against.other.whole();
    const auto measure_from = [&](size_t begin, size_t end, double enough) {
        parallel_for((end - begin + kBlock - 1) / kBlock, [&](size_t block) {
            job.check();
            uint32_t last = ray::kNoTriangle;
            const size_t first = begin + block * kBlock;
            for (size_t i = first; i < std::min(end, first + kBlock); ++i) {
                // Neighbors in the list are mostly neighbors in space.
                const ray::Closest closest = scene.closest_point(
                    samples[i].point, std::numeric_limits<double>::infinity(), last, enough);
                // Nothing in reach at all: a scene of triangles that have no finite corners.
                places[i] = std::isfinite(closest.distance) ? closest.distance : against.none;
                last = closest.triangle;
                if (samples[i].look != kAnyLook && std::isfinite(closest.distance))
                    moves[i] = move_of(samples[i], closest, against);
            }
        });
    };
    measure_from(0, points, 0);
    std::vector<size_t> order(points);
    std::iota(order.begin(), order.end(), size_t{0});
    const double all =
        std::accumulate(samples.begin(), samples.end(), 0.0,
                        [](double sum, const Sample& sample) { return sum + sample.weight; });
    // More than the quantile leaves out of everything lies above, whatever the others are.
    const double share = weight_of(samples, order) / std::max(all, 1e-300);
    const double above = 4 * (1 - kQuantile) / std::max(share, 1e-300);
    const double enough = above < 1 ? quantile(samples, places, std::move(order), 1 - above) : 0;
    measure_from(points, samples.size(), enough);
    return summary(samples, places, moves);
}

}  // namespace

DeviationReference::DeviationReference(const Mesh& finest, const DeviationOptions& options,
                                       const Surface& surface, const Job& job)
    : options_(options),
      scenes_(finest, surface.looks, surface.skin, ray::Uses::Everything),
      palette_(surface.palette),
      diameter_(2 * radius_of(finest)) {
    const VisibleSampler sampler(finest, scenes_.whole(), options.seed);
    if (sampler.empty())
        return;
    add_visible_points(finest, sampler, surface, options.samples, job, visible_);
    points_ = visible_.size();
    const std::vector<WeightedVertex> vertices =
        weighted_vertices(finest, options.most_vertices, options.seed);
    if (surface.skin && surface.skin->transmits())
        add_vertex_samples(finest, scenes_.whole(), vertices, visible_);
    else
        add_visible_vertices(finest, scenes_.whole(), sampler.sides(), vertices,
                             ray_lift(diameter_ / 2), options.seed, job, visible_);
    lights_.reserve(visible_.size());
    for (const Sample& sample : visible_)
        lights_.push_back(Looks::light_of(sample.color));
}

Deviation DeviationReference::of(const Mesh& stand_in, const Surface& surface,
                                 const Job& job) const {
    const LookScenes scenes(stand_in, surface.looks, surface.skin, ray::Uses::ClosestPoints);
    const double none = std::max(diameter_, 2 * radius_of(stand_in));
    if (scenes.whole().triangles() == 0 || scenes_.whole().triangles() == 0)
        return {none, none};
    // What the stand-in shows where, the visible points have asked already.
    std::vector<Sample> samples;
    add_area_samples(stand_in, scenes.whole(), options_.samples, options_.seed, samples);
    const size_t points = samples.size();
    add_vertex_samples(stand_in, scenes.whole(),
                       weighted_vertices(stand_in, std::max(options_.most_vertices, kLevelVertices),
                                         options_.seed),
                       samples);
    const ray::Skin* const skin = surface.skin.get();
    const Deviation there =
        measure(visible_, points_,
                {scenes, visible_, lights_, scenes_, palette_, none, stand_in, skin}, job);
    const Deviation back =
        measure(samples, points,
                {scenes_, visible_, lights_, scenes_, palette_, none, stand_in, skin}, job);
    return {std::max(there.error, back.error), std::max(there.max, back.max)};
}

}  // namespace lodestone::measure
