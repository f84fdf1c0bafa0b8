// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/choice_table.h"

#include "base/maths.h"

#include <algorithm>
#include <limits>

namespace lodestone::choose {
namespace {

// How many groups deep the costs below a group are looked at for openings; deeper groups count as
// closed.
// Taste: a larger depth finds more openings and makes tables slower.
constexpr int kDeepestOpening = 3;
// The most levels of an object.
// Law: level_count is a bit field of 28 bits.
constexpr uint32_t kMostLevels = (uint32_t{1} << 28u) - 1;

}  // namespace

ChoiceTable ChoiceTable::whole(const Model& model, ObjectIndex root, KindMask kinds) {
    ChoiceTable table(model, kinds);
    table.rows_.reserve(model.objects.size());
    table.objects_.reserve(model.objects.size());
    table.by_object_.reserve(model.objects.size());
    std::vector<uint32_t> stack{table.row_of(root)};
    std::vector<uint8_t> done;
    while (!stack.empty()) {
        const uint32_t row = stack.back();
        stack.pop_back();
        done.resize(std::max<size_t>(done.size(), row + size_t{1}), 0);
        if (done[row] != 0)
            continue;
        done[row] = 1;
        table.expand(row);
        const TableObject& group = table.objects_[row];
        for (uint32_t i = group.child_count; i-- > 0;)
            stack.push_back(table.children_[group.first_child + i].row);
    }
    table.link();
    return table;
}

uint32_t ChoiceTable::row_of(ObjectIndex object) {
    const auto known = by_object_.find(object);
    if (known != by_object_.end())
        return known->second;
    const uint32_t row = add(object);
    set_openings(row);
    return row;
}

uint32_t ChoiceTable::add(ObjectIndex index) {
    const auto row = static_cast<uint32_t>(rows_.size());
    by_object_.emplace(index, row);
    const Object& object = model_.objects.at(index);
    TableRow made;
    TableObject rest;
    rest.object = index;
    rest.demand = object.demand;
    rest.expanded = !object.group();
    rest.all_levels = static_cast<uint32_t>(object.representations.size());
    made.group = object.group();
    made.drawable = !object.representations.empty();
    if (made.drawable) {
        const Bound& bound = object.bound();
        made.box = bound.box;
        made.radius = bound.radius;
        made.centered = bound.center == bound.box.center();
        rest.center = bound.center;
    }
    made.first_level = static_cast<uint32_t>(levels_.size());
    for (uint32_t lod = 0; lod < rest.all_levels; ++lod) {
        const RepresentationSummary& summary = object.representations[lod].summary;
        if ((kinds_ & kDrawnKinds & mask_of(summary.kind)) == 0)
            continue;
        TableLevel level;
        level.error = summary.error;
        level.opens_from = kInfinity;
        level.bytes = summary.cost.bytes;
        level.triangles = summary.cost.triangles;
        level.lod = lod;
        level.distinct =
            distinct_.emplace(summary.hash, static_cast<uint32_t>(distinct_.size())).first->second;
        level.kind = summary.kind;
        level.sealed = summary.sealed;
        levels_.push_back(level);
    }
    made.level_count = (static_cast<uint32_t>(levels_.size()) - made.first_level) & kMostLevels;
    rows_.push_back(made);
    objects_.push_back(rest);
    assemblies_.emplace_back();
    return row;
}

void ChoiceTable::expand(uint32_t row) {
    if (objects_[row].expanded)
        return;
    objects_[row].expanded = true;
    const Representation& group = model_.objects[objects_[row].object].representations[0];
    const std::vector<Placement>& placements = group.assembly().placements;
    assemblies_[row] = std::get<std::shared_ptr<const Assembly>>(group.payload);
    const auto first_row = static_cast<uint32_t>(rows_.size());
    objects_[row].first_child = static_cast<uint32_t>(children_.size());
    objects_[row].child_count = static_cast<uint32_t>(placements.size());
    for (const Placement& placement : placements) {
        TableChild child;
        child.offset = placement.transform.offset;
        if (placement.transform.linear != glm::dmat3(1.0)) {
            child.linear = static_cast<uint32_t>(linears_.size());
            linears_.push_back(placement.transform.linear);
            stretches_.push_back(stretch(placement.transform));
        }
        child.object = placement.object;
        const auto known = by_object_.find(placement.object);
        child.row = known != by_object_.end() ? known->second : add(placement.object);
        const double demand = objects_[child.row].demand;
        if (placement.has_overrides() || placement.hidden != 0 || demand != 1) {
            child.overrides = static_cast<uint32_t>(overrides_.size());
            overrides_.push_back({placement.importance, demand, placement.coarsest,
                                  placement.finest, placement.hidden});
        }
        const TableRow& placed = rows_[child.row];
        child.finest_error = kInfinity;
        for (uint32_t i = 0; i < placed.level_count; ++i)
            child.finest_error =
                std::min(child.finest_error, levels_[placed.first_level + i].error);
        children_.push_back(child);
    }
    // Siblings lie beside each other before anything below them is made.
    const auto last_row = static_cast<uint32_t>(rows_.size());
    for (uint32_t made = first_row; made < last_row; ++made)
        set_openings(made);
}

/// Tells all placements where the children of their objects are, and rows whether they last.
void ChoiceTable::link() {
    for (TableChild& child : children_) {
        child.first_child = objects_[child.row].first_child;
        child.child_count = objects_[child.row].child_count;
        if (child.child_count == 0)
            continue;
        child.first_row = children_[child.first_child].row;
        child.first_level = rows_[child.first_row].first_level;
    }
    for (TableRow& row : rows_)
        row.lasting = row.drawable && !row.group && row.level_count > 0;
    for (auto row = static_cast<uint32_t>(rows_.size());
         row-- > 0;) {  // most groups come before the groups around them
        const TableObject& object = objects_[row];
        bool lasting = rows_[row].lasting;
        for (uint32_t i = 0; !lasting && i < object.child_count; ++i) {
            const TableChild& child = children_[object.first_child + i];
            const PlacementOverrides& overrides = overrides_[child.overrides];
            lasting = rows_[child.row].lasting && overrides.hidden == 0 &&
                      overrides.coarsest == kAnyLevel;
        }
        rows_[row].lasting = lasting && rows_[row].drawable;
    }
}

double ChoiceTable::own_cost(const TableLevel& level) const {
    return static_cast<double>(level.bytes + model_.costs.occurrence_bytes);
}

double ChoiceTable::stretch_of(const TableChild& child) const {
    return child.linear == kUnturned ? 1 : stretches_[child.linear];
}

/// Finds, for each stand-in of a group that costs more than its children could, from which error on
/// it does.
void ChoiceTable::set_openings(uint32_t row) {
    const TableRow group = rows_[row];
    if (objects_[row].openings)
        return;
    objects_[row].openings = true;
    if (!group.group)
        return;
    const std::vector<Placement>& placements =
        model_.objects[objects_[row].object].representations[0].assembly().placements;
    const CostModel& costs = model_.costs;
    // The least cost of anything that is drawn: a primitive, placed once.
    const uint64_t least = costs.primitive_bytes + costs.occurrence_bytes;
    std::vector<double> steps;  // the errors at which a child changes its level
    for (uint32_t i = group.level_count; i-- > 0;) {
        const TableLevel level = levels_[group.first_level + i];
        if (level.sealed || level.bytes + costs.occurrence_bytes <= least * placements.size())
            continue;
        if (steps.empty()) {
            expand(row);
            for (uint32_t child = 0; child < objects_[row].child_count; ++child) {
                const TableChild placed = children_[objects_[row].first_child + child];
                const double enlarge = stretch_of(placed);
                set_openings(placed.row);
                const TableRow& below = rows_[placed.row];
                for (uint32_t j = 0; j < below.level_count; ++j) {
                    const TableLevel& changes = levels_[below.first_level + j];
                    steps.push_back(changes.error * enlarge);
                    if (changes.opens_from < kInfinity)
                        steps.push_back(changes.opens_from * enlarge);
                }
            }
            std::sort(steps.begin(), steps.end());
            steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
        }
        const double most =
            i + 1 < group.level_count ? levels_[group.first_level + i + 1].error : kInfinity;
        std::vector<double> within{level.error};
        within.insert(within.end(), std::upper_bound(steps.begin(), steps.end(), level.error),
                      std::lower_bound(steps.begin(), steps.end(), most));
        const auto pays = [&](double error) {
            const double below = cost_below(row, error, kDeepestOpening);
            return below > 0 && below < own_cost(level);
        };
        if (!pays(within.back()))
            continue;
        size_t fails = 0;  // the children cost less, the more error is allowed
        size_t works = within.size() - 1;
        if (pays(within[0]))
            works = 0;
        while (works > fails + 1) {
            const size_t middle = (fails + works) / 2;
            (pays(within[middle]) ? works : fails) = middle;
        }
        levels_[group.first_level + i].opens_from = within[works];
    }
}

/// The most that the levels of an object cost where this error is allowed.
double ChoiceTable::cost_at(uint32_t row, double error, int depth) {
    set_openings(row);
    const TableRow here = rows_[row];
    uint32_t pick = here.level_count;
    while (pick-- > 0) {
        if (levels_[here.first_level + pick].error <= error)
            break;
    }
    if (pick == ~uint32_t{0}) {  // none
        if (here.group)
            return depth > 0 ? cost_below(row, error, depth - 1) : kInfinity;
        return here.level_count > 0 ? own_cost(levels_[here.first_level]) : 0;
    }
    const TableLevel level = levels_[here.first_level + pick];
    if (depth > 0 && level.opens_from <= error)
        return std::min(own_cost(level), cost_below(row, error, depth - 1));
    return own_cost(level);
}

double ChoiceTable::cost_below(uint32_t row, double error, int depth) {
    expand(row);
    double cost = 0;
    for (uint32_t i = 0; i < objects_[row].child_count; ++i) {
        const TableChild child = children_[objects_[row].first_child + i];
        const double enlarge = stretch_of(child);
        if (overrides_[child.overrides].hidden != kAllRays && rows_[child.row].drawable)
            cost += cost_at(child.row, enlarge > 0 ? error / enlarge : kInfinity, depth);
    }
    return cost;
}

}  // namespace lodestone::choose
