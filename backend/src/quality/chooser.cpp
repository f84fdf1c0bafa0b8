// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/chooser.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::quality {
namespace {

// Children whose memory is asked for before they are visited.
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

std::map<std::string, uint64_t> named(std::span<const uint64_t, kKinds> kinds) {
    std::map<std::string, uint64_t> out;
    for (size_t kind = 0; kind < kKinds; ++kind) {
        if (kinds[kind] != 0)
            out[name_of(static_cast<Kind>(kind))] = kinds[kind];
    }
    return out;
}

bool see(const View& view, FactorField& field, const Node& node, bool group, const Bound& local,
         double demand, double enlarge, FactorField::Path& path, Sight& sight, Factors& factors) {
    sight.stretch = enlarge;
    factors.importance = node.importance;
    factors.demand = demand;
    if (!field.bends(path) && view.modifiers.criterion != Criterion::Area) {
        sight.z = distance_of(local, node.world, enlarge, view.camera.position);
        sight.pixel = field.pixel(sight.z);
        sight.total = total_refinement(node.importance * demand);
        return true;
    }
    const Bound bound = transformed(local, node.world, enlarge);
    sight.z = distance(bound, view.camera.position);
    sight.pixel = field.pixel(sight.z);
    if (field.bends(path)) {
        const FactorField::Effect effect =
            field.at(node.object, group, local, node.world, bound, sight.z, path);
        if (effect.gone)
            return false;
        factors = effect.factors;
        factors.importance = node.importance;
        factors.demand = demand;
        sight.total = effect.open ? kInfinity : factors.total();
    } else {
        sight.total = total_refinement(node.importance * demand);
    }
    if (view.modifiers.criterion == Criterion::Area)
        sight.share = field.frame().rect_of_box(bound).area() /
                      (field.frame().width() * field.frame().height());
    return true;
}

bool place(const Table& table, const Node& group, const TableChild& placed, Node& node,
           double& enlarge, double& demand) {
    node.object = placed.object;
    node.hidden = group.hidden;
    node.importance = group.importance;
    demand = 1;
    if (placed.wish != 0) {
        const TableWish& wish = table.wish(placed.wish);
        node.hidden = static_cast<RayMask>(group.hidden | wish.hidden);
        if (node.hidden == kAllRays)
            return false;
        node.importance = group.importance * wish.importance;
        node.coarsest = wish.coarsest;
        node.finest = wish.finest;
        demand = wish.demand;
    }
    if (group.coarsest == 0) {
        node.coarsest = 0;
        node.finest = 0;
    }
    node.world.offset = group.world.linear * placed.offset + group.world.offset;
    if (placed.linear == kUnturned) {
        node.world.linear = group.world.linear;
    } else {
        node.world.linear = group.world.linear * table.linear(placed.linear);
        enlarge = stretch(node.world);
    }
    return true;
}

/// The cheapest good level, else the finest that can be drawn, else none. Errors rise strictly and
/// costs fall from finest to coarsest.
Decision decide(const Table& table, const View& view, uint32_t index, const Node& node,
                const Sight& sight) {
    const TableRow& row = table.row(index);
    const size_t levels = by_error(view) ? 0 : table.object(index).all_levels;
    Decision made;
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

bool Chooser::run(uint32_t root, const Budget& budget, Cut& cut) {
    job_.check();
    const size_t expected = table_.expected();
    cut.nodes.reserve(expected);
    cut.chosen.reserve(expected);
    budget_ = &budget;
    cut_ = &cut;
    nodes_ = &cut.nodes;
    visit_root(root);
    visit_all();
    if (too_dear())
        return false;
    cut.kinds = named(kinds_);
    table_.expect(cut.nodes.size());
    return true;
}

void Chooser::run(uint32_t root, std::vector<Node>& nodes, std::vector<Seen>& seen) {
    job_.check();
    nodes_ = &nodes;
    seen_ = &seen;
    visit_root(root);
    visit_all();
}

void Chooser::open(const Node& group, const Seen& known, const FactorField::Path& path,
                   std::vector<Node>& nodes, std::vector<Seen>& seen) {
    nodes_ = &nodes;
    seen_ = &seen;
    const auto index = static_cast<uint32_t>(nodes.size());
    nodes.push_back(group);
    nodes.back().opened = true;
    nodes.back().lod = 0;
    nodes.back().kind = Kind::Assembly;
    seen.push_back(known);
    push_children(this->known(known.row), index, known.stretch, path, 0);
    visit_all();
}

Chooser::Known Chooser::known(uint32_t row) const {
    const TableObject& object = table_.object(row);
    Known out{row, object.demand, 0, object.first_child, object.child_count, 0, 0};
    if (object.child_count > 0) {
        out.first_row = table_.child(object.first_child).row;
        out.first_level = table_.row(out.first_row).first_level;
    }
    return out;
}

void Chooser::visit_root(uint32_t root) {
    Node top;
    top.object = table_.object(root).object;
    FactorField::Path path = field_.root();
    visit(known(root), top, 1, path, 0);
}

bool Chooser::too_dear() const {
    const bool limited = budget_ != nullptr && (budget_->triangles > 0 || budget_->bytes > 0);
    if (nodes_->size() > most_ && !limited)
        fail(Status::InvalidArgument, "more than ", most_,
             " things and groups at a Pixel Error of ", view_.pixel_error);
    return nodes_->size() > most_ || (limited && !budget_->fits(*cut_));
}

void Chooser::visit_all() {
    while (!stack_.empty()) {
        if (too_dear())
            return;
        const Entry entry = stack_.back();
        stack_.pop_back();
        if (stack_.size() >= kAhead)
            table_.fetch(stack_[stack_.size() - kAhead].child);
        visit_child(entry);
        if ((++visits_ & 1023u) == 0)
            job_.check();
    }
}

void Chooser::visit_child(const Entry& entry) {
    const TableChild& placed = table_.child(entry.child);
    const Node& group = (*nodes_)[entry.parent];
    const Frame& above = frames_[entry.depth - 1];
    Node node;
    node.parent = entry.parent;
    node.placement = entry.position;
    double enlarge = above.stretch;
    double demand = 1;
    if (!place(table_, group, placed, node, enlarge, demand))
        return;
    path_.lenses = above.path.lenses;
    if (view_.modifiers.when_moving)
        path_ = field_.below(above.path, group.world,
                             table_.model()
                                 .objects[group.object]
                                 .representations[0]
                                 .assembly()
                                 .placements[entry.position]);
    visit({placed.row, demand, placed.finest_error, placed.first_child, placed.child_count,
           placed.first_row, placed.first_level},
          node, enlarge, path_, entry.depth);
}

void Chooser::visit(const Known& known, Node& node, double enlarge, FactorField::Path& path,
                    uint32_t depth) {
    const TableRow& row = table_.row(known.row);
    if (!row.drawable)
        return;
    Sight sight;
    Factors factors;
    if (!see(view_, field_, node, row.group, table_.bound(known.row), known.demand, enlarge, path,
             sight, factors))
        return;
    Decision made;
    // Most groups that are opened have no level that is good enough: none is read.
    if (row.group && node.coarsest == kAnyLevel && node.finest == 0 &&
        view_.modifiers.criterion == Criterion::Resolution &&
        !good_enough(view_, sight, known.finest_error, 0, 0))
        made.opened = made.drawn = true;
    else
        made = decide(table_, view_, known.row, node, sight);
    if (!made.drawn)
        return;
    const auto index = static_cast<uint32_t>(nodes_->size());
    if (made.opened) {
        node.opened = true;
        nodes_->push_back(node);
        if (seen_ != nullptr)
            seen_->push_back({known.row, 0, enlarge, sight.total});
        push_children(known, index, enlarge, path, depth);
        return;
    }
    const TableLevel& level = *made.level;
    node.lod = level.lod;
    node.kind = level.kind;
    nodes_->push_back(node);
    if (seen_ != nullptr)
        seen_->push_back(
            {known.row, static_cast<uint32_t>(&level - &table_.level(0)), enlarge, sight.total});
    if (cut_ == nullptr)
        return;
    take(index, level, error_on_screen(sight, level.error) / factors.off_screen);
}

void Chooser::push_children(const Known& known, uint32_t index, double enlarge,
                            const FactorField::Path& path, uint32_t depth) {
    uint32_t first = known.first_child;
    uint32_t count = known.child_count;
    if (growing_ != nullptr) {
        growing_->expand(known.row);
        first = table_.object(known.row).first_child;
        count = table_.object(known.row).child_count;
    } else {
        table_.fetch_below(first, known.first_row, known.first_level, std::min(count, kAhead));
    }
    if (frames_.size() <= depth)
        frames_.resize(depth + size_t{1});
    frames_[depth].stretch = enlarge;
    frames_[depth].path.lenses = path.lenses;
    if (view_.modifiers.when_moving)
        frames_[depth].path = path;
    for (uint32_t i = count; i-- > 0;)
        stack_.push_back({index, first + i, i, depth + 1});
}

/// Counts what is drawn. `shown_px`: what of its error the picture shows.
void Chooser::take(uint32_t index, const TableLevel& level, double shown_px) {
    cut_->chosen.push_back(index);
    cut_->triangles += level.triangles;
    cut_->bytes += kBytesPerOccurrence;
    cut_->originals += level.lod == 0 ? 1 : 0;
    if (drawn_.size() <= level.distinct)
        drawn_.resize(std::max<size_t>(table_.distinct(), level.distinct + size_t{1}));
    // A composite is copied for each occurrence.
    if (!drawn_[level.distinct] || level.kind == Kind::Composite) {
        drawn_[level.distinct] = true;
        cut_->bytes += level.bytes;
    }
    ++kinds_[static_cast<size_t>(level.kind)];
    if (shown_px > cut_->largest_error_px) {
        cut_->largest_error_px = shown_px;
        cut_->largest_error_node = index;
    }
}

}  // namespace lodestone::quality
