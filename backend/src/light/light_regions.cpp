// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/light_regions.h"

#include <glm/common.hpp>

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace lodestone::light {
namespace {

// The points that make a thing a region of its own.
// Taste: fewer give more regions with shorter lists of lamps, and more light groups.
constexpr size_t kOwn = 24;
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
constexpr double kWorthCutting = 0.8;
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
// The least extent of points along an axis that is cut, in parts of the thing's size.
// Taste: a flat thing is not cut along itself.
constexpr double kFlat = 1e-4;
// The narrowest gap between points that is cut, in parts of the thing's size.
// Law: positions are known to about that, so narrower ones may be none.
constexpr double kNarrow = 1e-7;

class RegionMaker {
public:
    RegionMaker(std::span<const Bound> bounds, std::span<const uint8_t> divisible,
                std::span<const double> weights, const LightShares& shares,
                std::vector<LitPoint>& points)
        : bounds_(bounds),
          divisible_(divisible),
          weights_(weights),
          shares_(shares),
          points_(points) {}

    LightRegions make() {
        note_lamps();
        std::vector<std::vector<uint32_t>> of_thing(bounds_.size());
        for (uint32_t i = 0; i < points_.size(); ++i)
            of_thing[points_[i].region].push_back(i);
        std::vector<uint32_t> few;
        std::vector<std::vector<LitPiece>> pieces(bounds_.size());
        middles_.resize(bounds_.size());
        counts_.resize(bounds_.size());
        for (uint32_t i = 0; i < bounds_.size(); ++i) {
            counts_[i] = of_thing[i].size();
            pieces[i].push_back({i, kNoRegion, {}});
            if (of_thing[i].empty())
                continue;
            for (const uint32_t point : of_thing[i])
                middles_[i] += points_[point].position / static_cast<double>(counts_[i]);
            if (counts_[i] < kOwn) {
                few.push_back(i);
                continue;
            }
            pieces[i].clear();
            cut(i, of_thing[i], divisible_[i] != 0, pieces[i]);
        }
        pool(few);
        for (const uint32_t thing : few) {
            pieces[thing][0].group = pooled_.at(thing);
            for (const uint32_t point : of_thing[thing])
                points_[point].region = pieces[thing][0].group;
        }
        LightRegions out;
        out.count = next_;
        for (const std::vector<LitPiece>& some : pieces)
            out.pieces.insert(out.pieces.end(), some.begin(), some.end());
        return out;
    }

private:
    struct RegionPart {
        Box3 box;
        std::vector<uint32_t> points;
    };
    struct SplitPlane {
        double cost = 0;
        int axis = 0;
        double at = 0;
    };

    using Words = std::vector<uint64_t>;  // a bit for every lamp

    /// Notes the lamps that reach each point, `width_` words for each.
    void note_lamps() {
        const size_t lamps = shares_.empty() ? 0 : shares_[0].size();
        width_ = (lamps + 63) / 64;
        reaching_.assign(points_.size() * width_, 0);
        for (size_t point = 0; point < points_.size(); ++point) {
            for (size_t i = 0; i < lamps; ++i) {
                if (shares_[point][i] > 0)
                    reaching_[point * width_ + i / 64] |= uint64_t{1} << (i % 64);
            }
        }
    }

    void join(Words& lamps, uint32_t point) const {
        for (size_t i = 0; i < width_; ++i)
            lamps[i] |= reaching_[point * width_ + i];
    }

    double rays_to(const Words& lamps) const {
        double sum = 0;
        for (size_t i = 0; i < lamps.size(); ++i) {
            for (uint64_t word = lamps[i]; word != 0; word &= word - 1)
                sum += weights_[64 * i + static_cast<size_t>(std::countr_zero(word))];
        }
        return sum;
    }

    /// The shadow rays to all lamps that reach any of the points.
    double rays_of(std::span<const uint32_t> points) const {
        Words lamps(width_, 0);
        for (const uint32_t point : points)
            join(lamps, point);
        return rays_to(lamps);
    }

    /// The rays to the lamps that reach any of the points before each place, and from it on.
    /// `places` rise.
    void rays_beside(std::span<const uint32_t> points, std::span<const size_t> places,
                     std::vector<double>& before, std::vector<double>& behind) const {
        before.resize(places.size());
        behind.resize(places.size());
        Words lamps(width_, 0);
        size_t next = 0;
        for (size_t k = 0; k < places.size(); ++k) {
            for (; next < places[k]; ++next)
                join(lamps, points[next]);
            before[k] = rays_to(lamps);
        }
        lamps.assign(width_, 0);
        next = points.size();
        for (size_t k = places.size(); k-- > 0;) {
            for (; next > places[k]; --next)
                join(lamps, points[next - 1]);
            behind[k] = rays_to(lamps);
        }
    }

    /// The places where the first or the last point is that a lamp reaches, rising.
    std::vector<size_t> ends_of_light(std::span<const uint32_t> points) const {
        std::vector<size_t> out;
        Words known(width_, 0);
        const auto note = [&](size_t at, size_t place) {
            bool fresh = false;
            for (size_t i = 0; i < width_; ++i) {
                const uint64_t here = reaching_[points[at] * width_ + i];
                fresh = fresh || (here & ~known[i]) != 0;
                known[i] |= here;
            }
            if (fresh && place >= kCell && place + kCell <= points.size())
                out.push_back(place);
        };
        for (size_t i = 0; i < points.size(); ++i)
            note(i, i);
        known.assign(width_, 0);
        for (size_t i = points.size(); i-- > 0;)
            note(i, i + 1);
        std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
        if (out.size() > kEnds) {
            for (size_t i = 0; i < kEnds; ++i)
                out[i] = out[i * out.size() / kEnds];
            out.resize(kEnds);
        }
        return out;
    }

    SplitPlane best_plane(const std::vector<uint32_t>& given, double size) {
        SplitPlane best;
        best.cost = std::numeric_limits<double>::infinity();
        std::vector<uint32_t> points = given;
        std::vector<double> before;
        std::vector<double> behind;
        for (int axis = 0; axis < 3; ++axis) {
            std::stable_sort(points.begin(), points.end(), [&](uint32_t a, uint32_t b) {
                return points_[a].position[axis] < points_[b].position[axis];
            });
            if (!(points_[points.back()].position[axis] - points_[points[0]].position[axis] >
                  kFlat * size))
                continue;
            std::vector<size_t> places;
            for (size_t i = kCell; i + kCell <= points.size(); ++i)
                places.push_back(i);
            const auto gap = [&](size_t i) {
                return points_[points[i]].position[axis] - points_[points[i - 1]].position[axis];
            };
            std::stable_sort(places.begin(), places.end(),
                             [&](size_t a, size_t b) { return gap(a) > gap(b); });
            places.resize(std::min(places.size(), kGaps));
            places.push_back(points.size() / 2);
            const std::vector<size_t> ends = ends_of_light(points);
            places.insert(places.end(), ends.begin(), ends.end());
            std::vector<size_t> rising = places;
            std::sort(rising.begin(), rising.end());
            rays_beside(points, rising, before, behind);
            for (const size_t place : places) {
                if (!(gap(place) > kNarrow * size))
                    continue;
                const auto at = static_cast<size_t>(
                    std::lower_bound(rising.begin(), rising.end(), place) - rising.begin());
                const double cost = static_cast<double>(place) * before[at] +
                                    static_cast<double>(points.size() - place) * behind[at];
                if (cost < best.cost)
                    best = {cost, axis,
                            (points_[points[place]].position[axis] +
                             points_[points[place - 1]].position[axis]) /
                                2};
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
        for (int axis = 1; axis < 3; ++axis) {
            if (box.size()[axis] > box.size()[plane.axis])
                plane.axis = axis;
        }
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

    void cut(uint32_t thing, const std::vector<uint32_t>& points, bool divisible,
             std::vector<LitPiece>& out) {
        RegionPart whole;
        whole.box = bounds_[thing].box;
        // No part of the thing may lie outside of the boxes.
        const double margin = 0.01 * glm::length(whole.box.size());
        whole.box.low -= margin;
        whole.box.high += margin;
        whole.points = points;
        const double size = glm::length(whole.box.size());
        std::vector<RegionPart> open{whole};
        std::vector<RegionPart> done;
        while (!open.empty()) {
            RegionPart part = std::move(open.back());
            open.pop_back();
            const double rays = rays_of(part.points);
            if (!divisible || rays <= kFewRays || part.points.size() < 2 * kCell ||
                open.size() + done.size() + 2 > kPieces) {
                done.push_back(std::move(part));
                continue;
            }
            SplitPlane plane = best_plane(part.points, size);
            const bool worth =
                plane.cost <= kWorthCutting * static_cast<double>(part.points.size()) * rays;
            // Where very many lamps shine everywhere, each box has few near lamps of its own, and
            // few lights for the others.
            if (!worth && rays > kManyRays && part.points.size() > kManyPoints &&
                open.size() + done.size() + 2 <= kEvenPieces)
                plane = middle_plane(part.points, size);
            else if (!worth)
                plane.cost = std::numeric_limits<double>::infinity();
            if (!(plane.cost < std::numeric_limits<double>::infinity())) {
                done.push_back(std::move(part));
                continue;
            }
            RegionPart low;
            RegionPart high;
            low.box = high.box = part.box;
            low.box.high[plane.axis] = high.box.low[plane.axis] = plane.at;
            for (const uint32_t point : part.points)
                (points_[point].position[plane.axis] < plane.at ? low : high)
                    .points.push_back(point);
            open.push_back(std::move(high));
            open.push_back(std::move(low));
        }
        for (const RegionPart& part : done) {
            for (const uint32_t point : part.points)
                points_[point].region = next_;
            out.push_back({thing, next_++, {}});
            if (done.size() > 1)
                out.back().within = part.box;
        }
    }

    /// Joins neighboring things to regions that have enough points together.
    void pool(std::vector<uint32_t> things) {
        if (things.empty())
            return;
        size_t count = 0;
        Box3 box;
        for (const uint32_t thing : things) {
            count += counts_[thing];
            box.add(middles_[thing]);
        }
        if (pooled_.empty())
            pooled_.assign(bounds_.size(), kNoRegion);
        if (count < 2 * kOwn || things.size() == 1) {
            for (const uint32_t thing : things)
                pooled_[thing] = next_;
            ++next_;
            return;
        }
        const glm::dvec3 size = box.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
        std::stable_sort(things.begin(), things.end(), [&](uint32_t a, uint32_t b) {
            return middles_[a][axis] < middles_[b][axis];
        });
        size_t low = 0;
        size_t at = 0;
        while (at + 1 < things.size() && (at == 0 || 2 * low < count))
            low += counts_[things[at++]];
        const auto middle = things.begin() + static_cast<ptrdiff_t>(at);
        pool({things.begin(), middle});
        pool({middle, things.end()});
    }

    std::span<const Bound> bounds_;
    std::span<const uint8_t> divisible_;
    std::span<const double> weights_;  // by lamp
    const LightShares& shares_;
    std::vector<LitPoint>& points_;
    std::vector<size_t> counts_;       // by thing
    std::vector<glm::dvec3> middles_;  // by thing
    std::vector<uint32_t> pooled_;     // by thing
    std::vector<uint64_t> reaching_;   // by point, see note_lamps()
    size_t width_ = 0;
    uint32_t next_ = 0;
};

}  // namespace

LightRegions make_light_regions(std::span<const Bound> bounds, std::span<const uint8_t> divisible,
                                std::span<const double> weights, const LightShares& shares,
                                std::vector<LitPoint>& points) {
    return RegionMaker(bounds, divisible, weights, shares, points).make();
}

}  // namespace lodestone::light
