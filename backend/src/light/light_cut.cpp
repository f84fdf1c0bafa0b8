// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/light_cut.h"

#include "base/parallel.h"
#include "light/light_arrival.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <queue>

namespace lodestone::light {
namespace {

// The largest difference at one point, for each of the mean.
// Taste: a larger one lets single points be more wrong.
constexpr double kMostOfMean = 3;
// The part of what a point may be off by that lamps take for which no ray is cast.
// Taste: a larger one casts fewer rays, and leaves less for lamps that are hidden here and there.
constexpr double kUntried = 0.25;
// The most that is left out, in steps of a display, however large the error may be.
// Taste: more makes rough pictures darker, where lights that stand for several would not.
constexpr double kMostLeftOut = 1;
// The most lamps of a light that are found together.
// Taste: more spare missing lamps and light more points in vain.
constexpr uint32_t kTogether = 8;

/// The largest difference of the colors, in what each may be off by.
double parts_of(const glm::dvec3& difference, const glm::dvec3& allowed) {
    const glm::dvec3 parts = glm::abs(difference) / glm::max(allowed, glm::dvec3(1e-300));
    return std::max({parts.x, parts.y, parts.z});
}

bool within(const glm::dvec3& light, const glm::dvec3& allowed) {
    return light.x <= allowed.x && light.y <= allowed.y && light.z <= allowed.z;
}

/// The lamps that are found together with a lamp: those of the largest light of few that has it.
std::vector<std::span<const uint32_t>> lamp_families(const LightTree& tree) {
    std::vector<std::span<const uint32_t>> out(tree.nodes.size());
    for (uint32_t node = 0; node < tree.nodes.size(); ++node) {  // parents come after children
        if (tree.nodes[node].count > kTogether)
            continue;
        for (const uint32_t lamp : tree.lamps(node))
            out[lamp] = tree.lamps(node);
    }
    return out;
}

class LitRegion {
public:
    LitRegion(const LightTree& tree, std::span<const LitPoint> points,
              std::vector<uint32_t> members, const Reaches& reaches, const LightShares& shares,
              std::span<const std::span<const uint32_t>> families, double pixel_error)
        : tree_(tree),
          points_(points),
          members_(std::move(members)),
          reaches_(reaches),
          shares_(shares),
          families_(families),
          pixel_error_(pixel_error) {}

    std::vector<uint32_t> cut() {
        find_lamps();
        chosen_.assign(tree_.nodes.size(), 0);
        difference_.assign(members_.size(), glm::dvec3(0.0));
        left_out_.assign(members_.size(), glm::dvec3(0.0));
        for (const uint32_t root : tree_.roots) {
            if (is_lamp(tree_.nodes[root].light))
                leave_out(root);
        }
        while (!good() && !open_.empty())
            refine();
        thin_out();
        std::vector<uint32_t> out;
        for (uint32_t node = 0; node < chosen_.size(); ++node) {
            if (chosen_[node] != 0)
                out.push_back(node);
        }
        return out;
    }

private:
    /// A lamp that may light the region: the light it sends by each point.
    struct LampColumn {
        std::vector<glm::vec3> sent;
        /// The light that it might send, if it shone wherever it reaches a point beside.
        std::vector<glm::vec3> possible;
    };
    struct OpenLight {
        double score = 0;
        uint32_t node = 0;
        bool drawn = false;  // false: it is left out
        // NOLINTNEXTLINE(modernize-use-nullptr)
        auto operator<=>(const OpenLight&) const = default;
    };

