// SPDX-License-Identifier: GPL-3.0-or-later
// Light cut: the lights, some of which stand for several lamps, that light each part of a picture.
#pragma once

#include "light/light_tree.h"
#include "light/sent_radiance.h"

namespace lodestone::light {

/// The share (0...1) of a light that reaches a point, 0 for a hidden light. `blocker`: the
/// function's own number of what hid the light from a point beside, kept by the caller; it does not
/// change the result. Any thread.
using Reaches = std::function<double(const Light&, const LitPoint&, uint32_t& blocker)>;
inline constexpr uint32_t kNoBlocker = ~uint32_t{0};

/// The points in a row that one thread asks for; the same things mostly hide a light from them.
/// Taste: longer rows try the last blocker more often and share the work less evenly.
inline constexpr size_t kPointStrip = 128;

/// Whether lamps may matter at a point: all together, if nothing hid them, they would be more than a
/// quarter of what it may be off by.
bool may_matter(std::span<const Light* const> lamps, const LitPoint& point, double pixel_error);

/// By point and lamp: the share that reaches the point; 0 for points that face away from the lamp,
/// and where the lamp cannot matter.
using LightShares = std::vector<std::vector<float>>;

/// Finds the shares of the lamps of the tree at every point, the strongest first, until all others
/// together would be less than a quarter of what the point may be off by (light_tolerance), even if
/// nothing hid them.
LightShares find_shares(const LightTree& tree, std::span<const LitPoint> points,
                        const Reaches& reaches, double pixel_error, const Job& job = {});

/// By region: nodes of the tree, rising.
using LightCut = std::vector<std::vector<uint32_t>>;

/// For every region the lights that light its points as all lamps of the tree do: the root mean
/// square of the differences is at most `pixel_error` steps of an 8-bit display, and none is more
/// than 3 times that; with 0, none is more than a 1024th of its point's light (light_tolerance).
/// What is left out, all of it together, is at no point more than that 1024th, or than one step if
/// `pixel_error` allows it. A lamp counts at a point as if it shone where it reaches a point beside,
/// and where any of up to 8 lamps joined with it does. At first all lamps are left out; then always
/// what differs most is lit, or opened, until the rest may differ. A light never stands for lamps
/// that are nearer to a point than to each other. Roots that are no lamps are not in it. Any number
/// of threads gives the same result. cost: a ray for every point and light of several that is tried.
LightCut cut_lights(const LightTree& tree, std::span<const LitPoint> points,
                    const LightShares& shares, size_t regions, const Reaches& reaches,
                    double pixel_error, const Job& job = {});

}  // namespace lodestone::light
