// SPDX-License-Identifier: GPL-3.0-or-later
// Light tree: lamps joined two by two into single lights that stand for them (5.4.1).
#pragma once

#include "base/job.h"
#include "model/view.h"

#include <functional>
#include <span>
#include <vector>

namespace lodestone::light {

inline constexpr uint32_t kNoLight = ~uint32_t{0};

struct LightNode {
    Light light;  // a lamp as it is, or a light that stands for all lamps below
    uint32_t left = kNoLight;
    uint32_t right = kNoLight;
    /// The first of its lamps, which are LightTree::order[first, first + count).
    uint32_t first = 0;
    uint32_t count = 1;
    Box3 box;  // the box of their positions

    bool leaf() const { return left == kNoLight; }
};

/// The tree of all lamps. Node i is lamp i for the first nodes; children come before parents. A
/// root is a light that is joined no further: it is unlike the others, or separated from them.
struct LightTree {
    std::vector<LightNode> nodes;
    std::vector<uint32_t> roots;  // rising
    std::vector<uint32_t> order;

    std::span<const uint32_t> lamps(uint32_t node) const {
        return {order.data() + nodes[node].first, nodes[node].count};
    }
};

/// Whether nothing lies between two points. Asked from one thread.
using Clear = std::function<bool(const glm::dvec3&, const glm::dvec3&)>;

/// One light with the energy of both (exactly: color times power add up): at their centroid by
/// energy, and for areas as large as their second moments together.
Light joined_light(const Light& a, const Light& b);

/// Joins the nearest lights first (by energy times the square of the extent), only lamps of one
/// kind that shine alike (spots and areas: within 15 degrees), and only where nothing lies between
/// them nor between them and their centroid (all pairs of few lamps; of many, 16 pairs and 16 to
/// the centroid). Suns, and lamps that are not finite, do not shine or take light away, are roots
/// of their own. Deterministic. cost: 0.1 s for 10,000 lamps, besides the time of `clear`.
LightTree make_light_tree(std::span<const Light> lights, const Clear& clear, const Job& job = {});

}  // namespace lodestone::light
