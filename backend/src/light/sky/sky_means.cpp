// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/sky/sky_means.h"

#include "base/maths.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <unordered_map>

namespace lodestone::light {
namespace {

/// The sums of some rays.
struct MeanSums {
    double placed = 0;
    double alone = 0;
    double rays = 0;
};

/// The sums of the rays to both sides of leaves.
struct LeafSums {
    MeanSums side[2];
    int count = 0;

    /// By how much leaves have more than the mean of their sides, in sums.
    double more(double MeanSums::*sum) const {
        if (!(side[0].rays > 0 && side[1].rays > 0))
            return 0;
        const double factor = of_side_that_is_seen(side[0].*sum / side[0].rays,
                                                   side[1].*sum / side[1].rays, 0.5 * count);
        return (factor - 1) * (side[0].*sum + side[1].*sum);
    }
};

/// The rays that the surface itself lets pass: from where they begin, and whether the rest does.
class PassedRays {
public:
    void add(const glm::dvec3& from, double weight, double seen) {
        rays_.push_back({from, weight, seen});
        sum_ += weight;
        seen_ += weight * seen;
        from_ += weight * from;
    }

    /// Fits a slope to them.
    void fit(SkyMeans& out) const {
        // Rays that speak for no slope, so that a few do not tell of a steep one by chance.
        // Taste: a larger value flattens slopes that are true where rays are few.
        constexpr double kLevelRays = 4;
        if (!(sum_ > 0))
            return;
        const glm::dvec3 middle = from_ / sum_;
        glm::dmat3 spread(0.0);
        glm::dvec3 rise(0.0);
        for (const PassedRay& ray : rays_) {
            const glm::dvec3 way = ray.from - middle;
            spread += ray.weight / sum_ * glm::outerProduct(way, way);
            rise += ray.weight / sum_ * (ray.seen - seen_ / sum_) * way;
        }
        const double level = kLevelRays / static_cast<double>(rays_.size()) *
                             (spread[0][0] + spread[1][1] + spread[2][2]) / 3;
        for (int i = 0; i < 3; ++i)
            spread[i][i] += level;
        const glm::dvec3 slope = glm::inverse(spread) * rise;
        if (!finite(slope) || !finite(middle))
            return;
        out.slope = slope;
        out.middle = middle;
    }

private:
    struct PassedRay {
        glm::dvec3 from;
        double weight;
        double seen;
    };
    std::vector<PassedRay> rays_;
    double sum_ = 0;
    double seen_ = 0;
    glm::dvec3 from_{0.0};
};

// The rounds of rays, at most, until some leave the surface: of a dense tree one in twelve does, and
// only these tell what is around it.
// Taste: a larger value tells what is around denser things, for rays that tell nothing.
constexpr int kMostRounds = 8;
constexpr int kFewestLeft = 8;  // Taste: as kMostRounds; of few rays half as many are enough
// The dark triangles that are looked at, where none of them lies inside of something.
// Taste: more find smaller parts inside of something; a look takes as long as ten rays, and all of a thing in
// a room is dark.
constexpr size_t kMostLooked = 12;
// How far the places of one round lie from those of the last, in parts of the way between two.
// Law: the golden ratio, whose multiples lie nowhere close together.
constexpr double kGoldenPart = 0.6180339887498949;

// The numbers of each of the means that are kept.
// Law: of another number of them, a list of means is damaged.
constexpr size_t kNumbers = 8;

}  // namespace

SkyMeans mean_sky_shares(const SkyRequest& request, int rays) {
    const SkySampler sampler(request);
    const Mesh& mesh = *request.surface.mesh;
    const std::vector<double>& areas = request.surface.areas;
    SkyMeans out;
    if (!(request.surface.area() > 0) || rays < 1)
        return out;
    const ray::FlushDenormals fast;
    MeanSums all;
    MeanSums inside;
    PassedRays passed;
    LeafSums leaves;
    std::unordered_map<size_t, bool> looked;  // by triangle, whether it lies inside of something
    bool any_inside = false;
    const auto lies_inside = [&](size_t triangle, const SkySampler::PlacedTriangle& placed) {
        if (!any_inside && looked.size() >= kMostLooked)
            return false;
        const auto [at, fresh] = looked.try_emplace(triangle);
        if (fresh)
            at->second = sampler.lies_inside(mesh, triangle, placed);
        any_inside = any_inside || at->second;
        return at->second;
    };
    int left = 0;  // rays that the surface itself does not stop
    uint32_t blocker = ray::PlacedScenes::kNothing;
    uint32_t near = ray::kNoTriangle;
    for (int i = 0; i < kMostRounds * rays; ++i) {
        if (i % rays == 0 && left >= std::min(kFewestLeft, (rays + 1) / 2))
            break;
        const int round = i / rays;
        const double part = std::fmod(0.5 + round * kGoldenPart, 1.0);
        const size_t triangle = request.surface.triangle_at((i % rays + part) / rays);
        if (triangle >= areas.size())
            continue;
        const std::optional<SkySampler::PlacedTriangle> placed = sampler.placed(mesh, triangle);
        if (!placed)
            continue;
        const bool both = !request.surface.opaque_slot(mesh.slot(triangle));
        // Rays are as dense as the surface is before it is placed, which may stretch some of it.
        const double own = request.surface.area_of(triangle);
        const double weight = own > 0 ? placed->area / own : 0;
        // Every second point of the sequence lies in one half of its first axis: both sides have
        // all points.
        const SkySampler::SkyPlace place =
            sampler.place(mesh, triangle, *placed, static_cast<uint32_t>(both ? i / 2 : i), near);
        const SkySampler::SkyRay ray = sampler.ray(place, both && i % 2 == 1);
        const double light = ray.open ? sampler.light(ray) : 0;
        const double alone = light > 0 && !sampler.hidden_alone(ray) ? light : 0;
        left += alone > 0 ? 1 : 0;
        // A placement sees all or nothing of the sky below, on the average as much.
        const double seen = alone > 0 && !sampler.hidden(ray, blocker) ? 1 : 0;
        const double placed_light = seen > 0 ? weight * seen * sampler.brightness(ray, true) : 0;
        const double alone_light = alone > 0 ? weight * alone * sampler.brightness(ray, false) : 0;
        all.placed += placed_light;
        all.alone += alone_light;
        all.rays += weight;
        if (both) {
            MeanSums& side = leaves.side[i % 2];
            side.placed += placed_light;
            side.alone += alone_light;
            side.rays += weight;
            ++leaves.count;
        }
        if (seen == 0 && !both && lies_inside(triangle, *placed)) {
            inside.alone += alone_light;
            inside.rays += weight;
        } else if (alone > 0) {
            passed.add(place.at, alone_light, seen / alone);
        }
    }
    if (inside.rays < all.rays) {
        all.alone -= inside.alone;
        all.rays -= inside.rays;
    }
    if (all.rays > 0) {
        out.alone = std::min(1.0, (all.alone + leaves.more(&MeanSums::alone)) / all.rays);
        out.placed = std::min(out.alone, (all.placed + leaves.more(&MeanSums::placed)) / all.rays);
    }
    passed.fit(out);
    return out;
}

std::string PlacedMeans::bytes() const {
    std::string out;
    const auto add = [&](auto... numbers) {
        for (const float value : {static_cast<float>(numbers)...})
            out.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    add(horizon.up.x, horizon.up.y, horizon.up.z, horizon.below, horizon.upright);
    for (const SkyMeans& one : means)
        add(one.placed, one.alone, one.slope.x, one.slope.y, one.slope.z, one.middle.x,
            one.middle.y, one.middle.z);
    return out;
}

std::optional<PlacedMeans> PlacedMeans::of_bytes(std::string_view bytes, size_t count) {
    std::array<float, kNumbers> numbers{};
    std::array<float, 5> horizon{};
    if (bytes.size() != sizeof horizon + count * sizeof numbers)
        return {};
    std::memcpy(horizon.data(), bytes.data(), sizeof horizon);
    const auto [x, y, z, below, upright] = horizon;
    PlacedMeans out{{{x, y, z}, below, upright > 0}, {}};
    if (!finite(out.horizon.up) || !(below >= 0 && below <= 1))
        return {};
    for (size_t i = 0; i < count; ++i) {
        std::memcpy(numbers.data(), bytes.data() + sizeof horizon + i * sizeof numbers,
                    sizeof numbers);
        const auto [placed, alone, sx, sy, sz, mx, my, mz] = numbers;
        const SkyMeans one{placed, alone, {sx, sy, sz}, {mx, my, mz}};
        // Things around another one hide more of its sky, never less.
        if (!(placed >= 0 && placed <= alone && alone <= 1) || !finite(one.slope) ||
            !finite(one.middle))
            return {};
        out.means.push_back(one);
    }
    return out;
}

}  // namespace lodestone::light
