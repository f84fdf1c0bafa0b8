// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/region/region_cut.h"

#include "base/parallel.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace lodestone::light {
namespace {

// The fewest points of a box.
// Taste: fewer cut finer, by points that hit a region by chance.
constexpr size_t kCell = 8;
// The most boxes of one thing.
// Taste: more cut finer; each is another clipped copy in POV-Ray.
constexpr size_t kPieces = 128;
// The most shadow rays to the lamps of a box that is not cut further.
// Taste: fewer cut further for less.
constexpr double kFewRays = 6;
// The most shadow rays that a cut may leave, in parts of those at all points.
// Taste: a larger share cuts more often for less.
constexpr double kWorthCutting = 0.9;
// The shadow rays to the lamps of a box above which it is cut although all of them reach all of it.
// Taste: fewer lamps have fewer far ones that others could stand for.
constexpr double kManyRays = 100;
// The points of a box above which it is.
// Taste: the lights of smaller ones are chosen by few points.
constexpr size_t kManyPoints = 128;
// The most boxes of one thing that are cut so.
// Taste: more have fewer lights each, and are more clipped copies in POV-Ray.
constexpr size_t kEvenPieces = 32;
// The widest gaps between points along an axis that are tried.
// Taste: more find better cuts, more slowly.
constexpr size_t kGaps = 12;
// The places along an axis that are tried where the light of a lamp begins or ends.
// Taste: more find better cuts, more slowly.
constexpr size_t kEnds = 24;
// The share of a lamp that counts if it reaches none of the points, but one beside them.
// Taste: more keep boxes away from where light ends, and leave those larger that see many lamps.
constexpr double kOnlyBeside = 0.1;
// The least extent of points along an axis that is cut, in parts of the thing's size.
// Taste: a flat thing is not cut along itself.
constexpr double kFlat = 1e-4;
// The narrowest gap between points that is cut, in parts of the thing's size.
// Law: positions are known to about that, so narrower ones may be none.
constexpr double kNarrow = 1e-7;

class RegionCutter {
public:
    RegionCutter(std::span<const double> weights, const LightShares& shares,
                 std::span<const Box3> spoken, std::span<const LitPoint> points)
        : weights_(weights), spoken_(spoken), points_(points) {
        note_lamps(shares);
    }

    std::vector<CutBox> cut(const CutBox& thing) const {
        RegionPart whole;
        whole.box = thing.box;
        whole.points = thing.points;
        const double size = glm::length(thing.box.size());
        plan(whole, size);
        const auto gains_less = [](const RegionPart& a, const RegionPart& b) {
            return a.gain < b.gain;
        };
        std::vector<RegionPart> parts{std::move(whole)};  // a heap: the first gains most
        while (parts.front().gain >= 0 &&
               parts.size() < (parts.front().gain > 0 ? kPieces : kEvenPieces)) {
            std::pop_heap(parts.begin(), parts.end(), gains_less);
            auto [low, high] = halves(parts.back());
            parts.pop_back();
            for (RegionPart* half : {&low, &high}) {
                plan(*half, size);
                parts.push_back(std::move(*half));
                std::push_heap(parts.begin(), parts.end(), gains_less);
            }
        }
        std::vector<CutBox> out;
        out.reserve(parts.size());
        for (RegionPart& part : parts)
            out.push_back({part.box, std::move(part.points)});
        return out;
    }

private:
    struct SplitPlane {
        double cost = 0;
        int axis = 0;
        double at = 0;
    };
    struct RegionPart {
        Box3 box;
        std::vector<uint32_t> points;
        std::vector<uint32_t> guests;  // points of other parts that speak for places in this one
        SplitPlane plane;
        double gain = -1;  // shadow rays that the plane spares; 0: it makes even parts; < 0: no cut
    };

    /// A bit for every lamp that reaches some points, and one for every lamp that reaches these or
    /// points beside them, in a second half.
    using Words = std::vector<uint64_t>;

    /// Notes the lamps of each point, `width_` words for each.
    void note_lamps(const LightShares& shares) {
        const size_t lamps = shares.empty() ? 0 : shares[0].size();
        const size_t half = (lamps + 63) / 64;
        width_ = 2 * half;
        reaching_.assign(points_.size() * width_, 0);
        for (size_t point = 0; point < points_.size(); ++point) {
            for (size_t i = 0; i < lamps; ++i) {
                if (shares[point][i] > 0)
                    reaching_[point * width_ + i / 64] |= uint64_t{1} << (i % 64);
            }
        }
        const auto add_beside = [&](size_t point, size_t other) {
            for (size_t i = 0; i < half; ++i)
                reaching_[point * width_ + half + i] |= reaching_[other * width_ + i];
        };
        for (size_t point = 0; point < points_.size(); ++point) {
            add_beside(point, point);
            for (const uint32_t other : points_[point].beside)
                add_beside(point, other);
        }
    }

    void join(Words& lamps, uint32_t point) const {
        for (size_t i = 0; i < width_; ++i)
            lamps[i] |= reaching_[point * width_ + i];
    }

