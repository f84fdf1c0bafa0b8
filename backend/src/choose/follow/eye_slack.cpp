// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/follow/eye_slack.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace lodestone::choose {
namespace {

// The margins. The distance at which a decision changes is known to some 1e-15 of itself, a
// distance to some 1e-15 of the coordinates it is computed from, and the pixels of a turning camera
// to some 1e-15.
// Pixels that differ by less count as equal.
// Law: rounding of double precision, 1e-16, with a large margin.
constexpr double kTurned = 1e-9;
// The margin of distances, in parts of them.
// Law: ten times kTurned, so that it covers pixels that count as equal.
constexpr double kRounding = 1e-8;
// The margin in parts of coordinates.
// Law: rounding of double precision, with a large margin.
constexpr double kOfPlaces = 1e-11;
// The margin in parts of the travel.
// Law: rounding of a sum of many steps, with a large margin.
constexpr double kOfTravel = 1e-12;
// The longest travel, in metres, after which a cut is chosen anew.
// Taste: a longer one makes the margins eat more of the slack.
constexpr double kFarthest = 1e9;
// How many nodes are skipped together.
// Taste: a larger block is skipped faster but less often.
constexpr size_t kBlock = 32;
// Law: rounding of single precision is 0x1p-24; this is four times that.
constexpr double kSingle = 0x1p-22;
constexpr float kExpired = -std::numeric_limits<float>::infinity();
constexpr double kLargestSingle = std::numeric_limits<float>::max();

/// The value in single precision, rounded down.
float below(double value) {
    const double less = value * (value > 0 ? 1 - kSingle : 1 + kSingle);
    return less < -kLargestSingle ? kExpired : static_cast<float>(std::min(less, kLargestSingle));
}

/// The value in single precision, rounded up; not a number where it is too large.
float above(double value) {
    return value < kLargestSingle ? -below(-value) : std::numeric_limits<float>::quiet_NaN();
}

}  // namespace

EyeWalk::EyeWalk(const ChoiceTable& of, const View& from)
    : table(of),
      view(from),
      frame(pixel_at_1m(from)),
      pixel(frame),
      away(glm::length(from.camera.position)) {}

bool EyeWalk::advance_to(const View& next) {
    const double moved = glm::length(next.camera.position - view.camera.position);
    travel = std::nextafter(travel + moved * (1 + kRounding), kInfinity);
    if (!(travel < kFarthest))
        return false;
    view.camera = next.camera;
    view.border = next.border;
    pixel = pixel_at_1m(next);
    away = glm::length(next.camera.position);
    return true;
}

bool EyeWalk::same_pixels(double a, double b) {
    return std::abs(a - b) <= kTurned * b;
}

OccurrenceSight EyeWalk::sight_of(const Affine& world, const SeenNode& seen) const {
    OccurrenceSight sight;
    sight.z = distance_of(table.bound(seen.row), world, seen.stretch, view.camera.position);
    sight.pixel = pixel * std::max(sight.z, view.camera.near_clip);
    sight.stretch = seen.stretch;
    sight.total = seen.total;
    return sight;
}

void EyeSlack::resize(size_t count) {
    expires_.resize(count);
    sizes_.resize(count);
    places_.resize(count);
}

void EyeSlack::grow(size_t most) {
    for (std::vector<float>* one : {&expires_, &sizes_, &places_}) {
        if (one->capacity() < most)
            one->reserve(most + most / 4);
    }
}

DrawnRange::DrawnRange(const EyeWalk& walk, const CutNode& node, const Affine& world,
                       const SeenNode& seen) {
    const Bound bound = transformed(walk.table.bound(seen.row), world, seen.stretch);
    const glm::dvec3 sides = 0.5 * bound.box.size();
    const double size = sides.x + sides.y + sides.z + bound.radius;
    const glm::dvec3 middle = bound.box.center();
    const double off = kOfPlaces * (glm::length(middle) + size) + kSingle * size +
                       glm::length(bound.center - middle);
    const TableRow& row = walk.table.row(seen.row);
    const double per_metre = walk.view.pixel_error * walk.frame;
    bool numbers = size < kLargestSingle && off < kLargestSingle;
    /// The distance from which on an error is good enough.
    const auto from = [&](double error) {
        if (std::isinf(seen.total))
            return kInfinity;
        const double scaled = error * seen.stretch * seen.total;
        numbers = numbers && scaled >= 0;
        return scaled > 0 ? scaled / per_metre : 0;
    };
    double least = 0;
    double most = kInfinity;
    bool first = true;
    for (uint32_t i = row.level_count; i-- > 0;) {
        const TableLevel& level = walk.table.level(row.first_level + i);
        if (level.lod > node.coarsest)
            continue;
        if (!first && level.lod < node.finest)
            break;
        first = false;
        if (seen.good && row.first_level + i == seen.level) {
            least = from(level.error);
            break;
        }
        most = std::min(most, from(level.error));
    }
    const double opens_from = seen.good ? walk.table.level(seen.level).opens_from : kInfinity;
    if (node.finest == 0 && opens_from < kInfinity) {
        const double opens = from(opens_from);
        if (seen.cheaper)
            least = std::max(least, opens);
        else
            most = std::min(most, opens);
    }
    if (!numbers)
        return;
    center = middle;
    half = sides;
    radius = static_cast<float>(bound.radius);
    const bool anywhere = least <= walk.view.camera.near_clip * (1 - kRounding);
    low = anywhere ? -std::numeric_limits<float>::infinity() : above(least * (1 + kRounding));
    high = below(most * (1 - kRounding));
    margin = above(off);
}

