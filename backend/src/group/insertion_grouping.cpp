// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/insertion_grouping.h"

#include "base/hash.h"
#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <tuple>

namespace lodestone::group {
namespace {

/// Groups that are looked into for one insertion.
/// Taste: a larger value finds cheaper places, for time in proportion.
constexpr uint32_t kExpansions = 16;
/// Groups that lie one inside the other, at most.
/// Taste: a larger value lets chains of groups grow; POV-Ray and hosts recurse over them.
constexpr uint32_t kDeepest = 40;
/// The share of the whole's area that every box has at least.
/// Taste: any small value will do, so that a child more is never free.
constexpr double kLeastArea = 1e-12;
/// More items than these are put elsewhere once only.
/// Taste: a larger value finds cheaper groups of many things, in more time.
constexpr size_t kMany = 4096;
/// A place must cost less than the best by this factor.
/// Law: a difference that is rounding alone is none; double precision adds up to 1e-9 over many
/// items.
constexpr double kAsCheap = 1 - 1e-9;
/// The share of the cost that a pass must gain, for another one.
/// Taste: a larger value ends sooner at slightly dearer groups.
constexpr double kWorthAPass = 1e-3;

/// The sums over a group's items on which its cost depends.
struct GroupSums {
    Box3 box;
    double weight = 0;
    double squares = 0;  // squares of the features' lengths
    Features features{};

    void add(const GroupSums& other) {
        box.add(other.box);
        weight += other.weight;
        squares += other.squares;
        for (size_t i = 0; i < kFeatures; ++i)
            features[i] += other.features[i];
    }

    /// The variance of the features.
    double spread() const {
        double of_mean = 0;
        for (const double sum : features)
            of_mean += sum * sum;
        return std::max(0.0, (squares - of_mean / weight) / weight);
    }
};

GroupSums sums_of(const GroupingItem& item) {
    GroupSums sums;
    sums.box = item.box;
    sums.weight = item.weight;
    for (size_t i = 0; i < kFeatures; ++i) {
        sums.features[i] = item.weight * item.features[i];
        sums.squares += item.weight * item.features[i] * item.features[i];
    }
    return sums;
}

/// A place where something could go: with `child` into a new group in its place, or into `child`.
struct InsertionPlace {
    double cost = std::numeric_limits<double>::infinity();
    uint32_t node = kNoNode;
    bool pair = false;
};

struct InsertionStep {
    double least;  // the least cost of anything below
    uint32_t node;
    uint32_t depth;
};

class ItemInserter {
public:
    ItemInserter(std::span<const GroupSums> items, const StructureOptions& options, const Job& job)
        : options_(options), job_(job) {
        tree_.item_count = items.size();
        tree_.nodes.resize(items.size() + 1);
        sums_.assign(items.begin(), items.end());
        sums_.emplace_back();
        heights_.assign(items.size() + 1, 0);
        costs_.assign(items.size() + 1, 0.0);
        tree_.root = static_cast<uint32_t>(items.size());
    }

    GroupingTree run(const std::vector<uint32_t>& order) {
        for (const uint32_t item : order)
            insert(item);
        double before = total();
        const uint32_t passes =
            order.size() > kMany ? std::min(1u, options_.passes) : options_.passes;
        for (uint32_t pass = 0; pass < passes; ++pass) {
            for (const uint32_t item : order)
                again(item);
            const auto end = static_cast<uint32_t>(tree_.nodes.size());
            for (auto node = static_cast<uint32_t>(tree_.item_count); node < end; ++node)
                again(node);
            const double now = total();
            if (now > before * (1 - kWorthAPass))
                break;
            before = now;
        }
        unwrap_root();
        return std::move(tree_);
    }

private:
    using GroupingNode = GroupingTree::GroupingNode;

    double cost_of(const GroupSums& sums, size_t children) const {
        const double area = half_area(sums.box) + kLeastArea;
        return area * (static_cast<double>(children) + options_.group_cost) *
               (1 + options_.similarity * sums.spread());
    }

    double total() const { return std::accumulate(costs_.begin(), costs_.end(), 0.0); }

    void insert(uint32_t node) {
        if ((++inserted_ & 255u) == 0)
            job_.check();
        const InsertionPlace place = best_for(node);
        if (place.pair)
            pair(place.node, node);
        else
            attach(place.node, node);
    }

    /// Takes a node with all below it out and inserts it where that is best now.
    void again(uint32_t node) {
        const uint32_t parent = tree_.nodes[node].parent;
        if (parent == kNoNode)  // the root, or dissolved meanwhile
            return;
        if (parent == tree_.root && tree_.nodes[parent].children.size() == 1)
            return;
        detach(node);
        insert(node);
    }

