// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/light_tree.h"

#include "base/color.h"
#include "light/light_arrival.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace lodestone::light {
namespace {

// The least cosine between directions of lamps that shine alike.
// Taste: 15 degrees; a wider angle joins more lamps, which then stand for each other less well.
constexpr double kAlike = 0.9659;
// How much cones that shine alike may differ, in parts of their size.
// Taste: a larger number joins more lamps, which then stand for each other less well.
constexpr double kSameCone = 0.05;
// The neighbors along the curve, on each side, that may be joined.
// Taste: more find nearer pairs, more slowly.
constexpr size_t kWindow = 10;

bool alike(const Light& a, const Light& b) {
    if (a.kind != b.kind || a.shadow != b.shadow)
        return false;
    if (a.kind == LightKind::Point)
        return true;
    if (glm::dot(glm::normalize(a.direction), glm::normalize(b.direction)) < kAlike)
        return false;
    if (a.kind == LightKind::Spot)
        return std::abs(a.spot_size - b.spot_size) <= kSameCone * a.spot_size &&
               std::abs(a.spot_blend - b.spot_blend) <= kSameCone;
    return a.round == b.round && std::abs(a.spread - b.spread) <= kSameCone;
}

/// Spreads the bits of a coordinate to every third bit.
uint64_t spread_bits(uint64_t x) {
    x &= 0x1fffff;
    x = (x | x << 32u) & 0x1f00000000ffffu;
    x = (x | x << 16u) & 0x1f0000ff0000ffu;
    x = (x | x << 8u) & 0x100f00f00f00f00fu;
    x = (x | x << 4u) & 0x10c30c30c30c30c3u;
    return (x | x << 2u) & 0x1249249249249249u;
}

uint64_t morton_order(const Box3& box, const glm::dvec3& point) {
    uint64_t code = 0;
    for (int i = 0; i < 3; ++i) {
        const double size = box.high[i] - box.low[i];
        const double share = size > 0 ? (point[i] - box.low[i]) / size : 0;
        const auto cell = static_cast<uint64_t>(std::clamp(share, 0.0, 1.0) * 0x1fffff);
        code |= spread_bits(cell) << static_cast<unsigned>(i);
    }
    return code;
}

/// The second moment of the area's shining surface: along two axes, in metres squared.
glm::dvec2 moments(const Light& area, const glm::dvec3& u, const glm::dvec3& v,
                   const glm::dvec3& center) {
    const double uniform = area.round ? 16 : 12;
    const auto along = [&](const glm::dvec3& axis) {
        const double off = glm::dot(area.position - center, axis);
        const double a = glm::dot(area.edge_u, axis);
        const double b = glm::dot(area.edge_v, axis);
        return off * off + (a * a + b * b) / uniform;
    };
    return {along(u), along(v)};
}

class LightJoiner {
public:
    LightJoiner(std::span<const Light> lights, const Clear& clear, const Job& job)
        : clear_(clear), job_(job) {
        for (const Light& light : lights) {
            LightNode node;
            node.light = light;
            if (is_lamp(light))
                node.box.add(light.position);
            tree_.nodes.push_back(std::move(node));
        }
    }

    LightTree run() {
        Box3 all;
        std::vector<uint32_t> open;
        for (uint32_t i = 0; i < tree_.nodes.size(); ++i) {
            if (is_lamp(tree_.nodes[i].light)) {
                all.add(tree_.nodes[i].box);
                open.push_back(i);
            } else {
                tree_.roots.push_back(i);
            }
        }
        std::vector<uint64_t> codes(tree_.nodes.size(), 0);
        for (const uint32_t i : open)
            codes[i] = morton_order(all, tree_.nodes[i].light.position);
        std::stable_sort(open.begin(), open.end(),
                         [&](uint32_t a, uint32_t b) { return codes[a] < codes[b]; });
        while (round(open)) {
        }
        tree_.roots.insert(tree_.roots.end(), open.begin(), open.end());
        std::sort(tree_.roots.begin(), tree_.roots.end());
        list_lamps();
        return std::move(tree_);
    }

private:
    /// Joins every two that like each other best; false when nothing is left to join.
    bool round(std::vector<uint32_t>& open) {
        job_.check();
        const size_t count = open.size();
        constexpr size_t kNoPartner = std::numeric_limits<size_t>::max();
        std::vector<size_t> best(count, kNoPartner);
        for (size_t i = 0; i < count; ++i) {
            double least = std::numeric_limits<double>::infinity();
            size_t tie = kNoPartner;
            const size_t from = i > kWindow ? i - kWindow : 0;
            for (size_t k = from; k < std::min(count, i + kWindow + 1); ++k) {
                if (k == i || !alike(light(open[i]), light(open[k])) || parted(open[i], open[k]))
                    continue;
                // Among equally good ones the neighbor in pairs is taken: otherwise all would want
                // the first.
                const size_t order = k == (i ^ 1u) ? 0 : (k > i ? k - i : i - k) * 2 + (k > i);
                const double cost = cost_of(open[i], open[k]);
                if (cost < least || (cost == least && order < tie)) {
                    least = cost;
                    tie = order;
                    best[i] = k;
                }
            }
        }
        bool any = false;
        for (size_t i = 0; i < count; ++i) {
            const size_t k = best[i];
            if (k == kNoPartner || k < i || best[k] != i)
                continue;
            any = true;
            const uint32_t node = join(open[i], open[k]);
            if (node == kNoLight)
                continue;
            open[i] = node;
            open[k] = kNoLight;
        }
        open.erase(std::remove(open.begin(), open.end(), kNoLight), open.end());
        return any;
    }

