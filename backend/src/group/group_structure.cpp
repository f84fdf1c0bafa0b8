// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/group_structure.h"

#include "group/object_traits.h"
#include "group/position_groups.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace lodestone::group {
namespace {

bool finite(const Box3& box) {
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(box.low[i]) || !std::isfinite(box.high[i]))
            return false;
    }
    return !box.empty();
}

const Assembly& assembly_of(const Model& model, ObjectIndex group) {
    return model.objects[group].representations[0].assembly();
}

Hash hash_of_place(const Affine& transform) {
    double rows[12];
    transform.to_rows(rows);
    Hasher hasher;
    for (const double value : rows)
        hasher.value(value + 0.0);
    return hasher.result();
}

/// The hash of a group's members, in any order.
Hash members_of(std::vector<Hash>& members) {
    std::sort(members.begin(), members.end());
    return Hasher().array(std::span<const Hash>(members)).result();
}

/// A maker of objects for a tree's groups.
class GroupMaker {
public:
    GroupMaker(Model& model, ObjectIndex group)
        : model_(model), group_(group), placements_(assembly_of(model, group).placements) {
        for (const Object& object : model.objects)
            uids_.insert(object.uid);
    }

    const std::vector<Placement>& placements() const { return placements_; }
    size_t made() const { return count_; }

    struct GroupChild {
        uint32_t first;  // place in the group's assembly of the first thing in it
        Hash members;
        Placement placement;
    };

    /// The children that a tree's node gets; `places` are the items' places in the group's
    /// assembly.
    std::vector<GroupChild> children_of(const GroupingTree& tree, uint32_t node,
                                        const std::vector<uint32_t>& places) {
        std::vector<GroupChild> out;
        for (const uint32_t child : tree.nodes[node].children) {
            if (tree.is_item(child))
                out.push_back(item(places[child]));
            else
                out.push_back(group(children_of(tree, child, places)));
        }
        std::sort(out.begin(), out.end(),
                  [](const GroupChild& a, const GroupChild& b) { return a.first < b.first; });
        return out;
    }

    GroupChild item(uint32_t place) const {
        const Placement& placement = placements_[place];
        const Hash members = Hasher()
                                 .text(model_.objects[placement.object].uid)
                                 .value(hash_of_place(placement.transform))
                                 .result();
        return {place, members, placement};
    }

private:
    GroupChild group(std::vector<GroupChild>&& children) {
        std::vector<Hash> members;
        auto assembly = std::make_shared<Assembly>();
        for (GroupChild& child : children) {
            members.push_back(child.members);
            assembly->placements.push_back(std::move(child.placement));
        }
        const Hash all = members_of(members);
        const Object& whole = model_.objects[group_];
        Object made;
        for (uint32_t attempt = 0; made.uid.empty() || !uids_.insert(made.uid).second; ++attempt)
            made.uid = hex16(Hasher().text(whole.uid).value(all).value(attempt).result());
        made.name = text(whole.name, " ", ++count_);
        made.role = whole.role;
        Representation finest;
        finest.summary.kind = Kind::Assembly;
        finest.payload = std::shared_ptr<const Assembly>(std::move(assembly));
        made.representations.push_back(std::move(finest));
        GroupChild out{children.front().first, all, {}};
        out.placement.object = static_cast<ObjectIndex>(model_.objects.size());
        out.placement.name = made.name;
        model_.objects.push_back(std::move(made));
        return out;
    }

    Model& model_;
    ObjectIndex group_;
    std::vector<Placement> placements_;
    std::set<std::string> uids_;
    size_t count_ = 0;
};

}  // namespace

SortedChildren sorted_children(const Model& model, ObjectIndex group,
                               const std::vector<ObjectTraits>& traits) {
    SortedChildren out;
    out.classes.resize(2);
    out.items.resize(2);
    const std::vector<Placement>& placements = assembly_of(model, group).placements;
    for (uint32_t at = 0; at < placements.size(); ++at) {
        const ObjectTraits& child = traits[placements[at].object];
        const GroupingItem item = item_of(child, placements[at]);
        if (child.never || placements[at].hidden != 0 || placements[at].has_overrides() ||
            !finite(item.box)) {
            continue;
        }
        const size_t kind = child.environment ? 1 : 0;
        out.classes[kind].push_back(at);
        out.items[kind].push_back(item);
    }
    return out;
}