    /// Finds the lamps that may light the region, with their light, and what each point may be off
    /// by in the light of all of them.
    void find_lamps() {
        std::vector<uint32_t> seen = members_;
        for (const uint32_t point : members_)
            seen.insert(seen.end(), points_[point].beside.begin(), points_[point].beside.end());
        std::sort(seen.begin(), seen.end());
        seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
        const size_t lamps = shares_.empty() ? 0 : shares_[0].size();
        reaching_.assign(tree_.nodes.size(), 0);
        for (const uint32_t point : seen) {
            for (size_t i = 0; i < lamps; ++i)
                reaching_[i] = shares_[point][i] > 0 ? uint8_t{1} : reaching_[i];
        }
        // Lamps that see each other light nearly the same points: where one of them is found, the
        // few points may just have missed the others.
        column_.assign(tree_.nodes.size(), kNoLight);
        for (uint32_t i = 0; i < lamps; ++i) {
            const std::span<const uint32_t> family = families_[i];
            if (std::none_of(family.begin(), family.end(),
                             [&](uint32_t lamp) { return reaching_[lamp] == 1; }))
                continue;
            column_[i] = static_cast<uint32_t>(columns_.size());
            columns_.push_back(column_of(i, seen));
        }
        for (size_t i = 0; i < tree_.nodes.size(); ++i) {
            const LightNode& node = tree_.nodes[i];
            reaching_[i] = node.leaf() ? column_[i] != kNoLight
                                       : reaching_[node.left] != 0 || reaching_[node.right] != 0;
        }
        // The share to which sums of the light of lamps are exact, also where all of it is hidden.
        // Law: double precision, with a large margin.
        constexpr double kExactSum = 1e-9;
        for (size_t k = 0; k < members_.size(); ++k) {
            glm::dvec3 radiance = points_[members_[k]].other_light;
            glm::dvec3 sum(0.0);
            for (const LampColumn& column : columns_) {
                radiance += glm::dvec3(column.sent[k]);
                sum += glm::dvec3(column.possible[k]);
            }
            const glm::dvec3 exact(kExactSum * (sum.x + sum.y + sum.z));
            const LightTolerance tolerance(radiance);
            const auto allowed = [&](double error) {
                return glm::max((1 - kUntried) * tolerance.at(error), exact);
            };
            allowed_.push_back(allowed(pixel_error_));
            most_allowed_.push_back(allowed(kMostOfMean * pixel_error_));
            allowed_left_out_.push_back(allowed(std::min(pixel_error_, kMostLeftOut)));
        }
    }

    /// `seen`: the members and all points beside them, rising.
    LampColumn column_of(uint32_t lamp, const std::vector<uint32_t>& seen) const {
        const Light& light = tree_.nodes[lamp].light;
        LampColumn out;
        out.sent.resize(members_.size());
        out.possible.resize(members_.size());
        std::vector<float> most(seen.size(), 0.0f);  // the share that reaches any of its family
        for (size_t i = 0; i < seen.size(); ++i) {
            for (const uint32_t other : families_[lamp])
                most[i] = std::max(most[i], shares_[seen[i]][other]);
        }
        const auto row_of = [&](uint32_t point) {
            return static_cast<size_t>(std::lower_bound(seen.begin(), seen.end(), point) -
                                       seen.begin());
        };
        for (size_t k = 0; k < members_.size(); ++k) {
            const LitPoint& point = points_[members_[k]];
            float share = most[row_of(members_[k])];
            uint32_t brightest = members_[k];
            for (const uint32_t other : point.beside) {
                const float there = most[row_of(other)];
                if (there > share) {
                    share = there;
                    brightest = other;
                }
            }
            if (!(share > 0))
                continue;
            const glm::vec3 whole(sent_radiance(light, point));
            out.sent[k] = shares_[members_[k]][lamp] * whole;
            // The thing may turn to the lamp between a point that does not face it and one beside.
            const bool faces = whole.x + whole.y + whole.z > 0;
            out.possible[k] =
                share * (faces ? whole : glm::vec3(sent_radiance(light, points_[brightest])));
        }
        return out;
    }