    const Light& light(uint32_t node) const { return tree_.nodes[node].light; }

    double cost_of(uint32_t a, uint32_t b) const {
        Box3 box = tree_.nodes[a].box;
        box.add(tree_.nodes[b].box);
        const glm::dvec3 size = box.size();
        const double energy = luminance(energy_of(light(a))) + luminance(energy_of(light(b)));
        return energy * glm::dot(size, size);
    }

    static uint64_t pair_of(uint32_t a, uint32_t b) {
        return uint64_t{std::min(a, b)} << 32u | std::max(a, b);
    }
    bool parted(uint32_t a, uint32_t b) const {
        return !parted_.empty() && parted_.count(pair_of(a, b)) != 0;
    }

    /// At most `most` of the lamps below a node, evenly spread.
    std::vector<uint32_t> some(uint32_t node, size_t most) const {
        std::vector<uint32_t> found;
        std::vector<uint32_t> stack{node};
        while (!stack.empty()) {
            const uint32_t at = stack.back();
            stack.pop_back();
            if (tree_.nodes[at].leaf()) {
                found.push_back(at);
                continue;
            }
            stack.push_back(tree_.nodes[at].right);
            stack.push_back(tree_.nodes[at].left);
        }
        if (found.size() <= most)
            return found;
        std::vector<uint32_t> out;
        for (size_t i = 0; i < most; ++i)
            out.push_back(found[i * found.size() / most]);
        return out;
    }

    bool clear(const Light& stand_in, uint32_t a, uint32_t b) const {
        // The lamps of each side that are tried with each other.
        // Taste: more find more walls between them, more slowly.
        constexpr size_t kEach = 4;
        // The lamps of each side that are tried with the centroid.
        // Taste: more find more walls between them, more slowly.
        constexpr size_t kCentered = 8;
        for (const uint32_t node : {a, b}) {
            if (!clear_(stand_in.position, light(node).position))
                return false;
            for (const uint32_t one : some(node, kCentered)) {
                if (one != node && !clear_(stand_in.position, light(one).position))
                    return false;
            }
        }
        const std::vector<uint32_t> others = some(b, kEach);
        for (const uint32_t one : some(a, kEach)) {
            for (const uint32_t other : others) {
                if (!clear_(light(one).position, light(other).position))
                    return false;
            }
        }
        return true;
    }

    /// The new node, or none where something separates them; then they are never joined.
    uint32_t join(uint32_t a, uint32_t b) {
        LightNode node;
        node.light = joined_light(light(a), light(b));
        if (!is_lamp(node.light) || !clear(node.light, a, b)) {
            parted_.insert(pair_of(a, b));
            return kNoLight;
        }
        node.left = a;
        node.right = b;
        node.count = tree_.nodes[a].count + tree_.nodes[b].count;
        node.box = tree_.nodes[a].box;
        node.box.add(tree_.nodes[b].box);
        tree_.nodes.push_back(std::move(node));
        return static_cast<uint32_t>(tree_.nodes.size() - 1);
    }

    void list_lamps() {
        uint32_t next = 0;
        for (const uint32_t root : tree_.roots) {
            tree_.nodes[root].first = next;
            next += tree_.nodes[root].count;
        }
        tree_.order.resize(next);
        for (size_t i = tree_.nodes.size(); i-- > 0;) {  // parents come before children
            const LightNode& node = tree_.nodes[i];
            if (node.leaf()) {
                tree_.order[node.first] = static_cast<uint32_t>(i);
                continue;
            }
            tree_.nodes[node.left].first = node.first;
            tree_.nodes[node.right].first = node.first + tree_.nodes[node.left].count;
        }
    }

    const Clear& clear_;
    const Job& job_;
    LightTree tree_;
    std::set<uint64_t> parted_;
};

}  // namespace

Light joined_light(const Light& a, const Light& b) {
    const double of_a = luminance(energy_of(a));
    const double of_b = luminance(energy_of(b));
    const double share = of_a + of_b > 0 ? of_b / (of_a + of_b) : 0.5;
    const auto between = [share](const auto& x, const auto& y) { return x + (y - x) * share; };
    Light out = share > 0.5 ? b : a;
    out.color = energy_of(a) + energy_of(b);
    out.power = 1;
    out.position = between(a.position, b.position);
    out.radius = std::sqrt(between(a.radius * a.radius, b.radius * b.radius));
    if (a.kind == LightKind::Point)
        return out;
    out.direction =
        glm::normalize(between(glm::normalize(a.direction), glm::normalize(b.direction)));
    if (a.kind == LightKind::Spot) {
        out.spot_size = between(a.spot_size, b.spot_size);
        out.spot_blend = between(a.spot_blend, b.spot_blend);
        return out;
    }
    out.spread = between(a.spread, b.spread);
    const glm::dvec3 u = glm::normalize(out.edge_u);
    const glm::dvec3 v = glm::normalize(glm::cross(out.direction, u));
    const glm::dvec2 both = between(moments(a, u, v, out.position), moments(b, u, v, out.position));
    const double uniform = out.round ? 16 : 12;
    out.edge_u = u * std::sqrt(uniform * both.x);
    out.edge_v = v * std::sqrt(uniform * both.y);
    return out;
}

LightTree make_light_tree(std::span<const Light> lights, const Clear& clear, const Job& job) {
    return LightJoiner(lights, clear, job).run();
}

}  // namespace lodestone::light
