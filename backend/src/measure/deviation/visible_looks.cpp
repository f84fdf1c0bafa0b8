// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/deviation/visible_looks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace lodestone::measure {
namespace {

/// Whether it is known which side of a place is seen; then it is a unit vector.
bool is_sided(const glm::dvec3& side) {
    // Law: half of a unit vector's square; sides are unit vectors or 0.
    constexpr double kUnknown = 0.5;
    return !(glm::dot(side, side) < kUnknown);
}

/// Whether two places can be seen at once: not the grass from above and the road from below.
bool face_alike(const glm::dvec3& a, const glm::dvec3& b) {
    return !is_sided(a) || !is_sided(b) || glm::dot(a, b) > 0;
}

/// The light of LookPalette::light_of(), for colors that are mostly those before.
class LightOf {
public:
    const glm::dvec3& operator()(const glm::dvec3& color) {
        if (color != color_) {
            color_ = color;
            light_ = LookPalette::light_of(color);
        }
        return light_;
    }

private:
    glm::dvec3 color_{0.0};
    glm::dvec3 light_ = LookPalette::light_of(glm::dvec3(0.0));
};

std::vector<uint8_t> glowing(const std::vector<SurfaceSample>& visible,
                             const LookPalette* palette) {
    // The factor above the mean light from which on a look glows.
    // Taste: a larger value takes fewer looks for lamps.
    constexpr double kMuch = 2;
    std::vector<uint8_t> out;
    if (palette == nullptr)
        return out;
    const auto brightest = [](const glm::dvec3& light) {
        return std::max({light.x, light.y, light.z});
    };
    LightOf light_of;
    double light = 0;
    double weight = 0;
    std::set<uint16_t> looks;
    for (const SurfaceSample& sample : visible) {
        if (sample.look == kAnyLook)
            continue;
        const double covered = sample.weight * palette->opacity(sample.look);
        light += covered * brightest(light_of(sample.color));
        weight += covered;
        looks.insert(sample.look);
    }
    for (const uint16_t look : looks) {
        out.resize(std::max<size_t>(out.size(), look + size_t{1}), 0);
        const double own = brightest(palette->emission(look));
        out[look] = own > 0 && own * weight > kMuch * light ? 1 : 0;
    }
    return out;
}

}  // namespace

VisibleLooks::VisibleLooks(const std::vector<SurfaceSample>& visible, const LookPalette* palette)
    : visible_(visible), glowing_(glowing(visible, palette)) {
    // The visible points that a mean is taken from, at most.
    // Taste: a larger value knows where colors mix more exactly, for time at every sample.
    constexpr size_t kMostPoints = 512;
    LightOf light_of;
    const size_t step = std::max<size_t>(1, visible.size() / kMostPoints);
    for (size_t run = 0; run < visible.size(); run += step) {
        // Any point of each run will do: they were drawn evenly, and points at a regular step of
        // such a sequence are in one place.
        const size_t i = std::min(run + scramble(run) % step, visible.size() - 1);
        if (visible[i].look != kAnyLook)
            mixed_.push_back({visible[i].point, visible[i].side, light_of(visible[i].color),
                              is_sided(visible[i].side)});
    }
}

const std::map<uint16_t, PointTree>& VisibleLooks::by_look() const {
    std::call_once(once_, [&] {
        std::map<uint16_t, std::pair<std::vector<glm::dvec3>, std::vector<uint32_t>>> looks;
        for (uint32_t i = 0; i < visible_.size(); ++i) {
            if (visible_[i].look == kAnyLook)
                continue;
            auto& [points, numbers] = looks[visible_[i].look];
            points.push_back(visible_[i].point);
            numbers.push_back(i);
        }
        for (auto& [look, list] : looks)
            by_look_.try_emplace(look, std::move(list.first), std::move(list.second));
    });
    return by_look_;
}

double VisibleLooks::nearest(const SurfaceSample& from, uint16_t look, double most) const {
    const auto tree = by_look().find(look);
    if (tree == by_look().end())
        return most;
    return std::sqrt(tree->second.nearest(from.point, most * most, [&](uint32_t i) {
        return face_alike(visible_[i].side, from.side);
    }));
}