    /// The light that is missed at each point, at most, without the lamps of a node.
    std::vector<glm::dvec3> missed(uint32_t node) const {
        std::vector<glm::dvec3> out(members_.size(), glm::dvec3(0.0));
        for (const uint32_t lamp : tree_.lamps(node)) {
            if (column_[lamp] == kNoLight)
                continue;
            const LampColumn& column = columns_[column_[lamp]];
            for (size_t k = 0; k < out.size(); ++k)
                out[k] += glm::dvec3(column.possible[k]);
        }
        return out;
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
            const glm::dvec3 all = sent_radiance(node.light, point);
            if (all.x + all.y + all.z > 0)
                out[k] = reaches_(node.light, point, blocker) * all;
        }
        for (const uint32_t one : tree_.lamps(index)) {
            if (column_[one] == kNoLight)
                continue;
            const LampColumn& column = columns_[column_[one]];
            for (size_t k = 0; k < members_.size(); ++k)
                out[k] -= glm::dvec3(column.sent[k]);
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

    bool opened(uint32_t node) const {
        return !tree_.nodes[node].leaf() && near(tree_.nodes[node]);
    }

    void leave_out(uint32_t node) {
        if (reaching_[node] == 0)
            return;
        if (opened(node)) {
            leave_out(tree_.nodes[node].left);
            leave_out(tree_.nodes[node].right);
            return;
        }
        const std::vector<glm::dvec3> without = missed(node);
        for (size_t k = 0; k < without.size(); ++k)
            left_out_[k] += without[k];
        open_.push({score_of(without, allowed_left_out_), node, false});
    }

    void draw(uint32_t node) {
        if (reaching_[node] == 0)
            return;
        if (opened(node)) {
            draw(tree_.nodes[node].left);
            draw(tree_.nodes[node].right);
            return;
        }
        chosen_[node] = 1;
        if (tree_.nodes[node].leaf())
            return;
        const std::vector<glm::dvec3> differs = of(node);
        for (size_t k = 0; k < differs.size(); ++k)
            difference_[k] += differs[k];
        open_.push({score_of(differs, allowed_), node, true});
    }

    /// Lights what is left out, or opens what stands for several, where it differs most.
    void refine() {
        const OpenLight worst = open_.top();
        open_.pop();
        if (!worst.drawn) {
            take_from(left_out_, missed(worst.node));
            draw(worst.node);
            return;
        }
        take_from(difference_, of(worst.node));
        chosen_[worst.node] = 0;
        draw(tree_.nodes[worst.node].left);
        draw(tree_.nodes[worst.node].right);
    }

    /// Leaves out lamps that were lit while more was left out than in the end.
    void thin_out() {
        std::vector<std::pair<double, uint32_t>> weak;
        for (uint32_t node = 0; node < chosen_.size(); ++node) {
            if (chosen_[node] == 0 || !tree_.nodes[node].leaf())
                continue;
            double most = 0;
            const LampColumn& column = columns_[column_[node]];
            for (size_t k = 0; k < members_.size() && most <= 1; ++k)
                most = std::max(most, parts_of(column.possible[k], allowed_left_out_[k]));
            if (most <= 1)
                weak.emplace_back(most, node);
        }
        std::sort(weak.begin(), weak.end());
        for (const auto& [most, node] : weak) {
            const std::vector<glm::dvec3> without = missed(node);
            std::vector<glm::dvec3> before = left_out_;
            for (size_t k = 0; k < without.size(); ++k)
                left_out_[k] += without[k];
            if (good())
                chosen_[node] = 0;
            else
                left_out_ = std::move(before);
        }
    }

    static void take_from(std::vector<glm::dvec3>& sum, const std::vector<glm::dvec3>& part) {
        for (size_t k = 0; k < sum.size(); ++k)
            sum[k] -= part[k];
    }

    static double score_of(const std::vector<glm::dvec3>& differs,
                           const std::vector<glm::dvec3>& allowed) {
        double score = 0;
        for (size_t k = 0; k < differs.size(); ++k) {
            const double parts = parts_of(differs[k], allowed[k]);
            score += parts * parts;
        }
        return score;
    }

    bool good() const {
        // Sums of what was added and taken away are exact to this part of what is allowed.
        // Law: double precision, with a large margin.
        constexpr double kExact = 1e-6;
        double square = 0;
        for (size_t k = 0; k < difference_.size(); ++k) {
            const glm::dvec3 differs = difference_[k] - left_out_[k];
            if (parts_of(left_out_[k], allowed_left_out_[k]) > 1 + kExact ||
                parts_of(differs, most_allowed_[k]) > 1 + kExact)
                return false;
            const double parts = parts_of(differs, allowed_[k]);
            square += parts * parts;
        }
        return square <= static_cast<double>(difference_.size()) * (1 + kExact);
    }

    const LightTree& tree_;
    std::span<const LitPoint> points_;
    std::vector<uint32_t> members_;
    const Reaches& reaches_;
    const LightShares& shares_;
    std::span<const std::span<const uint32_t>> families_;  // by lamp
    double pixel_error_;
    std::vector<uint8_t> reaching_;  // by node
    std::vector<uint8_t> chosen_;    // by node
    std::vector<uint32_t> column_;   // by lamp: its column
    std::vector<LampColumn> columns_;
    std::vector<glm::dvec3> allowed_;           // what points may be off by in the mean
    std::vector<glm::dvec3> most_allowed_;      // what each point may be off by
    std::vector<glm::dvec3> allowed_left_out_;  // what each point may miss
    std::vector<glm::dvec3> difference_;        // the drawn light minus that of the lamps it is of
    std::vector<glm::dvec3> left_out_;          // what is missed
    std::priority_queue<OpenLight> open_;
};

/// Finds the shares of the lamps at one point. `blockers`: what hid each lamp from a point beside.
class PointShares {
public:
    PointShares(const LightTree& tree, std::span<const uint32_t> lamps, const Reaches& reaches,
                double pixel_error)
        : tree_(tree),
          lamps_(lamps),
          reaches_(reaches),
          pixel_error_(std::min(pixel_error, kMostLeftOut)) {}

