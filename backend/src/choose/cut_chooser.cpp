// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/cut_chooser.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::choose {
namespace {

// How many children ahead memory is asked for.
// Taste: more displace what is still needed, fewer come too late.
constexpr uint32_t kAhead = 4;

}  // namespace

void refuse_nonsense(const View& view) {
    if (view.width <= 0 || view.height <= 0)
        fail(Status::InvalidArgument, "a picture of ", view.width, " x ", view.height, " pixels");
    if (!(view.pixel_error >= 0))
        fail(Status::InvalidArgument, "Pixel Error is ", view.pixel_error,
             "; it must be 0 or more");
    const glm::dvec3& eye = view.camera.position;
    if (!std::isfinite(eye.x) || !std::isfinite(eye.y) || !std::isfinite(eye.z))
        fail(Status::InvalidArgument, "camera '", view.camera.name, "' is nowhere");
}

std::map<std::string, uint64_t> counts_by_kind(std::span<const uint64_t, kKinds> kinds) {
    std::map<std::string, uint64_t> out;
    for (size_t kind = 0; kind < kKinds; ++kind) {
        if (kinds[kind] != 0)
            out[name_of(static_cast<Kind>(kind))] = kinds[kind];
    }
    return out;
}

bool find_sight(const View& view, FactorField& field, const PlacedNode& placed, bool group,
                const Bound& local, double demand, double enlarge, FactorField::FactorPath& path,
                OccurrenceSight& sight, DetailFactors& factors) {
    const CutNode& node = placed.node;
    sight.stretch = enlarge;
    factors.importance = node.importance;
    factors.demand = demand;
    if (!field.bends(path) && view.modifiers.criterion != DetailCriterion::Area) {
        sight.z = distance_of(local, placed.world, enlarge, view.camera.position);
        sight.pixel = field.pixel(sight.z);
        sight.total = total_refinement(node.importance * demand);
        return true;
    }
    const Bound bound = transformed(local, placed.world, enlarge);
    sight.z = distance(bound, view.camera.position);
    sight.pixel = field.pixel(sight.z);
    if (field.bends(path)) {
        const FactorField::FactorEffect effect =
            field.at(node.object, group, local, placed.world, bound, sight.z, path);
        if (effect.gone)
            return false;
        factors = effect.factors;
        factors.importance = node.importance;
        factors.demand = demand;
        sight.total = effect.open ? kInfinity : factors.total();
    } else {
        sight.total = total_refinement(node.importance * demand);
    }
    if (view.modifiers.criterion == DetailCriterion::Area)
        sight.share = field.frame().rect_of_box(bound).area() /
                      (field.frame().width() * field.frame().height());
    return true;
}

bool place_child(const ChoiceTable& table, const CutNode& group, const Affine& around,
                 const TableChild& child, PlacedNode& placed, double& enlarge, double& demand) {
    CutNode& node = placed.node;
    node.object = child.object;
    node.hidden = group.hidden;
    node.importance = group.importance;
    demand = 1;
    if (child.overrides != 0) {
        const PlacementOverrides& overrides = table.overrides(child.overrides);
        node.hidden = static_cast<RayMask>(group.hidden | overrides.hidden);
        if (node.hidden == kAllRays)
            return false;
        node.importance = group.importance * overrides.importance;
        node.coarsest = overrides.coarsest;
        node.finest = overrides.finest;
        demand = overrides.demand;
    }
    if (group.coarsest == 0) {
        node.coarsest = 0;
        node.finest = 0;
    }
    placed.world.offset = around.linear * child.offset + around.offset;
    if (child.linear == kUnturned) {
        placed.world.linear = around.linear;
    } else {
        placed.world.linear = around.linear * table.linear(child.linear);
        enlarge = stretch(placed.world);
    }
    return true;
}