    InsertionPlace best_for(uint32_t inserted) {
        const GroupSums& added = sums_[inserted];
        const uint32_t height = heights_[inserted];
        InsertionPlace best;
        InsertionPlace forced;  // a place with room, for when all groups are full or too deep
        steps_.clear();
        const GroupingNode& root = tree_.nodes[tree_.root];
        if (root.children.empty())
            return {0, tree_.root, false};
        // The least that going somewhere adds: a child of a group no smaller than the thing is
        // itself.
        const double last = cost_of(added, 1) - cost_of(added, 0);
        const double paired = cost_of(added, 2);  // where nothing else is possible
        steps_.push_back({grown(tree_.root, added) - costs_[tree_.root], tree_.root, 0});
        const auto later = [](const InsertionStep& a, const InsertionStep& b) {
            return std::tie(a.least, a.node) > std::tie(b.least, b.node);
        };
        for (uint32_t count = 0; count < kExpansions && !steps_.empty(); ++count) {
            std::pop_heap(steps_.begin(), steps_.end(), later);
            const InsertionStep step = steps_.back();
            steps_.pop_back();
            if (step.least + last >= best.cost * kAsCheap)
                break;
            const GroupingNode& node = tree_.nodes[step.node];
            GroupSums with = sums_[step.node];
            with.add(added);
            const double one_more = step.least + cost_of(with, 1) - cost_of(with, 0);
            if (node.children.size() < options_.most)
                take(best, {one_more, step.node, false});
            else
                take(forced, {one_more, step.node, false});
            const bool deep = step.depth + height + 1 >= kDeepest;
            if (deep)
                continue;
            for (const uint32_t child : node.children) {
                GroupSums both = sums_[child];
                both.add(added);
                const bool room = step.depth + heights_[child] + 2 < kDeepest;
                if (room)
                    take(best, {step.least + cost_of(both, 2), child, true});
                if (tree_.is_item(child))
                    continue;
                const size_t children = tree_.nodes[child].children.size();
                const double more = cost_of(both, children) - costs_[child];
                const bool full = children >= options_.most && heights_[child] == 1;
                if (step.least + more + (full ? paired : last) < best.cost * kAsCheap) {
                    steps_.push_back({step.least + more, child, step.depth + 1});
                    std::push_heap(steps_.begin(), steps_.end(), later);
                }
            }
        }
        return best.node != kNoNode ? best : forced;
    }

    /// Lets a root that holds one group alone take over the children of that group.
    void unwrap_root() {
        std::vector<uint32_t>& top = tree_.nodes[tree_.root].children;
        while (top.size() == 1 && !tree_.is_item(top.front())) {
            std::vector<uint32_t> inner = std::move(tree_.nodes[top.front()].children);
            tree_.nodes[top.front()] = {};
            for (const uint32_t child : inner)
                tree_.nodes[child].parent = tree_.root;
            top = std::move(inner);
        }
    }

    static void take(InsertionPlace& best, const InsertionPlace& place) {
        if (place.cost < best.cost)
            best = place;
    }

    /// The cost of a group with more in it, but no more children.
    double grown(uint32_t node, const GroupSums& added) const {
        GroupSums with = sums_[node];
        with.add(added);
        return cost_of(with, tree_.nodes[node].children.size());
    }

    void attach(uint32_t group, uint32_t node) {
        tree_.nodes[group].children.push_back(node);
        tree_.nodes[node].parent = group;
        refresh(group);
    }

    void pair(uint32_t child, uint32_t node) {
        const uint32_t parent = tree_.nodes[child].parent;
        const uint32_t made = new_group();
        std::vector<uint32_t>& siblings = tree_.nodes[parent].children;
        *std::find(siblings.begin(), siblings.end(), child) = made;
        tree_.nodes[made].parent = parent;
        tree_.nodes[made].children = {child, node};
        tree_.nodes[child].parent = tree_.nodes[node].parent = made;
        refresh(made);
    }

    void detach(uint32_t node) {
        uint32_t parent = tree_.nodes[node].parent;
        std::vector<uint32_t>& siblings = tree_.nodes[parent].children;
        siblings.erase(std::find(siblings.begin(), siblings.end(), node));
        tree_.nodes[node].parent = kNoNode;
        if (siblings.size() == 1 && parent != tree_.root) {  // a group of one is none
            const uint32_t left = siblings.front();
            const uint32_t above = tree_.nodes[parent].parent;
            std::vector<uint32_t>& around = tree_.nodes[above].children;
            *std::find(around.begin(), around.end(), parent) = left;
            tree_.nodes[left].parent = above;
            siblings.clear();
            tree_.nodes[parent].parent = kNoNode;
            costs_[parent] = 0;
            free_.push_back(parent);
            parent = above;
        }
        refresh(parent);
    }

