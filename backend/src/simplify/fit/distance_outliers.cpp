// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/distance_outliers.h"

#include "base/parallel.h"

#include <algorithm>
#include <functional>

namespace lodestone::simplify {
namespace {

// The most steps downhill from a vertex of the original to the mesh.
// Taste: more find nearer places, more slowly.
constexpr int kMostSearched = 4;
// The most steps downhill over the original.
// Taste: more find nearer places, more slowly.
constexpr int kMostWalked = 8;
/// The samples on a triangle from which walks begin.
/// Taste: more find nearer places, more slowly.
constexpr size_t kMostStarts = 8;
// Vertices that one thread searches from at a time.
// Taste: larger chunks share the work less evenly.
constexpr size_t kSearched = 4096;
// Triangles that one thread looks at a time.
// Taste: larger chunks share the work less evenly.
constexpr size_t kLooked = 1024;
// How many of them ahead memory is asked for.
// Taste: more displace what is still needed, fewer come too late.
constexpr size_t kAhead = 8;
/// An outlier is confirmed if its squared distance stays at least this part of what it was.
/// Taste: a smaller part believes more searches that went astray.
constexpr float kConfirmed = 0.25f;

int nearest_corner(const glm::vec3& w) {
    return w.x >= w.y ? (w.x >= w.z ? 0 : 2) : (w.y >= w.z ? 1 : 2);
}

}  // namespace

DistanceOutliers::DistanceOutliers(const FitPlaces& places, const Adjacency& adjacency,
                                   const FitSamples& samples, const Job& job)
    : places_(places),
      mesh_(places.mesh()),
      adjacency_(adjacency),
      points_(places.points()),
      by_triangle_(places, samples) {
    find_rings();
    look_from_original(job);
}

geometry::TriangleSpot DistanceOutliers::find(const glm::vec3& point, uint32_t from) const {
    geometry::TriangleSpot best;
    uint32_t at = from;
    for (int step = 0; step < kMostSearched; ++step) {
        geometry::nearest_of_triangles(
            ring(at), point, [&](uint32_t t) { return corners(t); }, best);
        if (best.triangle == kNone)
            return best;
        const glm::vec3& w = best.weights;
        const int corner = nearest_corner(w);
        const uint32_t next = mesh_.triangles[best.triangle][corner];
        if (next == at || (w.x > 0 && w.y > 0 && w.z > 0) || !known(next))
            break;
        at = next;
    }
    return best;
}

void DistanceOutliers::find_rings() {
    const Mesh& source = places_.source();
    source_first_.assign(source.positions.size() + 2, 0);
    for (const Triangle& t : source.triangles) {
        for (int k = 0; k < 3; ++k)
            ++source_first_[welded(t[k]) + 2];
    }
    for (size_t v = 2; v < source_first_.size(); ++v)
        source_first_[v] += source_first_[v - 1];
    source_order_.resize(source_first_.back());
    for (uint32_t i = 0; i < source.triangles.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            source_order_[source_first_[welded(source.triangles[i][k]) + 1]++] = i;
    }
}

void DistanceOutliers::look_from_original(const Job& job) {
    const size_t count = places_.source().positions.size();
    nearest_.assign(count, {0.0f, kNone});
    parallel_for((count + kSearched - 1) / kSearched, [&](size_t chunk) {
        job.check();
        const size_t last = std::min(count, (chunk + 1) * kSearched);
        for (size_t v = chunk * kSearched; v < last; ++v) {
            const auto vertex = static_cast<uint32_t>(v);
            const uint32_t from = places_.place(vertex);
            if (from == kNone || welded(vertex) != vertex)
                continue;
            const geometry::TriangleSpot spot = find(places_.original(vertex), from);
            nearest_[v] = {spot.square, spot.triangle};
        }
    });
    first_.assign(mesh_.triangles.size() + 1, 0);
    for (const auto& [square, triangle] : nearest_) {
        if (triangle != kNone)
            ++first_[triangle + 1];
    }
    for (size_t t = 1; t < first_.size(); ++t)
        first_[t] += first_[t - 1];
    order_.resize(first_.back());
    std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
    for (uint32_t v = 0; v < count; ++v) {
        const auto& [square, triangle] = nearest_[v];
        if (triangle == kNone)
            continue;
        order_[next[triangle]++] = v;
    }
}

geometry::TriangleSpot DistanceOutliers::walk(const glm::vec3& point, uint32_t from) const {
    const auto corners_of = [&](uint32_t t) { return original(t); };
    geometry::TriangleSpot best = geometry::nearest_spot(original(from), point);
    best.triangle = from;
    for (int step = 0; step < kMostWalked; ++step) {
        const float before = best.square;
        const glm::vec3& w = best.weights;
        const int corner = nearest_corner(w);
        const uint32_t hub = welded(places_.source().triangles[best.triangle][corner]);
        const size_t last =
            std::min<size_t>(source_first_[hub + 1], source_first_[hub] + kMostRing);
        geometry::nearest_of_triangles(
            {source_order_.data() + source_first_[hub], source_order_.data() + last}, point,
            corners_of, best);
        if (!(best.square < before))
            break;
    }
    return best;
}

/// The distance of a place of the mesh from the original, beginning where a sample of the original
/// is nearest. A place nearer than `least` or the worst so far is given up as soon as this is
/// known.
void DistanceOutliers::look(const glm::vec3& place, uint32_t triangle, const glm::vec3& weights,
                            std::span<const uint32_t> hubs, float least,
                            DistanceOutlier& worst) const {
    const float enough = std::max(least, worst.square);
    const std::span<const PlacedSample> own = by_triangle_.on(triangle);
    for (const PlacedSample& sample : own.first(std::min(own.size(), kMostStarts))) {
        if (geometry::nearest_spot(original(sample.source), place).square < enough)
            return;
    }
    float nearest = 1e30f;
    const PlacedSample* from = nullptr;
    for (const uint32_t hub : hubs) {
        for (const uint32_t t : ring(hub)) {
            for (const PlacedSample& sample : by_triangle_.on(t)) {
                const glm::vec3 off = sample.place - place;
                const float square = glm::dot(off, off);
                if (square < nearest) {
                    nearest = square;
                    from = &sample;
                }
            }
        }
    }
    if (from == nullptr)
        return;
    const geometry::TriangleSpot spot = walk(place, from->source);
    if (!(spot.square > worst.square))
        return;
    const geometry::TrianglePoints c = original(spot.triangle);
    const glm::vec3& w = spot.weights;
    worst = {spot.square, triangle,     weights, w.x * c[0] + w.y * c[1] + w.z * c[2],
             kNone,       spot.triangle};
}

void DistanceOutliers::look_from_mesh(std::vector<DistanceOutlier>& worst_of, float least,
                                      const Job& job) const {
    const size_t count = mesh_.triangles.size();
    parallel_for((count + kLooked - 1) / kLooked, [&](size_t chunk) {
        job.check();
        const size_t last = std::min(count, (chunk + 1) * kLooked);
        for (size_t i = chunk * kLooked; i < last; ++i) {
            const auto t = static_cast<uint32_t>(i);
            const auto coming = static_cast<uint32_t>(std::min(i + kAhead, count - 1));
            if (const auto samples = by_triangle_.on(coming); !samples.empty())
                __builtin_prefetch(&places_.source().triangles[samples.front().source]);
            const Triangle& c = mesh_.triangles[t];
            const geometry::TrianglePoints at = corners(t);
            DistanceOutlier& worst = worst_of[t];
            const std::array<uint32_t, 3> all{c.x, c.y, c.z};
            look((at[0] + at[1] + at[2]) * (1.0f / 3), t, glm::vec3(1.0f / 3), all, least, worst);
            for (int k = 0; k < 3; ++k) {
                const int next = (k + 1) % 3;
                if (all[k] < all[next]) {
                    const std::array<uint32_t, 2> ends{all[k], all[next]};
                    glm::vec3 weights(0.0f);
                    weights[k] = weights[next] = 0.5f;
                    look(0.5f * (at[k] + at[next]), t, weights, ends, least, worst);
                }
                if (adjacency_.around(all[k]).front() == t) {
                    glm::vec3 weights(0.0f);
                    weights[k] = 1;
                    look(at[k], t, weights, std::span(all).subspan(static_cast<size_t>(k), 1),
                         least, worst);
                }
            }
        }
    });
}

void DistanceOutliers::confirm_from_mesh(DistanceOutlier& stray) const {
    const geometry::TrianglePoints at = corners(stray.triangle);
    const glm::vec3& w = stray.weights;
    const glm::vec3 place = w.x * at[0] + w.y * at[1] + w.z * at[2];
    const Triangle& hubs = mesh_.triangles[stray.triangle];
    for (int k = 0; k < 3; ++k) {
        if (!known(hubs[k]))
            continue;
        for (const uint32_t t : ring(hubs[k])) {
            const std::span<const PlacedSample> on_it = by_triangle_.on(t);
            for (const PlacedSample& sample : on_it.first(std::min(on_it.size(), kMostStarts))) {
                const geometry::TriangleSpot spot = walk(place, sample.source);
                if (!(spot.square < stray.square))
                    continue;
                const geometry::TrianglePoints c = original(spot.triangle);
                const glm::vec3& v = spot.weights;
                stray.square = spot.square;
                stray.source = spot.triangle;
                stray.point = v.x * c[0] + v.y * c[1] + v.z * c[2];
            }
        }
    }
}

bool DistanceOutliers::confirm(DistanceOutlier& stray) const {
    const float before = stray.square;
    if (stray.vertex == kNone) {
        confirm_from_mesh(stray);
        return stray.square >= kConfirmed * before;
    }
    const uint32_t last = source_first_[stray.vertex + 1];
    for (uint32_t i = source_first_[stray.vertex]; i < last; ++i) {
        const Triangle& t = places_.source().triangles[source_order_[i]];
        for (int k = 0; k < 3; ++k) {
            const uint32_t from = places_.place(t[k]);
            if (from == kNone || !known(from))
                continue;
            const geometry::TriangleSpot spot = find(stray.point, from);
            if (!(spot.square < stray.square))
                continue;
            stray.square = spot.square;
            stray.triangle = spot.triangle;
            stray.weights = spot.weights;
        }
    }
    return stray.square >= kConfirmed * before;
}

std::vector<DistanceOutlier> DistanceOutliers::list_farthest(size_t most, const Job& job) const {
    std::vector<DistanceOutlier> worst(mesh_.triangles.size());
    for (uint32_t t = 0; t < worst.size(); ++t) {
        DistanceOutlier& stray = worst[t];
        for (const uint32_t v : on(t)) {
            if (nearest_[v].first > stray.square) {
                stray.square = nearest_[v].first;
                stray.vertex = v;
            }
        }
        if (stray.vertex == kNone)
            continue;
        stray.triangle = t;
        stray.point = places_.original(stray.vertex);
        stray.weights = geometry::nearest_spot(corners(t), stray.point).weights;
        stray.source = source_order_[source_first_[stray.vertex]];
    }
    float least = 0;  // enough outliers are that far off already
    if (most > 0 && most < worst.size()) {
        std::vector<float> squares(worst.size());
        std::transform(worst.begin(), worst.end(), squares.begin(),
                       [](const DistanceOutlier& stray) { return stray.square; });
        const auto nth = squares.begin() + static_cast<std::ptrdiff_t>(most - 1);
        std::nth_element(squares.begin(), nth, squares.end(), std::greater<>());
        least = *nth;
    }
    look_from_mesh(worst, least, job);
    std::erase_if(worst, [](const DistanceOutlier& stray) { return stray.triangle == kNone; });
    std::stable_sort(
        worst.begin(), worst.end(),
        [](const DistanceOutlier& x, const DistanceOutlier& y) { return x.square > y.square; });
    return worst;
}

}  // namespace lodestone::simplify