    double rays_to(const Words& lamps) const {
        double sum = 0;
        const size_t half = width_ / 2;
        for (size_t i = 0; half > 0 && i < lamps.size(); ++i) {
            double part = 0;
            for (uint64_t word = lamps[i]; word != 0; word &= word - 1)
                part += weights_[64 * (i % half) + static_cast<size_t>(std::countr_zero(word))];
            sum += i < half ? part : kOnlyBeside * part;
        }
        return sum;
    }

    /// The shadow rays to all lamps of a part.
    double rays_of(const RegionPart& part) const {
        Words lamps(width_, 0);
        for (const uint32_t point : part.points)
            join(lamps, point);
        for (const uint32_t point : part.guests)
            join(lamps, point);
        return rays_to(lamps);
    }

    /// The part of the thing that a point speaks for, along an axis.
    double low_of(uint32_t point, int axis) const {
        return std::min(points_[point].position[axis], spoken_[point].low[axis]);
    }
    double high_of(uint32_t point, int axis) const {
        return std::max(points_[point].position[axis], spoken_[point].high[axis]);
    }

    /// The points and guests of a part along an axis: by where begins and ends what they speak for.
    struct SpokenOrder {
        std::vector<uint32_t> rising_low;
        std::vector<uint32_t> falling_high;
    };
    SpokenOrder order_of(const RegionPart& part, int axis) const {
        SpokenOrder out;
        out.rising_low = part.points;
        out.rising_low.insert(out.rising_low.end(), part.guests.begin(), part.guests.end());
        out.falling_high = out.rising_low;
        std::stable_sort(out.rising_low.begin(), out.rising_low.end(),
                         [&](uint32_t a, uint32_t b) { return low_of(a, axis) < low_of(b, axis); });
        std::stable_sort(
            out.falling_high.begin(), out.falling_high.end(),
            [&](uint32_t a, uint32_t b) { return high_of(a, axis) > high_of(b, axis); });
        return out;
    }

    /// The rays to the lamps before each plane, and behind it. `planes` rise.
    void rays_beside(const SpokenOrder& order, int axis, std::span<const double> planes,
                     std::vector<double>& before, std::vector<double>& behind) const {
        before.resize(planes.size());
        behind.resize(planes.size());
        Words lamps(width_, 0);
        size_t next = 0;
        for (size_t k = 0; k < planes.size(); ++k) {
            for (;
                 next < order.rising_low.size() && low_of(order.rising_low[next], axis) < planes[k];
                 ++next)
                join(lamps, order.rising_low[next]);
            before[k] = rays_to(lamps);
        }
        lamps.assign(width_, 0);
        next = 0;
        for (size_t k = planes.size(); k-- > 0;) {
            for (; next < order.falling_high.size() &&
                   high_of(order.falling_high[next], axis) > planes[k];
                 ++next)
                join(lamps, order.falling_high[next]);
            behind[k] = rays_to(lamps);
        }
    }

    /// Planes where the light of lamps begins or ends along an axis, as far as points speak: midway
    /// to the next place that is spoken for.
    std::vector<double> ends_of_light(const SpokenOrder& order, int axis) const {
        std::vector<double> out;
        Words known(width_, 0);
        const auto adds_lamp = [&](uint32_t point) {
            bool fresh = false;
            for (size_t i = 0; i < width_; ++i) {
                const uint64_t here = reaching_[point * width_ + i];
                fresh = fresh || (here & ~known[i]) != 0;
                known[i] |= here;
            }
            return fresh;
        };
        for (const uint32_t point : order.rising_low) {
            if (!adds_lamp(point))
                continue;
            const double begin = low_of(point, axis);
            const auto before = std::upper_bound(
                order.falling_high.begin(), order.falling_high.end(), begin,
                [&](double at, uint32_t other) { return high_of(other, axis) < at; });
            out.push_back(
                before == order.falling_high.end() ? begin : (begin + high_of(*before, axis)) / 2);
        }
        known.assign(width_, 0);
        for (const uint32_t point : order.falling_high) {
            if (!adds_lamp(point))
                continue;
            const double end = high_of(point, axis);
            const auto behind = std::upper_bound(
                order.rising_low.begin(), order.rising_low.end(), end,
                [&](double at, uint32_t other) { return at < low_of(other, axis); });
            out.push_back(behind == order.rising_low.end() ? std::nextafter(end, kInfinity)
                                                           : (end + low_of(*behind, axis)) / 2);
        }
        return out;
    }

