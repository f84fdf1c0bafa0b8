// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/slack.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace lodestone::quality {
namespace {

// Margins. Where a decision turns is known to some 1e-15 of a distance, a distance to as much of the
// coordinates it is made of, and a turning camera's pixels to some 1e-15.
constexpr double kTurned = 1e-9;  // by so much pixels may differ and count as the same
constexpr double kRounding = 1e-8;
constexpr double kOfPlaces = 1e-11;
constexpr double kOfTravel = 1e-12;
constexpr double kFarthest = 1e9;    // metres of travel
constexpr size_t kBlock = 32;        // nodes that are skipped together
constexpr double kSingle = 0x1p-22;  // rounding of single precision, and more
constexpr float kExpired = -std::numeric_limits<float>::infinity();
constexpr double kLargestSingle = std::numeric_limits<float>::max();

/// In single precision, and no more than it is.
float below(double value) {
    const double less = value * (value > 0 ? 1 - kSingle : 1 + kSingle);
    return less < -kLargestSingle ? kExpired : static_cast<float>(std::min(less, kLargestSingle));
}

/// And no less; no number where that is too much.
float above(double value) {
    return value < kLargestSingle ? -below(-value) : std::numeric_limits<float>::quiet_NaN();
}

}  // namespace

Walk::Walk(const Table& of, const View& from)
    : table(of), view(from), frame(pixel_at_1m(from)), pixel(frame) {}

bool Walk::to(const View& next) {
    const double moved = glm::length(next.camera.position - view.camera.position);
    travel = std::nextafter(travel + moved * (1 + kRounding), kInfinity);
    if (!(travel < kFarthest))
        return false;
    view.camera = next.camera;
    view.border = next.border;
    pixel = pixel_at_1m(next);
    return true;
}

bool Walk::same_pixels(double a, double b) {
    return std::abs(a - b) <= kTurned * b;
}

Sight Walk::sight_of(const Affine& world, const Seen& seen) const {
    Sight sight;
    sight.z = distance_of(table.bound(seen.row), world, seen.stretch, view.camera.position);
    sight.pixel = pixel * std::max(sight.z, view.camera.near_clip);
    sight.stretch = seen.stretch;
    sight.total = seen.total;
    return sight;
}

double Walk::margin(const Affine& world, const Seen& seen, double z) const {
    const Bound bound = table.bound(seen.row);
    return kOfPlaces * (glm::length(view.camera.position) + glm::length(world(bound.center)) +
                        bound.radius * seen.stretch + z) +
           kOfTravel * travel;
}

void Slack::resize(size_t count) {
    expires_.resize(count);
    sizes_.resize(count);
    places_.resize(count);
}

void Slack::grow(size_t most) {
    for (std::vector<float>* one : {&expires_, &sizes_, &places_}) {
        if (one->capacity() < most)
            one->reserve(most + most / 4);
    }
}

void Slack::set(size_t index, const Walk& walk, const Placed& placed, const Seen& seen,
                const Sight& sight, const Decision& made) {
    const Node& node = placed.node;
    const TableRow& row = walk.table.row(seen.row);
    const double per_metre = walk.view.pixel_error * walk.frame;
    bool numbers = true;
    /// The distance from which on an error is good enough.
    const auto from = [&](double error) {
        if (std::isinf(sight.total))
            return kInfinity;
        const double size = error * sight.stretch * sight.total;
        numbers = numbers && size >= 0;
        return size > 0 ? size / per_metre : 0;
    };
    double low = 0;
    double high = kInfinity;
    bool first = true;
    for (uint32_t i = row.level_count; i-- > 0;) {
        const TableLevel& level = walk.table.level(row.first_level + i);
        if (level.lod > node.coarsest)
            continue;
        if (!first && level.lod < node.finest)
            break;
        first = false;
        if (made.good && &level == made.level) {
            low = from(level.error);
            break;
        }
        high = std::min(high, from(level.error));
    }
    if (made.good && !made.pinned && made.level->opens_from < kInfinity) {
        const double opens = from(made.level->opens_from);
        if (made.cheaper)
            low = std::max(low, opens);
        else
            high = std::min(high, opens);
    }
    const double near = walk.view.camera.near_clip;
    const double z = sight.z;
    const double nearer = low <= near * (1 - kRounding) ? kInfinity : z - low * (1 + kRounding);
    const double farther = high * (1 - kRounding) - z;
    const double slack = std::min(nearer, farther);
    const double off = walk.margin(placed.world, seen, z);
    expires_[index] = numbers && slack > 0 ? below(walk.travel + slack - off) : kExpired;
    sizes_[index] = made.opened ? -1 : above(made.level->error * seen.stretch / walk.frame);
    places_[index] = below(z + walk.travel - off);
}

void Slack::copy(const Slack& from, size_t index, size_t to) {
    expires_[to] = from.expires_[index];
    sizes_[to] = from.sizes_[index];
    places_[to] = from.places_[index];
}

void Slack::move(size_t begin, size_t end, size_t to) {
    for (std::vector<float>* one : {&expires_, &sizes_, &places_})
        std::memmove(one->data() + to, one->data() + begin, (end - begin) * sizeof(float));
}

void Slack::find_expired(double travel, std::vector<uint32_t>& expired) const {
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

void Slack::find_largest(const Walk& walk, const std::vector<Seen>& seen, Cut& cut,
                         uint32_t guess) {
    cut.largest_error_px = 0;
    cut.largest_error_node = kNoParent;
    const auto consider = [&](size_t index) {
        const Node& node = cut.nodes[index];
        if (node.opened)
            return;
        const Affine& world = cut.world(node);
        const Seen& known = seen[node.transform];
        const Sight sight = walk.sight_of(world, known);
        places_[index] = below(sight.z + walk.travel - walk.margin(world, known, sight.z));
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

}  // namespace lodestone::quality
