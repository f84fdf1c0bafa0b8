// SPDX-License-Identifier: GPL-3.0-or-later
// Light cut: the lights, some of which stand for several lamps, that light each part of a picture.
#pragma once

#include "light/light_tree.h"

namespace lodestone::light {

/// A point of a surface that a view shows.
struct LitPoint {
    glm::dvec3 position{0.0};
    glm::dvec3 aside{0.0};       // the way to where its rays begin
    glm::dvec3 normal{0, 0, 1};  // has length 1; toward the side from which it is seen
    glm::dvec3 to_eye{0, 0, 1};  // has length 1
    glm::dvec3 albedo{0.8};
    double gloss = 0;     // the albedo of its highlight
    double exponent = 1;  // that of the cosine of its highlight's half vector
    uint32_t region = 0;  // the points of one region are lit by the same lights
    /// The points next to it: lamps that reach these count as reaching it.
    std::vector<uint32_t> beside;
};

/// The share (0...1) of a light that reaches a point, 0 for a hidden light. `blocker`: the
/// function's own number of what hid the light from a point beside, kept by the caller; it does not
/// change the result. Any thread.
using Reaches = std::function<double(const Light&, const LitPoint&, uint32_t& blocker)>;
inline constexpr uint32_t kNoBlocker = ~uint32_t{0};

/// By point and lamp: the share that reaches the point; 0 for points that face away from the lamp.
using LightShares = std::vector<std::vector<float>>;

/// Finds the shares of every lamp of the tree at every point.
LightShares find_shares(const LightTree& tree, std::span<const LitPoint> points,
                        const Reaches& reaches, const Job& job = {});

/// By region: nodes of the tree, rising.
using LightCut = std::vector<std::vector<uint32_t>>;

/// For every region the lights that light its points as all lamps of the tree do: the root mean
/// square of the differences is at most `pixel_error` steps of an 8-bit display, and none is more
/// than 3 times that. `ambient`: the radiance that lights everything besides. A lamp is left out if
/// it reaches none of a region's points, nor does any of up to 8 lamps joined with it. A lamp that
/// does is never left out; the fewest lights that a greedy opening finds stand for all such lamps.
/// First it opens lights that are nearer to a point than their lamps are to each other, then always
/// the light with the largest difference: a finer `pixel_error` never gives a region fewer lights.
/// Roots that are no lamps are not in it. Any number of threads gives the same result. cost: a ray
/// for every point and light that is tried.
LightCut cut_lights(const LightTree& tree, std::span<const LitPoint> points,
                    const LightShares& shares, size_t regions, const glm::dvec3& ambient,
                    const Reaches& reaches, double pixel_error, const Job& job = {});

}  // namespace lodestone::light
