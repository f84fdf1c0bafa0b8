// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/follow/node_edits.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace lodestone::choose {
namespace {

/// Whether each node is replaced by one node, so that nothing moves.
bool in_place(const std::vector<NodeEdit>& edits) {
    return std::all_of(edits.begin(), edits.end(), [](const NodeEdit& edit) {
        return edit.removed == 1 && edit.end - edit.begin == 1;
    });
}

template <typename Value>
void grow(std::vector<Value>& values, size_t most) {
    if (values.capacity() < most)
        values.reserve(most + most / 4);
}

}  // namespace

void NodeSplicer::reserve(const std::vector<NodeEdit>& edits, const FreshNodes& fresh, Cut& cut,
                          KeptNodes& kept) {
    const size_t most = cut.nodes.size() + fresh.nodes.size();
    spare_chosen_.clear();
    grow(kept.free, kept.free.size() + cut.nodes.size());
    if (in_place(edits)) {
        spare_chosen_.reserve(edits.size());
        return;
    }
    grow(cut.nodes, most);
    grow(cut.transforms, cut.transforms.size() + fresh.nodes.size());
    grow(kept.seen, kept.seen.size() + fresh.nodes.size());
    grow(kept.ranges, kept.ranges.size() + fresh.nodes.size());
    kept.slack.grow(most);
    spare_chosen_.reserve(most);
    runs_.reserve(edits.size() + 1);
}

void NodeSplicer::replace(const std::vector<NodeEdit>& edits, const FreshNodes& fresh, Cut& cut,
                          KeptNodes& kept) {
    spare_chosen_.clear();
    for (const NodeEdit& edit : edits) {
        for (uint32_t i = edit.at; i < edit.at + edit.removed; ++i)
            kept.free.push_back(cut.nodes[i].transform);
    }
    if (!in_place(edits)) {
        move_all(edits, fresh, cut, kept);
        return;
    }
    for (const NodeEdit& edit : edits)
        insert(edit, edit.at, fresh.nodes[edit.begin].parent, fresh, cut, kept);
}

/// Moves the nodes that stay, within the cut, and puts the fresh nodes between them.
void NodeSplicer::move_all(const std::vector<NodeEdit>& edits, const FreshNodes& fresh, Cut& cut,
                           KeptNodes& kept) {
    runs_.assign(1, {});
    for (const NodeEdit& edit : edits) {
        NodeRun& before = runs_.back();
        before.end = edit.at;
        const uint32_t shift = before.shift + (edit.end - edit.begin) - edit.removed;
        runs_.push_back({edit.at + edit.removed, 0, shift});
    }
    const auto count = static_cast<uint32_t>(cut.nodes.size());
    runs_.back().end = count;
    const uint32_t wanted = count + runs_.back().shift;
    const uint32_t room = std::max(count, wanted);
    cut.nodes.resize(room);
    kept.slack.resize(room);
    const auto moved = [&](uint32_t index) {
        if (index == kNoParent)
            return index;
        const auto after =
            std::upper_bound(runs_.begin(), runs_.end(), index,
                             [](uint32_t value, const NodeRun& run) { return value < run.begin; });
        return index + (after - 1)->shift;
    };
    const auto move = [&](const NodeRun& run) {
        static_assert(std::is_trivially_copyable_v<CutNode>);
        if (run.shift != 0) {
            CutNode* nodes = cut.nodes.data();
            std::memmove(nodes + (run.begin + run.shift), nodes + run.begin,
                         (run.end - run.begin) * sizeof(CutNode));
            kept.slack.move(run.begin, run.end, run.begin + run.shift);
        }
        uint32_t before = kNoParent;  // siblings in a run have a parent before it, or in it
        uint32_t now = kNoParent;
        for (uint32_t i = run.begin + run.shift; run.begin > 0 && i < run.end + run.shift; ++i) {
            uint32_t& parent = cut.nodes[i].parent;
            if (parent >= run.begin) {
                parent += run.shift;
                continue;
            }
            if (parent != before) {
                before = parent;
                now = moved(parent);
            }
            parent = now;
        }
    };
    // A run that moves down overwrites only runs that have moved down before it or are gone. Then,
    // from the end, a run that moves up overwrites only runs that have moved.
    const auto down = [](const NodeRun& run) { return static_cast<int32_t>(run.shift) < 0; };
    for (size_t i = 0; i < runs_.size(); ++i) {
        if (down(runs_[i]))
            move(runs_[i]);
    }
    for (size_t i = runs_.size(); i-- > 0;) {
        if (!down(runs_[i]))
            move(runs_[i]);
    }
    cut.nodes.resize(wanted);
    kept.slack.resize(wanted);
    spare_chosen_.clear();
    auto chosen = cut.chosen.begin();
    // The position, among the chosen that are left of `nodes` nodes, of the first that is not
    // before `node`.
    const auto chosen_from = [&](uint32_t node, uint32_t nodes) {
        const auto rest = static_cast<uint32_t>(cut.chosen.end() - chosen);
        return std::lower_bound(chosen, chosen + std::min(nodes, rest), node);
    };
    for (size_t k = 0; k < runs_.size(); ++k) {
        const NodeRun& run = runs_[k];
        if (k > 0)
            chosen = chosen_from(run.begin, edits[k - 1].removed);
        const auto end = chosen_from(run.end, run.end - run.begin);
        size_t to = spare_chosen_.size();
        spare_chosen_.resize(to + static_cast<size_t>(end - chosen));
        for (; chosen != end; ++chosen)
            spare_chosen_[to++] = *chosen + run.shift;
        if (k < edits.size())
            insert(edits[k], run.end + run.shift, moved(fresh.nodes[edits[k].begin].parent), fresh,
                   cut, kept);
    }
    cut.chosen.swap(spare_chosen_);
}

/// Puts the fresh nodes of an edit at a place that is free. `parent`: the parent of the first of
/// them.
void NodeSplicer::insert(const NodeEdit& edit, uint32_t place, uint32_t parent,
                         const FreshNodes& fresh, Cut& cut, KeptNodes& kept) {
    for (uint32_t from = edit.begin; from < edit.end; ++from) {
        const uint32_t to = place + (from - edit.begin);
        CutNode& node = cut.nodes[to] = fresh.nodes[from];
        node.parent = from == edit.begin ? parent : node.parent - edit.begin + place;
        if (kept.free.empty()) {
            node.transform = static_cast<uint32_t>(cut.transforms.size());
            cut.transforms.emplace_back();
            kept.seen.emplace_back();
            kept.ranges.emplace_back();
        } else {
            node.transform = kept.free.back();
            kept.free.pop_back();
        }
        cut.transforms[node.transform] = fresh.transforms[from];
        kept.seen[node.transform] = fresh.seen[from];
        kept.ranges[node.transform] = fresh.ranges[from];
        kept.slack.copy(fresh.slack, from, to);
        if (!node.opened)
            spare_chosen_.push_back(to);
    }
}

}  // namespace lodestone::choose