    void find(const LitPoint& point, std::vector<uint32_t>& blockers, std::vector<float>& shares) {
        waiting_.clear();
        glm::dvec3 rest(0.0);
        for (const uint32_t lamp : lamps_) {
            const glm::dvec3 all = sent_radiance(tree_.nodes[lamp].light, point);
            const double strength = all.x + all.y + all.z;
            if (!(strength > 0))
                continue;
            rest += all;
            waiting_.push_back({strength, lamp, all});
        }
        const auto weaker = [](const WaitingLamp& a, const WaitingLamp& b) {
            return a.strength != b.strength ? a.strength < b.strength : a.lamp > b.lamp;
        };
        std::make_heap(waiting_.begin(), waiting_.end(), weaker);
        glm::dvec3 known = point.other_light;
        // Brighter points may be off by more: nothing is left out before this much of the rest is.
        const glm::dvec3 most_left = kUntried * light_tolerance(known + rest, pixel_error_);
        while (!waiting_.empty() &&
               !(within(rest, most_left) &&
                 within(rest, kUntried * light_tolerance(known, pixel_error_)))) {
            std::pop_heap(waiting_.begin(), waiting_.end(), weaker);
            const WaitingLamp next = waiting_.back();
            waiting_.pop_back();
            const double share = reaches_(tree_.nodes[next.lamp].light, point, blockers[next.lamp]);
            shares[next.lamp] = static_cast<float>(share);
            known += share * next.sent;
            rest = glm::max(rest - next.sent, glm::dvec3(0.0));
        }
    }

private:
    struct WaitingLamp {
        double strength = 0;
        uint32_t lamp = 0;
        glm::dvec3 sent{0.0};
    };
    const LightTree& tree_;
    std::span<const uint32_t> lamps_;
    const Reaches& reaches_;
    double pixel_error_;
    std::vector<WaitingLamp> waiting_;
};

}  // namespace

bool may_matter(std::span<const Light* const> lamps, const LitPoint& point, double pixel_error) {
    const glm::dvec3 allowed =
        kUntried * light_tolerance(point.other_light, std::min(pixel_error, kMostLeftOut));
    glm::dvec3 sum(0.0);
    for (const Light* lamp : lamps) {
        sum += sent_radiance(*lamp, point);
        if (!within(sum, allowed))
            return true;
    }
    return false;
}

LightShares find_shares(const LightTree& tree, std::span<const LitPoint> points,
                        const Reaches& reaches, double pixel_error, const Job& job) {
    size_t lamps = 0;
    while (lamps < tree.nodes.size() && tree.nodes[lamps].leaf())
        ++lamps;
    std::vector<uint32_t> lit_by;
    for (uint32_t k = 0; k < lamps; ++k) {
        if (is_lamp(tree.nodes[k].light))
            lit_by.push_back(k);
    }
    LightShares shares(points.size());
    parallel_for((points.size() + kPointStrip - 1) / kPointStrip, [&](size_t strip) {
        std::vector<uint32_t> blockers(lamps, kNoBlocker);
        PointShares finder(tree, lit_by, reaches, pixel_error);
        const size_t end = std::min(points.size(), (strip + 1) * kPointStrip);
        for (size_t i = strip * kPointStrip; i < end; ++i) {
            job.check();
            shares[i].assign(lamps, 0);
            finder.find(points[i], blockers, shares[i]);
        }
    });
    return shares;
}

LightCut cut_lights(const LightTree& tree, std::span<const LitPoint> points,
                    const LightShares& shares, size_t regions, const Reaches& reaches,
                    double pixel_error, const Job& job) {
    std::vector<std::vector<uint32_t>> members(regions);
    for (size_t i = 0; i < points.size(); ++i)
        members.at(points[i].region).push_back(static_cast<uint32_t>(i));
    const std::vector<std::span<const uint32_t>> families = lamp_families(tree);
    LightCut out(regions);
    parallel_for(regions, [&](size_t i) {
        job.check();
        if (!members[i].empty())
            out[i] = LitRegion(tree, points, std::move(members[i]), reaches, shares, families,
                               pixel_error)
                         .cut();
    });
    return out;
}

}  // namespace lodestone::light