/// Decides for the cheapest good level, else the finest that can be drawn, else none. From finest
/// to coarsest, errors rise strictly and costs fall.
LevelDecision decide_level(const ChoiceTable& table, const View& view, uint32_t index,
                           const CutNode& node, const OccurrenceSight& sight) {
    const TableRow& row = table.row(index);
    const size_t levels = by_error(view) ? 0 : table.object(index).all_levels;
    LevelDecision made;
    for (uint32_t i = row.level_count; i-- > 0;) {
        const TableLevel& level = table.level(row.first_level + i);
        if (level.lod > node.coarsest)
            continue;
        if (made.level != nullptr && level.lod < node.finest)
            break;
        made.level = &level;
        made.good = good_enough(view, sight, level.error, level.lod, levels);
        if (made.good)
            break;
    }
    if (made.level == nullptr) {
        made.opened = row.group;
        made.drawn = row.group;
        return made;
    }
    made.drawn = true;
    made.pinned = node.finest > 0;
    made.cheaper = made.good && !made.pinned && made.level->opens_from < kInfinity &&
                   by_error(view) &&
                   good_enough(view, sight, made.level->opens_from, made.level->lod, levels);
    made.opened = row.group && !made.pinned && (!made.good || made.cheaper);
    return made;
}

void VisitedNodes::clear() {
    nodes.clear();
    transforms.clear();
    seen.clear();
}

void VisitedNodes::reserve(size_t count) {
    nodes.reserve(count);
    transforms.reserve(count);
    seen.reserve(count);
}

bool CutChooser::run(uint32_t root, const CutBudget& budget, Cut& cut) {
    job_.check();
    const size_t expected = table_.expected();
    cut.nodes.reserve(expected);
    cut.chosen.reserve(expected);
    cut.transforms.reserve(expected);
    budget_ = &budget;
    cut_ = &cut;
    nodes_ = &cut.nodes;
    transforms_ = &cut.transforms;
    visit_root(root);
    visit_all();
    if (exceeds_budget())
        return false;
    cut.kinds = counts_by_kind(kinds_);
    table_.expect(cut.nodes.size());
    return true;
}

void CutChooser::run(uint32_t root, VisitedNodes& out) {
    job_.check();
    nodes_ = &out.nodes;
    transforms_ = &out.transforms;
    seen_ = &out.seen;
    visit_root(root);
    visit_all();
}

void CutChooser::open(const PlacedNode& group, const SeenNode& known,
                      const FactorField::FactorPath& path, VisitedNodes& out) {
    nodes_ = &out.nodes;
    transforms_ = &out.transforms;
    seen_ = &out.seen;
    PlacedNode opened = group;
    opened.node.opened = true;
    opened.node.lod = 0;
    opened.node.kind = Kind::Assembly;
    const uint32_t index = append(opened, known);
    push_children(this->known(known.row), index, known.stretch, path, 0);
    visit_all();
}

CutChooser::KnownObject CutChooser::known(uint32_t row) const {
    const TableObject& object = table_.object(row);
    KnownObject out{row, object.demand, 0, object.first_child, object.child_count, 0, 0};
    if (object.child_count > 0) {
        out.first_row = table_.child(object.first_child).row;
        out.first_level = table_.row(out.first_row).first_level;
    }
    return out;
}

void CutChooser::visit_root(uint32_t root) {
    PlacedNode top;
    top.node.object = table_.object(root).object;
    FactorField::FactorPath path = field_.root();
    visit(known(root), top, 1, path, 0);
}

bool CutChooser::exceeds_budget() const {
    const bool limited = budget_ != nullptr && (budget_->triangles > 0 || budget_->bytes > 0);
    if (nodes_->size() > most_ && !limited)
        fail(Status::InvalidArgument, "more than ", most_,
             " things and groups at a Pixel Error of ", view_.pixel_error);
    return nodes_->size() > most_ || (limited && !budget_->fits(*cut_));
}

void CutChooser::visit_all() {
    while (!stack_.empty()) {
        if (exceeds_budget())
            return;
        const PendingChild entry = stack_.back();
        stack_.pop_back();
        if (stack_.size() >= kAhead)
            table_.prefetch(stack_[stack_.size() - kAhead].child);
        visit_child(entry);
        if ((++visits_ & 1023u) == 0)
            job_.check();
    }
}