    uint32_t new_group() {
        if (!free_.empty()) {
            const uint32_t node = free_.back();
            free_.pop_back();
            return node;
        }
        tree_.nodes.emplace_back();
        sums_.emplace_back();
        heights_.push_back(0);
        costs_.push_back(0);
        return static_cast<uint32_t>(tree_.nodes.size() - 1);
    }

    /// Brings a group and those around it up to date.
    void refresh(uint32_t group) {
        for (; group != kNoNode; group = tree_.nodes[group].parent) {
            GroupSums sums;
            uint32_t height = 0;
            for (const uint32_t child : tree_.nodes[group].children) {
                sums.add(sums_[child]);
                height = std::max(height, heights_[child] + 1);
            }
            sums_[group] = sums;
            heights_[group] = height;
            costs_[group] = tree_.nodes[group].children.empty()
                                ? 0
                                : cost_of(sums, tree_.nodes[group].children.size());
        }
    }

    const StructureOptions& options_;
    const Job& job_;
    GroupingTree tree_;
    std::vector<GroupSums> sums_;
    std::vector<uint32_t> heights_;
    std::vector<double> costs_;
    std::vector<uint32_t> free_;
    std::vector<InsertionStep> steps_;
    uint32_t inserted_ = 0;
};

/// The sums of items moved into the unit cube: areas neither overflow nor vanish, and scale and
/// origin do not matter.
std::vector<GroupSums> normalized(std::span<const GroupingItem> items) {
    Box3 whole;
    for (const GroupingItem& item : items)
        whole.add(item.box);
    const glm::dvec3 half = 0.5 * whole.high - 0.5 * whole.low;
    const double extent = 2 * std::max({half.x, half.y, half.z});
    std::vector<GroupSums> out;
    out.reserve(items.size());
    for (const GroupingItem& item : items) {
        GroupSums sums = sums_of(item);
        if (extent > 0 && std::isfinite(extent))
            sums.box = {(item.box.low - whole.low) / extent, (item.box.high - whole.low) / extent};
        else
            sums.box = {glm::dvec3(0.0), glm::dvec3(0.0)};
        out.push_back(sums);
    }
    return out;
}

/// A number for each item that does not depend on the items' order, as far as they differ.
std::vector<uint32_t> ranks_of(std::span<const GroupSums> items) {
    std::vector<uint32_t> order(items.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](uint32_t i) {
        const Box3& box = items[i].box;
        return std::tie(box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z,
                        items[i].weight, items[i].features);
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    std::vector<uint32_t> ranks(items.size());
    for (uint32_t at = 0; at < order.size(); ++at)
        ranks[order[at]] = at;
    return ranks;
}

std::vector<uint32_t> random_order(const std::vector<uint32_t>& ranks, uint64_t seed) {
    std::vector<std::pair<Hash, uint32_t>> keyed;
    keyed.reserve(ranks.size());
    for (uint32_t i = 0; i < ranks.size(); ++i)
        keyed.emplace_back(Hasher().value(seed).value(ranks[i]).result(), i);
    std::sort(keyed.begin(), keyed.end());
    std::vector<uint32_t> order;
    order.reserve(keyed.size());
    for (const auto& [hash, item] : keyed)
        order.push_back(item);
    return order;
}

}  // namespace

GroupingTree group_by_insertion(std::span<const GroupingItem> items,
                                const StructureOptions& options, const Job& job) {
    if (items.size() <= 2)
        return flat_tree(items.size());
    const std::vector<GroupSums> sums = normalized(items);
    const std::vector<uint32_t> ranks = ranks_of(sums);
    const uint32_t orders = std::max(1u, options.orders);
    std::vector<GroupingTree> trees(orders);
    std::vector<double> costs(orders);
    parallel_for(orders, [&](size_t i) {
        const uint64_t seed = Hasher().value(options.seed).value(i).result();
        trees[i] = ItemInserter(sums, options, job).run(random_order(ranks, seed));
        costs[i] = expected_cost(trees[i], items);
    });
    const auto best = std::min_element(costs.begin(), costs.end());  // the first of the lowest
    return std::move(trees[static_cast<size_t>(best - costs.begin())]);
}

}  // namespace lodestone::group