    /// The planes across an axis that are tried, rising. `positions` of the points rise.
    std::vector<double> planes_to_try(const SpokenOrder& order, int axis, double size,
                                      const std::vector<double>& positions) const {
        const auto gap = [&](size_t i) { return positions[i] - positions[i - 1]; };
        std::vector<size_t> places;
        for (size_t i = kCell; i + kCell <= positions.size(); ++i)
            places.push_back(i);
        std::stable_sort(places.begin(), places.end(),
                         [&](size_t a, size_t b) { return gap(a) > gap(b); });
        places.resize(std::min(places.size(), kGaps));
        places.push_back(positions.size() / 2);
        std::vector<double> out;
        for (const size_t place : places) {
            if (gap(place) > kNarrow * size)
                out.push_back((positions[place] + positions[place - 1]) / 2);
        }
        std::vector<double> ends = ends_of_light(order, axis);
        std::erase_if(ends, [&](double at) {
            return !(at > positions[kCell - 1] && at <= positions[positions.size() - kCell]);
        });
        std::sort(ends.begin(), ends.end());
        ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
        const size_t count = std::min(ends.size(), kEnds);
        for (size_t i = 0; i < count; ++i)
            out.push_back(ends[i * ends.size() / count]);
        std::sort(out.begin(), out.end());
        return out;
    }

    SplitPlane best_plane(const RegionPart& part, double size) const {
        SplitPlane best;
        best.cost = std::numeric_limits<double>::infinity();
        std::vector<double> before;
        std::vector<double> behind;
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<double> positions;
            for (const uint32_t point : part.points)
                positions.push_back(points_[point].position[axis]);
            std::sort(positions.begin(), positions.end());
            if (!(positions.back() - positions.front() > kFlat * size))
                continue;
            const SpokenOrder order = order_of(part, axis);
            const std::vector<double> planes = planes_to_try(order, axis, size, positions);
            rays_beside(order, axis, planes, before, behind);
            for (size_t k = 0; k < planes.size(); ++k) {
                const auto low = static_cast<double>(
                    std::lower_bound(positions.begin(), positions.end(), planes[k]) -
                    positions.begin());
                const double cost =
                    low * before[k] + (static_cast<double>(positions.size()) - low) * behind[k];
                if (cost < best.cost)
                    best = {cost, axis, planes[k]};
            }
        }
        return best;
    }

    /// The plane with half of the points on each side, across their longest extent.
    SplitPlane middle_plane(const std::vector<uint32_t>& points, double size) const {
        Box3 box;
        for (const uint32_t point : points)
            box.add(points_[point].position);
        SplitPlane plane;
        plane.cost = std::numeric_limits<double>::infinity();
        plane.axis = box.longest_axis();
        std::vector<double> places;
        places.reserve(points.size());
        for (const uint32_t point : points)
            places.push_back(points_[point].position[plane.axis]);
        std::sort(places.begin(), places.end());
        const size_t middle = places.size() / 2;
        if (places[middle] - places[middle - 1] > kNarrow * size)
            plane = {0, plane.axis, (places[middle] + places[middle - 1]) / 2};
        return plane;
    }

    /// Finds how a part is cut, if that is worth it.
    void plan(RegionPart& part, double size) const {
        part.gain = -1;
        const double rays = rays_of(part);
        if (rays <= kFewRays || part.points.size() < 2 * kCell)
            return;
        const double cost = static_cast<double>(part.points.size()) * rays;
        part.plane = best_plane(part, size);
        if (part.plane.cost <= kWorthCutting * cost) {
            part.gain = cost - part.plane.cost;
        } else if (rays > kManyRays && part.points.size() > kManyPoints) {
            // Where very many lamps shine everywhere, each box has few near lamps of its own, and
            // few lights for the others.
            part.plane = middle_plane(part.points, size);
            part.gain = part.plane.cost < std::numeric_limits<double>::infinity() ? 0 : -1;
        }
    }

    /// The two parts that a part is cut into.
    std::pair<RegionPart, RegionPart> halves(const RegionPart& part) const {
        const SplitPlane& plane = part.plane;
        RegionPart low;
        RegionPart high;
        low.box = high.box = part.box;
        low.box.high[plane.axis] = high.box.low[plane.axis] = plane.at;
        for (const uint32_t point : part.points) {
            const bool is_low = points_[point].position[plane.axis] < plane.at;
            (is_low ? low : high).points.push_back(point);
            if (is_low && high_of(point, plane.axis) > plane.at)
                high.guests.push_back(point);
            else if (!is_low && low_of(point, plane.axis) < plane.at)
                low.guests.push_back(point);
        }
        for (const uint32_t point : part.guests) {
            if (low_of(point, plane.axis) < plane.at)
                low.guests.push_back(point);
            if (high_of(point, plane.axis) > plane.at)
                high.guests.push_back(point);
        }
        return {std::move(low), std::move(high)};
    }

    std::span<const double> weights_;  // by lamp
    std::span<const Box3> spoken_;     // by point
    std::span<const LitPoint> points_;
    Words reaching_;  // by point, see note_lamps()
    size_t width_ = 0;
};

}  // namespace

std::vector<std::vector<CutBox>> cut_things(std::span<const CutBox> things,
                                            std::span<const double> weights,
                                            const LightShares& shares, std::span<const Box3> spoken,
                                            std::span<const LitPoint> points) {
    const RegionCutter cutter(weights, shares, spoken, points);
    std::vector<std::vector<CutBox>> out(things.size());
    parallel_for(things.size(), [&](size_t i) { out[i] = cutter.cut(things[i]); });
    return out;
}

}  // namespace lodestone::light