void CutChooser::visit_child(const PendingChild& entry) {
    const TableChild& child = table_.child(entry.child);
    const CutNode& group = (*nodes_)[entry.parent];
    const Affine& around = (*transforms_)[entry.parent];
    const GroupFrame& above = frames_[entry.depth - 1];
    PlacedNode placed;
    placed.node.parent = entry.parent;
    placed.node.placement = entry.position;
    double enlarge = above.stretch;
    double demand = 1;
    if (!place_child(table_, group, around, child, placed, enlarge, demand))
        return;
    path_.lenses = above.path.lenses;
    if (field_.follows_paths())
        path_ = field_.below(above.path, around,
                             table_.model()
                                 .objects[group.object]
                                 .representations[0]
                                 .assembly()
                                 .placements[entry.position]);
    visit({child.row, demand, child.finest_error, child.first_child, child.child_count,
           child.first_row, child.first_level},
          placed, enlarge, path_, entry.depth);
}

/// Appends a node; the transforms are in the same order as the nodes.
uint32_t CutChooser::append(PlacedNode& placed, const SeenNode& seen) {
    const auto index = static_cast<uint32_t>(nodes_->size());
    placed.node.transform = index;
    nodes_->push_back(placed.node);
    transforms_->push_back(placed.world);
    if (seen_ != nullptr)
        seen_->push_back(seen);
    return index;
}

void CutChooser::visit(const KnownObject& known, PlacedNode& placed, double enlarge,
                       FactorField::FactorPath& path, uint32_t depth) {
    CutNode& node = placed.node;
    const TableRow& row = table_.row(known.row);
    if (!row.drawable)
        return;
    OccurrenceSight sight;
    DetailFactors factors;
    if (!find_sight(view_, field_, placed, row.group, table_.bound(known.row), known.demand,
                    enlarge, path, sight, factors))
        return;
    LevelDecision made;
    // Most groups that are opened have no level that is good enough: then none is read.
    if (row.group && node.coarsest == kAnyLevel && node.finest == 0 &&
        view_.modifiers.criterion == DetailCriterion::Resolution &&
        !good_enough(view_, sight, known.finest_error, 0, 0))
        made.opened = made.drawn = true;
    else
        made = decide_level(table_, view_, known.row, node, sight);
    if (!made.drawn)
        return;
    const SeenNode seen(table_, known.row, sight, made);
    if (made.opened) {
        node.opened = true;
        const uint32_t index = append(placed, seen);
        push_children(known, index, enlarge, path, depth);
        return;
    }
    const TableLevel& level = *made.level;
    node.lod = level.lod;
    node.kind = level.kind;
    const uint32_t index = append(placed, seen);
    if (cut_ == nullptr)
        return;
    take(index, level, error_on_screen(sight, level.error) / factors.off_screen);
}

void CutChooser::push_children(const KnownObject& known, uint32_t index, double enlarge,
                               const FactorField::FactorPath& path, uint32_t depth) {
    uint32_t first = known.first_child;
    uint32_t count = known.child_count;
    if (growing_ != nullptr) {
        growing_->expand(known.row);
        first = table_.object(known.row).first_child;
        count = table_.object(known.row).child_count;
    } else {
        table_.prefetch_below(first, known.first_row, known.first_level, std::min(count, kAhead));
    }
    if (frames_.size() <= depth)
        frames_.resize(depth + size_t{1});
    frames_[depth].stretch = enlarge;
    frames_[depth].path.lenses = path.lenses;
    if (field_.follows_paths())
        frames_[depth].path = path;
    for (uint32_t i = count; i-- > 0;)
        stack_.push_back({index, first + i, i, depth + 1});
}

/// Counts a node that is drawn. `shown_px`: the part of its error that the picture shows.
void CutChooser::take(uint32_t index, const TableLevel& level, double shown_px) {
    cut_->chosen.push_back(index);
    cut_->triangles += level.triangles;
    cut_->bytes += table_.model().costs.occurrence_bytes;
    cut_->originals += level.lod == 0 ? 1 : 0;
    if (drawn_.size() <= level.distinct)
        drawn_.resize(std::max<size_t>(table_.distinct(), level.distinct + size_t{1}));
    if (!drawn_[level.distinct] || is_copied(level.kind)) {
        drawn_[level.distinct] = true;
        cut_->bytes += level.bytes;
    }
    ++kinds_[static_cast<size_t>(level.kind)];
    if (shown_px > cut_->largest_error_px) {
        cut_->largest_error_px = shown_px;
        cut_->largest_error_node = index;
    }
}

}  // namespace lodestone::choose