double DrawnRange::distance(const glm::dvec3& eye) const {
    const glm::dvec3 arm = eye - center;
    const glm::dvec3 outside = glm::max(glm::abs(arm) - glm::dvec3(half), glm::dvec3(0.0));
    return std::max({0.0, glm::length(arm) - radius, glm::length(outside)});
}

void EyeSlack::set(size_t index, const EyeWalk& walk, const DrawnRange& range, const CutNode& node,
                   const SeenNode& seen) {
    const double error = node.opened ? 0 : walk.table.level(seen.level).error;
    sizes_[index] = node.opened ? -1 : above(error * seen.stretch / walk.frame);
    renew(index, walk, range);
}

bool EyeSlack::renew(size_t index, const EyeWalk& walk, const DrawnRange& range) {
    const double z = range.distance(walk.view.camera.position);
    const double off = range.margin + kOfPlaces * (walk.away + z) + kOfTravel * walk.travel;
    const double slack = std::min(z - range.low, range.high - z) - off;
    expires_[index] = slack > 0 ? below(walk.travel + slack) : kExpired;
    places_[index] = below(z + walk.travel - off);
    return expires_[index] > above(walk.travel);
}

void EyeSlack::copy(const EyeSlack& from, size_t index, size_t to) {
    expires_[to] = from.expires_[index];
    sizes_[to] = from.sizes_[index];
    places_[to] = from.places_[index];
}

void EyeSlack::move(size_t begin, size_t end, size_t to) {
    for (std::vector<float>* one : {&expires_, &sizes_, &places_})
        std::memmove(one->data() + to, one->data() + begin, (end - begin) * sizeof(float));
}

void EyeSlack::find_expired(double travel, std::vector<uint32_t>& expired) const {
    expired.clear();
    const size_t count = size();
    const float* expires = expires_.data();
    const float gone = above(travel);
    for (size_t begin = 0; begin < count; begin += kBlock) {
        const size_t end = std::min(begin + kBlock, count);
        int any = 0;
        for (size_t i = begin; i < end; ++i)
            any |= static_cast<int>(!(expires[i] > gone));
        if (any == 0)
            continue;
        for (size_t i = begin; i < end; ++i) {
            if (!(expires[i] > gone))
                expired.push_back(static_cast<uint32_t>(i));
        }
    }
}

void EyeSlack::find_largest(const EyeWalk& walk, const std::vector<SeenNode>& seen,
                            const std::vector<DrawnRange>& ranges, Cut& cut, uint32_t guess) {
    cut.largest_error_px = 0;
    cut.largest_error_node = kNoParent;
    const auto consider = [&](size_t index) {
        const CutNode& node = cut.nodes[index];
        if (node.opened)
            return;
        const SeenNode& known = seen[node.transform];
        const OccurrenceSight sight = walk.sight_of(cut.world(node), known);
        renew(index, walk, ranges[node.transform]);
        const TableLevel& level = walk.table.level(known.level);
        const double error = error_on_screen(sight, level.error);
        if (error > cut.largest_error_px ||
            (error == cut.largest_error_px && index < cut.largest_error_node && error > 0)) {
            cut.largest_error_px = error;
            cut.largest_error_node = static_cast<uint32_t>(index);
        }
    };
    if (guess != kNoParent)
        consider(guess);
    const size_t count = size();
    const float* sizes = sizes_.data();
    const float* places = places_.data();
    const float gone = above(walk.travel);
    const float near = below(walk.view.camera.near_clip);
    // The sum and the product are rounded, too.
    const auto least = [&] { return below(cut.largest_error_px * (1 - 4 * kSingle)); };
    for (size_t begin = 0; begin < count; begin += kBlock) {
        const size_t end = std::min(begin + kBlock, count);
        const float best = least();
        int any = 0;
        for (size_t i = begin; i < end; ++i)
            any |= static_cast<int>(!(sizes[i] <= best * std::max(places[i] - gone, near)));
        if (any == 0)
            continue;
        for (size_t i = begin; i < end; ++i) {
            if (!(sizes[i] <= least() * std::max(places[i] - gone, near)))
                consider(i);
        }
    }
}

}  // namespace lodestone::choose