double VisibleLooks::nearest_of_color(const SurfaceSample& from, const glm::dvec3& color,
                                      double most) const {
    double square = most * most;
    for (const auto& [look, tree] : by_look()) {
        square = tree.nearest(from.point, square, [&](uint32_t i) {
            return LookPalette::alike(visible_[i].color, color) &&
                   face_alike(visible_[i].side, from.side);
        });
    }
    return std::sqrt(square);
}

double VisibleLooks::mixing_radius(const SurfaceSample& from, const glm::dvec3& color,
                                   double most) const {
    // The keys of near points: the square of the distance and the number. Bits of floats that are
    // not negative are in order. Nobody can guess which points are near, so all are written, and
    // the next one over a point that is not.
    std::vector<uint64_t> near(mixed_.size());
    const bool sided = is_sided(from.side);
    size_t count = 0;
    float farthest = 0;
    for (uint32_t i = 0; i < mixed_.size(); ++i) {
        const MixingSample& next = mixed_[i];
        const glm::dvec3 arm = next.point - from.point;
        const double square = glm::dot(arm, arm);
        const auto rounded = static_cast<float>(square);
        near[count] = uint64_t{std::bit_cast<uint32_t>(rounded)} << 32u | i;
        const bool turned = !(glm::dot(next.side, from.side) > 0);
        const bool reached = square < most * most;
        const bool counts = reached & !(sided & next.sided & turned);
        farthest = std::max(farthest, counts ? rounded : 0);
        count += static_cast<size_t>(counts);
    }
    near.resize(count);
    // Points of a surface are spread about evenly over squares of distances: a few to a bin.
    // Taste: 512 points make eight to a bin; a larger value sorts shorter runs and has more empty
    // bins.
    constexpr size_t kBins = 64;
    const float scale = static_cast<float>(kBins) / farthest;
    const auto bin_of = [&](uint64_t key) {
        const float square = std::bit_cast<float>(static_cast<uint32_t>(key >> 32u));
        return std::isnormal(scale) ? std::min(static_cast<size_t>(square * scale), kBins - 1) : 0;
    };
    std::array<size_t, kBins + 1> ends{};  // ends of the bins before, from the second on
    for (const uint64_t key : near)
        ++ends[bin_of(key) + 1];
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    std::vector<uint64_t> binned(count);
    for (const uint64_t key : near)
        binned[ends[bin_of(key)]++] = key;
    const LookPalette::LightRange wanted = LookPalette::lights_alike(color);
    glm::dvec3 sum(0.0);
    size_t begin = 0;
    for (size_t bin = 0; begin < count; begin = ends[bin++]) {
        const auto at = [&](size_t i) { return binned.begin() + static_cast<ptrdiff_t>(i); };
        std::sort(at(begin), at(ends[bin]));
        for (size_t i = begin; i < ends[bin]; ++i) {
            const MixingSample& next = mixed_[static_cast<uint32_t>(binned[i])];
            sum += next.light;
            if (wanted.hold(sum / static_cast<double>(i + 1)))
                return glm::length(next.point - from.point);
        }
    }
    return most;
}

double VisibleLooks::mixing_radius_at(size_t number, const glm::dvec3& color) const {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const std::shared_ptr<const MixingRadii> radii = radii_of(color);
    std::atomic<double>& known = radii->by_number[number];
    double radius = known.load(std::memory_order_relaxed);
    if (radius < 0) {
        radius = mixing_radius(visible_[number], color, kNever);
        known.store(radius, std::memory_order_relaxed);
    }
    return radius;
}

std::shared_ptr<const VisibleLooks::MixingRadii> VisibleLooks::radii_of(
    const glm::dvec3& color) const {
    const std::lock_guard lock(mutex_);
    if (!radii_ || radii_->color != color) {
        auto fresh = std::make_shared<MixingRadii>();
        fresh->color = color;
        fresh->by_number = std::make_unique<std::atomic<double>[]>(visible_.size());
        for (size_t i = 0; i < visible_.size(); ++i)
            fresh->by_number[i].store(-1, std::memory_order_relaxed);
        radii_ = std::move(fresh);
    }
    return radii_;
}

}  // namespace lodestone::measure
