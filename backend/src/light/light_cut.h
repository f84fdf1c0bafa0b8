// SPDX-License-Identifier: GPL-3.0-or-later
// Light cut: which lights, and which that stand for several, each part of a picture is lit by.
#pragma once

#include "light/light_tree.h"

namespace lodestone::light {

/// A point of a surface that a view shows.
struct LitPoint {
    glm::dvec3 position{0.0};
    glm::dvec3 aside{0.0};       // to where its rays begin
    glm::dvec3 normal{0, 0, 1};  // unit, toward whoever looks
    glm::dvec3 to_eye{0, 0, 1};  // unit
    glm::dvec3 albedo{0.8};
    double gloss = 0;              // albedo of its highlight,
    double exponent = 1;           // of the cosine of its half vector
    uint32_t region = 0;           // points of one region are lit by the same lights
    std::vector<uint32_t> beside;  // points next to it: lamps that reach these count as reaching it
};

/// Share (0...1) of a light, 0 for one that is hidden, that reaches a point. `blocker`: the
/// callee's own number of what hid it from a point beside, kept by the caller; it changes no
/// answer. Any thread.
using Reaches = std::function<double(const Light&, const LitPoint&, uint32_t& blocker)>;
inline constexpr uint32_t kNoBlocker = ~uint32_t{0};

/// By point, by lamp: the share that reaches it; 0 for what is behind it.
using LightShares = std::vector<std::vector<float>>;

/// Asks for every lamp of the tree at every point.
LightShares find_shares(const LightTree& tree, std::span<const LitPoint> points,
                        const Reaches& reaches, const Job& job = {});

/// By region: nodes of the tree, rising.
using LightCut = std::vector<std::vector<uint32_t>>;

/// For every region the lights that light its points as all lamps of the tree do: the root mean
/// square of the differences is at most `pixel_error` steps of an 8-bit display, and none is more
/// than 3 times that. `ambient`: radiance that lights everything besides.
/// Left out is what reaches none of a region's points, nor any of up to 8 lamps joined with it;
/// what does is never dropped, but stood for by the fewest lights that a greedy opening finds.
/// First what is nearer to a point than its lamps are to each other is opened, then always the
/// light with the largest difference: a finer `pixel_error` never gives a region fewer. Roots that
/// are no lamps are not in it. The same on any number of threads. cost: a ray for every point and
/// light that is tried.
LightCut cut_lights(const LightTree& tree, std::span<const LitPoint> points,
                    const LightShares& shares, size_t regions, const glm::dvec3& ambient,
                    const Reaches& reaches, double pixel_error, const Job& job = {});

}  // namespace lodestone::light
