// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/region/bound_lights.h"

#include "base/maths.h"
#include "light/light_arrival.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace lodestone::light {
namespace {

// The lamps of a group that is not divided further.
// Taste: fewer divide further for less.
constexpr size_t kFewLamps = 4;
// The most lamps, in parts of those of all things, that a division may leave.
// Taste: a larger share divides more often for less, and each group has copies of its lamps.
constexpr double kWorthDividing = 0.8;
// The most things times lamps that are looked through.
// Taste: more take longer than they save where so little of the things shows.
constexpr double kMostPairs = 2e6;

/// How far the farthest place of a bound lies before a plane through `at`.
double most_before(const Bound& bound, const glm::dvec3& at, const glm::dvec3& normal) {
    const glm::dvec3 middle = 0.5 * (bound.box.low + bound.box.high);
    const double of_box =
        glm::dot(middle - at, normal) + 0.5 * glm::dot(bound.box.size(), glm::abs(normal));
    return std::min(of_box, glm::dot(bound.center - at, normal) + bound.radius);
}

class BoundDivider {
public:
    BoundDivider(std::span<const Light* const> lamps, std::span<const Bound> bounds,
                 double pixel_error)
        : lamps_(lamps), bounds_(bounds), allowed_(light_tolerance(glm::dvec3(0.0), pixel_error)) {}

    std::vector<BoundGroup> divide(std::vector<uint32_t> things) const {
        if (things.empty())
            return {};
        BoundGroup all{std::move(things), {}};
        for (uint32_t i = 0; i < lamps_.size(); ++i)
            all.lamps.push_back(i);
        if (static_cast<double>(all.things.size()) * static_cast<double>(lamps_.size()) >
            kMostPairs)
            return {all};
        all.lamps = lamps_of(all.things, all.lamps);
        return divided(std::move(all));
    }

private:
    /// Those of `lamps` that may matter to the things.
    std::vector<uint32_t> lamps_of(std::span<const uint32_t> things,
                                   const std::vector<uint32_t>& lamps) const {
        Bound bound;
        for (const uint32_t thing : things)
            bound = merged(bound, bounds_[thing]);
        std::vector<std::pair<double, uint32_t>> weakest_first;
        for (const uint32_t lamp : lamps) {
            const glm::dvec3 most = most_radiance(*lamps_[lamp], bound);
            weakest_first.emplace_back(std::max({most.x, most.y, most.z}), lamp);
        }
        std::sort(weakest_first.begin(), weakest_first.end());
        std::vector<uint32_t> out;
        double left_out = 0;
        for (const auto& [most, lamp] : weakest_first) {
            left_out += most;
            if (!(left_out <= allowed_.x))  // what is no number is not left out
                out.push_back(lamp);
        }
        std::sort(out.begin(), out.end());
        return out;
    }

    /// Divides down to single things, and joins them again where that saved too little.
    std::vector<BoundGroup> divided(BoundGroup group) const {
        std::vector<BoundGroup> out;
        if (group.lamps.size() > kFewLamps && group.things.size() > 1) {
            auto [low, high] = halves(group);
            out = divided(std::move(low));
            double cost = 0;
            for (BoundGroup& more : divided(std::move(high)))
                out.push_back(std::move(more));
            for (const BoundGroup& part : out)
                cost += cost_of(part);
            if (cost <= kWorthDividing * cost_of(group))
                return out;
            out.clear();
        }
        out.push_back(std::move(group));
        return out;
    }

    static double cost_of(const BoundGroup& group) {
        return static_cast<double>(group.things.size()) * static_cast<double>(group.lamps.size());
    }

    /// Two halves with as many things each, across their longest extent.
    std::pair<BoundGroup, BoundGroup> halves(const BoundGroup& group) const {
        Box3 box;
        for (const uint32_t thing : group.things)
            box.add(bounds_[thing].center);
        const int axis = box.longest_axis();
        std::vector<uint32_t> things = group.things;
        std::stable_sort(things.begin(), things.end(), [&](uint32_t a, uint32_t b) {
            return bounds_[a].center[axis] < bounds_[b].center[axis];
        });
        const auto middle = things.begin() + static_cast<ptrdiff_t>(things.size() / 2);
        BoundGroup low{{things.begin(), middle}, {}};
        BoundGroup high{{middle, things.end()}, {}};
        low.lamps = lamps_of(low.things, group.lamps);
        high.lamps = lamps_of(high.things, group.lamps);
        return {std::move(low), std::move(high)};
    }

    std::span<const Light* const> lamps_;
    std::span<const Bound> bounds_;
    glm::dvec3 allowed_;
};

}  // namespace

glm::dvec3 most_radiance(const Light& lamp, const Bound& bound) {
    const double away = distance(bound, lamp.position) - extent_of(lamp);
    double most = 1 / (4 * kPi * kPi);
    if (lamp.kind != LightKind::Point) {
        const glm::dvec3 out = glm::normalize(lamp.direction);
        const double before = most_before(bound, lamp.position, out) + extent_of(lamp);
        if (!(before > 0))
            return glm::dvec3(0.0);
        if (away > 0)
            most *= std::min(1.0, before / away);
        if (lamp.kind == LightKind::Area)
            most *= kPi * most_in_spread(lamp);
    }
    if (!(away > 0))
        return glm::dvec3(std::numeric_limits<double>::infinity());
    return energy_of(lamp) * (most / (away * away));
}

std::vector<BoundGroup> group_by_bounds(std::span<const Light* const> lamps,
                                        std::span<const Bound> bounds, std::vector<uint32_t> things,
                                        double pixel_error) {
    return BoundDivider(lamps, bounds, pixel_error).divide(std::move(things));
}

}  // namespace lodestone::light