size_t apply_grouping(Model& model, ObjectIndex group, const SortedChildren& sorted,
                      const std::vector<GroupingTree>& trees) {
    const size_t before = model.objects.size();
    GroupMaker maker(model, group);
    std::vector<GroupMaker::GroupChild> top;
    std::vector<uint8_t> grouped(maker.placements().size(), 0);
    for (const std::vector<uint32_t>& places : sorted.classes) {
        for (const uint32_t place : places)
            grouped[place] = 1;
    }
    for (uint32_t place = 0; place < grouped.size(); ++place) {
        if (grouped[place] == 0)
            top.push_back(maker.item(place));
    }
    for (size_t i = 0; i < trees.size(); ++i) {
        if (trees[i].root == kNoNode)
            continue;
        for (GroupMaker::GroupChild& child :
             maker.children_of(trees[i], trees[i].root, sorted.classes[i]))
            top.push_back(std::move(child));
    }
    std::sort(top.begin(), top.end(),
              [](const GroupMaker::GroupChild& a, const GroupMaker::GroupChild& b) {
                  return a.first < b.first;
              });
    auto assembly = std::make_shared<Assembly>();
    for (GroupMaker::GroupChild& child : top)
        assembly->placements.push_back(std::move(child.placement));
    model.objects[group].representations[0].payload =
        std::shared_ptr<const Assembly>(std::move(assembly));
    return model.objects.size() - before;
}

StructureReport structure_groups(Model& model, std::span<const ObjectIndex> groups,
                                 const StructureOptions& options, const Job& job) {
    if (options.most < kLeastChildren)
        fail(Status::InvalidArgument, "groups of at most ", options.most, " children; ",
             kLeastChildren, " or more expected");
    std::vector<ObjectIndex> flat;
    for (const ObjectIndex group : groups) {
        if (group >= model.objects.size() || !model.objects[group].group())
            fail(Status::InvalidArgument, "only a group can be structured");
        if (assembly_of(model, group).placements.size() > options.fewest)
            flat.push_back(group);
    }
    StructureReport report;
    if (flat.empty())
        return report;
    job.stage(JobStage::Group);
    const std::vector<ObjectTraits> traits = traits_of(model, flat, job);
    std::vector<SortedChildren> sorted;
    std::vector<std::vector<GroupingTree>> trees;
    for (size_t i = 0; i < flat.size(); ++i) {
        sorted.push_back(sorted_children(model, flat[i], traits));
        trees.emplace_back();
        for (const std::vector<GroupingItem>& items : sorted.back().items) {
            trees.back().push_back(items.size() > kLeastChildren
                                       ? group_by_insertion(items, options, job)
                                       : flat_tree(items.size()));
            report.cost_before += expected_cost(flat_tree(items.size()), items);
            report.cost_after += expected_cost(trees.back().back(), items);
        }
        job.progress(static_cast<double>(i + 1) / static_cast<double>(flat.size()));
    }
    const size_t before = model.objects.size();
    for (size_t i = 0; i < flat.size(); ++i) {
        const size_t first = model.objects.size();
        apply_grouping(model, flat[i], sorted[i], trees[i]);
        report.structured += model.objects.size() > first ? 1 : 0;
        // Groups that were full when more was forced into them, and children that cannot be
        // grouped.
        for (size_t made = model.objects.size(); made-- > first;)
            group_by_position(model, static_cast<ObjectIndex>(made), options.most);
        group_by_position(model, flat[i], options.most);
    }
    report.made = model.objects.size() - before;
    return report;
}

std::vector<ObjectIndex> flat_groups(const Model& model, size_t fewest) {
    std::vector<ObjectIndex> out;
    for (const ObjectIndex index : bottom_up(model)) {
        if (model.objects[index].group() && assembly_of(model, index).placements.size() > fewest)
            out.push_back(index);
    }
    return out;
}

namespace {

/// The hash of a group's members; where the group was made below `whole`, its children replace it.
Hash dissolved(const Model& model, const Object& whole, const Placement& placement,
               std::vector<Placement>& out, size_t& count) {
    const Object& child = model.objects[placement.object];
    const Hash as_item =
        Hasher().text(child.uid).value(hash_of_place(placement.transform)).result();
    if (!child.group()) {
        out.push_back(placement);
        return as_item;
    }
    const size_t begin = out.size();
    const size_t count_before = count;
    std::vector<Hash> members;
    for (const Placement& inner : child.representations[0].assembly().placements)
        members.push_back(dissolved(model, whole, inner, out, count));
    const Hash all = members_of(members);
    if (child.uid == hex16(Hasher().text(whole.uid).value(all).value(uint32_t{0}).result())) {
        ++count;
        return all;
    }
    out.resize(begin);
    count = count_before;
    out.push_back(placement);
    return as_item;
}

}  // namespace

size_t dissolve_made_groups(Model& model, ObjectIndex group) {
    const Object& whole = model.objects.at(group);
    std::vector<Placement> out;
    size_t count = 0;
    for (const Placement& placement : assembly_of(model, group).placements)
        dissolved(model, whole, placement, out, count);
    if (count == 0)
        return 0;
    auto assembly = std::make_shared<Assembly>();
    assembly->placements = std::move(out);
    model.objects[group].representations[0].payload =
        std::shared_ptr<const Assembly>(std::move(assembly));
    return count;
}

}  // namespace lodestone::group
