// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/light_cut.h"

#include "base/parallel.h"
#include "light/light_arrival.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <queue>

namespace lodestone::light {
namespace {

// The largest difference at one point, for each of the mean.
// Taste: a larger one lets single points be more wrong.
constexpr double kMostOfMean = 3;
// The most lamps of a light that are found together.
// Taste: more spare missing lamps and light more points in vain.
constexpr uint32_t kTogether = 8;
// The points in a row that one thread asks for; the same things mostly hide a lamp from them.
// Taste: longer rows try the last blocker more often and share the work less evenly.
constexpr size_t kStrip = 128;

/// The radiance that a point sends to the eye from an unhidden light.
glm::dvec3 sent(const Light& light, const LitPoint& point) {
    const glm::dvec3 arrives = arriving_radiance(light, point.position, point.normal);
    if (!(arrives.x + arrives.y + arrives.z > 0))
        return glm::dvec3(0.0);
    glm::dvec3 albedo = point.albedo;
    if (point.gloss > 0) {
        const glm::dvec3 half = glm::normalize(light.position - point.position) + point.to_eye;
        const double length = glm::length(half);
        const double cosine = length > 0 ? glm::dot(half, point.normal) / length : 0;
        if (cosine > 0)
            albedo += point.gloss * (point.exponent + 8) / 8 * std::pow(cosine, point.exponent);
    }
    return albedo * arrives;
}

class LitRegion {
public:
    LitRegion(const LightTree& tree, std::span<const LitPoint> points,
              std::vector<uint32_t> members, const glm::dvec3& ambient, const Reaches& reaches,
              const LightShares& shares)
        : tree_(tree),
          points_(points),
          members_(std::move(members)),
          ambient_(ambient),
          reaches_(reaches),
          shares_(shares) {}

    std::vector<uint32_t> cut(double pixel_error) {
        find_reaching();
        const size_t count = members_.size();
        difference_.assign(count, glm::dvec3(0.0));
        step_.assign(count, glm::dvec3(1.0));
        sum_lamps();
        for (const uint32_t root : tree_.roots) {
            if (is_lamp(tree_.nodes[root].light))
                take(root);
        }
        while (!good(pixel_error) && !closed_.empty()) {
            const uint32_t worst = closed_.top().second;
            closed_.pop();
            std::vector<glm::dvec3> old = of(worst);
            for (size_t i = 0; i < count; ++i)
                difference_[i] -= old[i];
            chosen_[worst] = 0;
            take(tree_.nodes[worst].left);
            take(tree_.nodes[worst].right);
        }
        std::vector<uint32_t> out;
        for (uint32_t node = 0; node < chosen_.size(); ++node) {
            if (chosen_[node] != 0)
                out.push_back(node);
        }
        return out;
    }

private:
    /// Finds the nodes below which a lamp reaches a point, or one beside it.
    void find_reaching() {
        const size_t lamps = shares_.empty() ? 0 : shares_[0].size();
        reaching_.assign(tree_.nodes.size(), 0);
        chosen_.assign(tree_.nodes.size(), 0);
        const auto note = [&](uint32_t point) {
            for (size_t i = 0; i < lamps; ++i) {
                if (shares_[point][i] > 0)
                    reaching_[i] = 1;
            }
        };
        std::vector<uint32_t> seen = members_;
        for (const uint32_t point : members_)
            seen.insert(seen.end(), points_[point].beside.begin(), points_[point].beside.end());
        std::sort(seen.begin(), seen.end());
        seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
        for (const uint32_t point : seen)
            note(point);
        for (size_t i = 0; i < tree_.nodes.size(); ++i) {
            const LightNode& node = tree_.nodes[i];
            if (!node.leaf() && (reaching_[node.left] != 0 || reaching_[node.right] != 0))
                reaching_[i] = 1;
        }
        // Lamps that see each other light nearly the same points: where one of them is found, the
        // few points may just have missed the others.
        for (size_t i = tree_.nodes.size(); i-- > 0;) {
            const LightNode& node = tree_.nodes[i];
            if (!node.leaf() && reaching_[i] != 0 && node.count <= kTogether)
                reaching_[node.left] = reaching_[node.right] = 1;
        }
    }

    /// Sums up the light of each lamp by each point, and finds the step of each point in all their
    /// light.
    void sum_lamps() {
        const size_t count = members_.size();
        column_.assign(tree_.nodes.size(), kNoLight);
        uint32_t columns = 0;
        for (uint32_t i = 0; i < tree_.nodes.size(); ++i) {
            if (tree_.nodes[i].leaf() && reaching_[i] != 0)
                column_[i] = columns++;
        }
        sent_.assign(columns, {});
        for (uint32_t i = 0; i < column_.size(); ++i) {
            if (column_[i] == kNoLight)
                continue;
            std::vector<glm::vec3>& here = sent_[column_[i]];
            here.resize(count);
            for (size_t k = 0; k < count; ++k) {
                const double share = static_cast<double>(shares_[members_[k]][i]);
                if (share > 0)
                    here[k] = glm::vec3(share * sent(tree_.nodes[i].light, points_[members_[k]]));
            }
        }
        for (size_t k = 0; k < count; ++k) {
            glm::dvec3 radiance = points_[members_[k]].albedo * ambient_;
            for (const std::vector<glm::vec3>& here : sent_)
                radiance += glm::dvec3(here[k]);
            for (int i = 0; i < 3; ++i)
                step_[k][i] = display_step(radiance[i]);
        }
    }

