// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/region/light_regions.h"

#include "light/region/region_cut.h"

#include <algorithm>

namespace lodestone::light {
namespace {

// The points that make a thing a region of its own.
// Taste: fewer give more regions with shorter lists of lamps, and more light groups.
constexpr size_t kOwn = 24;

class RegionMaker {
public:
    RegionMaker(std::span<const Bound> bounds, std::vector<LitPoint>& points)
        : bounds_(bounds), points_(points), of_thing_(bounds.size()), middles_(bounds.size()) {
        for (uint32_t i = 0; i < points.size(); ++i)
            of_thing_[points[i].region].push_back(i);
        for (size_t i = 0; i < bounds.size(); ++i) {
            for (const uint32_t point : of_thing_[i])
                middles_[i] += points[point].position / static_cast<double>(of_thing_[i].size());
        }
    }

    LightRegions make(std::span<const uint8_t> divisible, std::span<const double> weights,
                      const LightShares& shares, std::span<const Box3> spoken) {
        std::vector<uint32_t> few;
        std::vector<CutBox> to_cut;
        std::vector<uint32_t> cut_of(bounds_.size(), kNoRegion);
        for (uint32_t i = 0; i < bounds_.size(); ++i) {
            if (of_thing_[i].size() >= kOwn && divisible[i] != 0) {
                cut_of[i] = static_cast<uint32_t>(to_cut.size());
                to_cut.push_back({widened(bounds_[i].box), of_thing_[i]});
            } else if (!of_thing_[i].empty() && of_thing_[i].size() < kOwn) {
                few.push_back(i);
            }
        }
        pool(few);
        const std::vector<std::vector<CutBox>> cuts =
            cut_things(to_cut, weights, shares, spoken, points_);
        LightRegions out;
        for (uint32_t i = 0; i < bounds_.size(); ++i) {
            if (cut_of[i] != kNoRegion)
                add(i, cuts[cut_of[i]], out);
            else
                out.pieces.push_back({i, region_of_whole(i), {}});
        }
        out.count = next_;
        return out;
    }

private:
    /// No part of a thing may lie outside of the boxes that it is cut into.
    static Box3 widened(Box3 box) {
        const double margin = 0.01 * glm::length(box.size());
        box.low -= margin;
        box.high += margin;
        return box;
    }

    void add(uint32_t thing, std::span<const CutBox> boxes, LightRegions& out) {
        for (const CutBox& part : boxes) {
            for (const uint32_t point : part.points)
                points_[point].region = next_;
            out.pieces.push_back({thing, next_++, {}});
            if (boxes.size() > 1)
                out.pieces.back().within = part.box;
        }
    }

    /// The region of a thing that is not cut; none without points.
    uint32_t region_of_whole(uint32_t thing) {
        if (of_thing_[thing].empty())
            return kNoRegion;
        const uint32_t region = of_thing_[thing].size() < kOwn ? pooled_.at(thing) : next_++;
        for (const uint32_t point : of_thing_[thing])
            points_[point].region = region;
        return region;
    }

    /// Joins neighboring things to regions that have enough points together.
    void pool(std::vector<uint32_t> things) {
        if (things.empty())
            return;
        size_t count = 0;
        Box3 box;
        for (const uint32_t thing : things) {
            count += of_thing_[thing].size();
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
        const int axis = box.longest_axis();
        std::stable_sort(things.begin(), things.end(), [&](uint32_t a, uint32_t b) {
            return middles_[a][axis] < middles_[b][axis];
        });
        size_t low = 0;
        size_t at = 0;
        while (at + 1 < things.size() && (at == 0 || 2 * low < count))
            low += of_thing_[things[at++]].size();
        const auto middle = things.begin() + static_cast<ptrdiff_t>(at);
        pool({things.begin(), middle});
        pool({middle, things.end()});
    }

    std::span<const Bound> bounds_;
    std::vector<LitPoint>& points_;
    std::vector<std::vector<uint32_t>> of_thing_;  // the points of each thing
    std::vector<glm::dvec3> middles_;              // by thing
    std::vector<uint32_t> pooled_;                 // by thing
    uint32_t next_ = 0;
};

}  // namespace

LightRegions make_light_regions(std::span<const Bound> bounds, std::span<const uint8_t> divisible,
                                std::span<const double> weights, const LightShares& shares,
                                std::span<const Box3> spoken, std::vector<LitPoint>& points) {
    return RegionMaker(bounds, points).make(divisible, weights, shares, spoken);
}

}  // namespace lodestone::light