    /// The difference between a light and the lamps it stands for, at each point.
    std::vector<glm::dvec3> of(uint32_t index) const {
        const LightNode& node = tree_.nodes[index];
        std::vector<glm::dvec3> out(members_.size(), glm::dvec3(0.0));
        if (node.leaf())
            return out;
        uint32_t blocker = kNoBlocker;
        for (size_t k = 0; k < members_.size(); ++k) {
            const LitPoint& point = points_[members_[k]];
            const glm::dvec3 all = sent(node.light, point);
            if (all.x + all.y + all.z > 0)
                out[k] = reaches_(node.light, point, blocker) * all;
        }
        for (const uint32_t one : tree_.lamps(index)) {
            if (column_[one] == kNoLight)
                continue;
            const std::vector<glm::vec3>& here = sent_[column_[one]];
            for (size_t k = 0; k < members_.size(); ++k)
                out[k] -= glm::dvec3(here[k]);
        }
        return out;
    }

    /// Whether a point is nearer to a light's lamps than these are to each other.
    bool near(const LightNode& node) const {
        const glm::dvec3 size = node.box.size();
        const double extent = glm::dot(size, size);
        return std::any_of(members_.begin(), members_.end(), [&](uint32_t point) {
            const glm::dvec3& at = points_[point].position;
            const glm::dvec3 way = at - glm::clamp(at, node.box.low, node.box.high);
            return glm::dot(way, way) < extent;
        });
    }

    void take(uint32_t node) {
        if (reaching_[node] == 0)
            return;
        if (!tree_.nodes[node].leaf() && near(tree_.nodes[node])) {
            take(tree_.nodes[node].left);
            take(tree_.nodes[node].right);
            return;
        }
        chosen_[node] = 1;
        if (tree_.nodes[node].leaf())
            return;
        const std::vector<glm::dvec3> differs = of(node);
        double score = 0;
        for (size_t k = 0; k < differs.size(); ++k) {
            difference_[k] += differs[k];
            const double steps = steps_of(differs[k], k);
            score += steps * steps;
        }
        closed_.push({score, node});
    }

    double steps_of(const glm::dvec3& difference, size_t point) const {
        const glm::dvec3 steps = glm::abs(difference) / step_[point];
        return std::max({steps.x, steps.y, steps.z});
    }

    bool good(double pixel_error) const {
        double square = 0;
        double most = 0;
        for (size_t k = 0; k < difference_.size(); ++k) {
            const double steps = steps_of(difference_[k], k);
            square += steps * steps;
            most = std::max(most, steps);
        }
        const double mean = std::sqrt(square / static_cast<double>(difference_.size()));
        return mean <= pixel_error && most <= kMostOfMean * pixel_error;
    }

    const LightTree& tree_;
    std::span<const LitPoint> points_;
    std::vector<uint32_t> members_;
    glm::dvec3 ambient_;
    const Reaches& reaches_;
    const LightShares& shares_;
    std::vector<uint8_t> reaching_;             // by node
    std::vector<uint8_t> chosen_;               // by node
    std::vector<uint32_t> column_;              // by lamp: its column in sent_
    std::vector<std::vector<glm::vec3>> sent_;  // by column, by point
    std::vector<glm::dvec3> step_;
    std::vector<glm::dvec3> difference_;  // the drawn light minus that of all lamps
    std::priority_queue<std::pair<double, uint32_t>> closed_;
};

}  // namespace

LightShares find_shares(const LightTree& tree, std::span<const LitPoint> points,
                        const Reaches& reaches, const Job& job) {
    size_t lamps = 0;
    while (lamps < tree.nodes.size() && tree.nodes[lamps].leaf())
        ++lamps;
    std::vector<uint32_t> lit_by;
    for (uint32_t k = 0; k < lamps; ++k) {
        if (is_lamp(tree.nodes[k].light))
            lit_by.push_back(k);
    }
    LightShares shares(points.size());
    parallel_for((points.size() + kStrip - 1) / kStrip, [&](size_t strip) {
        std::vector<uint32_t> blockers(lamps, kNoBlocker);
        const size_t end = std::min(points.size(), (strip + 1) * kStrip);
        for (size_t i = strip * kStrip; i < end; ++i) {
            job.check();
            shares[i].assign(lamps, 0);
            for (const uint32_t k : lit_by) {
                const Light& light = tree.nodes[k].light;
                const glm::dvec3 all =
                    arriving_radiance(light, points[i].position, points[i].normal);
                if (all.x + all.y + all.z > 0)
                    shares[i][k] = static_cast<float>(reaches(light, points[i], blockers[k]));
            }
        }
    });
    return shares;
}

LightCut cut_lights(const LightTree& tree, std::span<const LitPoint> points,
                    const LightShares& shares, size_t regions, const glm::dvec3& ambient,
                    const Reaches& reaches, double pixel_error, const Job& job) {
    std::vector<std::vector<uint32_t>> members(regions);
    for (size_t i = 0; i < points.size(); ++i)
        members.at(points[i].region).push_back(static_cast<uint32_t>(i));
    LightCut out(regions);
    parallel_for(regions, [&](size_t i) {
        job.check();
        if (!members[i].empty())
            out[i] = LitRegion(tree, points, std::move(members[i]), ambient, reaches, shares)
                         .cut(pixel_error);
    });
    return out;
}

}  // namespace lodestone::light
