// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/cut.h"

#include "base/maths.h"
#include "quality/criterion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lodestone::quality {
namespace {

constexpr size_t kKinds = static_cast<size_t>(Kind::Assembly) + 1;

/// How a node is seen. False when a lens hides it. `path` becomes that of what is below it.
bool see(const View& view, FactorField& field, const Node& node, bool group, const Bound& local,
         double demand, double enlarge, FactorField::Path& path, Sight& sight, Factors& factors) {
    sight.stretch = enlarge;
    const Bound bound = transformed(local, node.world, enlarge);
    sight.z = distance(bound, view.camera.position);
    bool open = false;
    if (field.bends()) {
        const FactorField::Effect effect =
            field.at(node.object, group, local, node.world, bound, sight.z, path);
        if (effect.gone)
            return false;
        factors = effect.factors;
        open = effect.open;
    }
    factors.importance = node.importance;
    factors.demand = demand;
    sight.total = open ? kInfinity : factors.total();
    if (view.modifiers.criterion == Criterion::Area)
        sight.share = field.frame().rect_of_box(bound).area() /
                      (field.frame().width() * field.frame().height());
    return true;
}

/// Visits what is drawn and the groups above it, depth first, each once.
class Chooser {
public:
    /// `growing`: the same table, where rows are made on the way.
    Chooser(const Table& table, Table* growing, const View& view, const Budget& budget,
            const Job& job)
        : table_(table),
          growing_(growing),
          view_(view),
          budget_(budget),
          job_(job),
          field_(table.model(), view),
          by_error_(view.modifiers.criterion == Criterion::Resolution ||
                    view.modifiers.criterion == Criterion::Feature) {}

    /// Nothing when it is known to cost more than the budget.
    std::optional<Cut> run(uint32_t root) {
        job_.check();
        const size_t expected = table_.expected();
        cut_.nodes.reserve(expected);
        cut_.chosen.reserve(expected);
        Node top;
        FactorField::Path path = field_.root();
        visit(root, top, 1, path, 0);
        if (!budget_.fits(cut_))
            return std::nullopt;
        while (!stack_.empty()) {
            const Entry entry = stack_.back();
            stack_.pop_back();
            visit_child(entry);
            if ((++visits_ & 1023u) == 0)
                job_.check();
            if (!budget_.fits(cut_))
                return std::nullopt;
        }
        for (size_t kind = 0; kind < kKinds; ++kind) {
            if (kinds_[kind] != 0)
                cut_.kinds[name_of(static_cast<Kind>(kind))] = kinds_[kind];
        }
        table_.expect(cut_.nodes.size());
        return std::move(cut_);
    }

private:
    struct Entry {
        uint32_t parent;    // node
        uint32_t child;     // of the table
        uint32_t position;  // among the placements
        uint32_t depth;
    };
    /// The group at some depth that is being visited.
    struct Frame {
        double stretch = 1;
        FactorField::Path path;  // of what it places
    };

    void visit_child(const Entry& entry) {
        const TableChild& placed = table_.child(entry.child);
        const Node& group = cut_.nodes[entry.parent];
        const Frame& above = frames_[entry.depth - 1];
        Node node;
        node.hidden = static_cast<RayMask>(group.hidden | placed.hidden);
        if (node.hidden == kAllRays)  // nothing would show it
            return;
        node.parent = entry.parent;
        node.placement = entry.position;
        node.importance = group.importance * placed.importance;
        node.coarsest = group.coarsest == 0 ? 0 : placed.coarsest;
        node.finest = group.coarsest == 0 ? 0 : placed.finest;
        double enlarge = above.stretch;
        node.world.offset = group.world.linear * placed.offset + group.world.offset;
        if (placed.linear == kUnturned) {
            node.world.linear = group.world.linear;
        } else {
            node.world.linear = group.world.linear * table_.linear(placed.linear);
            enlarge = stretch(node.world);
        }
        path_.lenses = above.path.lenses;
        if (view_.modifiers.when_moving)
            path_ = field_.below(above.path, group.world,
                                 table_.model()
                                     .objects[group.object]
                                     .representations[0]
                                     .assembly()
                                     .placements[entry.position]);
        visit(placed.row, node, enlarge, path_, entry.depth);
    }

    /// The cheapest good level, else the finest that can be drawn, else none. Errors rise strictly
    /// and costs fall from finest to coarsest.
    const TableLevel* pick(const TableRow& row, const Node& node, const Sight& sight,
                           bool& good) const {
        const TableLevel* finest = nullptr;
        for (uint32_t i = row.level_count; i-- > 0;) {
            const TableLevel& level = table_.level(row.first_level + i);
            if (level.lod > node.coarsest)
                continue;
            if (finest != nullptr && level.lod < node.finest)
                break;
            finest = &level;
            good = good_enough(view_, sight, level.error, level.lod, row.all_levels);
            if (good)
                break;
        }
        return finest;
    }

    void visit(uint32_t row_index, Node& node, double enlarge, FactorField::Path& path,
               uint32_t depth) {
        const TableRow& row = table_.row(row_index);
        if (!row.drawable)
            return;
        node.object = row.object;
        Sight sight;
        Factors factors;
        if (!see(view_, field_, node, row.group, row.bound, row.demand, enlarge, path, sight,
                 factors))
            return;
        bool good = false;
        const TableLevel* level = pick(row, node, sight, good);
        if (level == nullptr && !row.group)
            return;
        const auto index = static_cast<uint32_t>(cut_.nodes.size());
        const bool pinned = node.finest > 0 && level != nullptr;
        const bool cheaper =
            level != nullptr && good && !pinned && by_error_ && level->opens_from < kInfinity &&
            good_enough(view_, sight, level->opens_from, level->lod, row.all_levels);
        if (level == nullptr || (row.group && !pinned && (!good || cheaper))) {
            node.opened = true;
            if (cheaper)
                node.need =
                    threshold_for(view_, sight, level->opens_from, level->lod, row.all_levels);
            cut_.nodes.push_back(node);
            open(row_index, index, enlarge, path, depth);
            return;
        }
        node.lod = level->lod;
        node.kind = level->kind;
        node.error_px = error_on_screen(view_, level->error, sight.stretch, sight.z);
        if (good)
            node.need = by_error_ && view_.modifiers.criterion == Criterion::Resolution
                            ? node.error_px * sight.total
                            : threshold_for(view_, sight, level->error, level->lod, row.all_levels);
        cut_.nodes.push_back(node);
        take(index, *level, node.error_px / factors.off_screen);
    }

    void open(uint32_t row_index, uint32_t index, double enlarge, const FactorField::Path& path,
              uint32_t depth) {
        if (growing_ != nullptr)
            growing_->expand(row_index);
        const TableRow& row = table_.row(row_index);
        if (frames_.size() <= depth)
            frames_.resize(depth + size_t{1});
        frames_[depth].stretch = enlarge;
        frames_[depth].path.lenses = path.lenses;
        if (view_.modifiers.when_moving)
            frames_[depth].path = path;
        for (uint32_t i = row.child_count; i-- > 0;) {
            stack_.push_back({index, row.first_child + i, i, depth + 1});
            table_.fetch(table_.child(row.first_child + i).row);
        }
    }

    /// Counts what is drawn. `shown_px`: what of its error the picture shows.
    void take(uint32_t index, const TableLevel& level, double shown_px) {
        cut_.chosen.push_back(index);
        cut_.triangles += level.triangles;
        cut_.bytes += kBytesPerOccurrence;
        if (drawn_.size() <= level.distinct)
            drawn_.resize(std::max<size_t>(table_.distinct(), level.distinct + size_t{1}));
        // A composite is copied for each occurrence.
        if (!drawn_[level.distinct] || level.kind == Kind::Composite) {
            drawn_[level.distinct] = true;
            cut_.bytes += level.bytes;
        }
        ++kinds_[static_cast<size_t>(level.kind)];
        if (shown_px > cut_.largest_error_px) {
            cut_.largest_error_px = shown_px;
            cut_.largest_error_node = index;
        }
    }

    const Table& table_;
    Table* growing_;
    const View& view_;
    const Budget& budget_;
    const Job& job_;
    FactorField field_;
    FactorField::Path path_;  // of what is visited; of motion only where that counts
    bool by_error_;
    Cut cut_;
    std::vector<Entry> stack_;
    std::vector<Frame> frames_;  // by depth
    std::vector<bool> drawn_;    // by TableLevel::distinct
    std::array<uint64_t, kKinds> kinds_{};
    size_t visits_ = 0;
};

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

ObjectIndex root_of(const Model& model) {
    if (model.root >= model.objects.size())
        fail(Status::InvalidArgument, "the model has no root object");
    return model.root;
}

}  // namespace

Cut choose(const Model& model, const View& view, const Job& job) {
    return choose_below(model, root_of(model), view, job);
}

Cut choose_below(const Model& model, ObjectIndex root, const View& view, const Job& job) {
    refuse_nonsense(view);
    Table table(model, view.kinds);
    const uint32_t top = table.row_of(root);
    return Chooser(table, &table, view, {}, job).run(top).value();
}

std::optional<Cut> choose_within_budget(const Table& table, const View& view, const Budget& budget,
                                        const Job& job) {
    refuse_nonsense(view);
    if (table.kinds() != view.kinds)
        fail(Status::Internal, "the table was made for other kinds");
    return Chooser(table, nullptr, view, budget, job).run(table.find(root_of(table.model())));
}

Cut choose(const Table& table, const View& view, const Job& job) {
    return choose_within_budget(table, view, {}, job).value();
}

Reason why(const Model& model, const View& view, const Cut& cut, uint32_t index) {
    // The path from the root, so that the lenses that touch it are found as when it was chosen.
    std::vector<uint32_t> way;
    for (uint32_t at = index; at != kNoParent; at = cut.nodes.at(at).parent)
        way.push_back(at);
    FactorField field(model, view);
    FactorField::Path path = field.root();
    Reason reason;
    for (size_t i = way.size(); i-- > 0;) {
        const Node& node = cut.nodes[way[i]];
        if (i + 1 < way.size()) {
            const Node& group = cut.nodes[node.parent];
            path = field.below(path, group.world,
                               model.objects.at(group.object)
                                   .representations.at(0)
                                   .assembly()
                                   .placements.at(node.placement));
        }
        Factors factors;
        Sight seen;
        const Sight* sight = &seen;
        const Object& object = model.objects.at(node.object);
        if (!see(view, field, node, object.group(), object.bound(), object.demand,
                 stretch(node.world), path, seen, factors))
            fail(Status::InvalidArgument, "the cut was made for another view");
        const size_t first = i == 0 ? node.lod + size_t{1} : size_t{1};
        for (size_t lod = first; lod < object.representations.size(); ++lod) {
            const Summary& summary = object.representations[lod].summary;
            if ((view.kinds & mask_of(summary.kind)) == 0)
                continue;
            reason.coarser =
                Reason::Level{node.object,
                              static_cast<uint32_t>(lod),
                              summary.kind,
                              summary.error,
                              error_on_screen(view, summary.error, sight->stretch, sight->z),
                              sight->total};
            reason.pinned = lod > node.coarsest;
            break;
        }
        if (i > 0)
            continue;
        const Summary& summary = object.representations.at(node.lod).summary;
        reason.z = std::max(sight->z, view.camera.near_clip);
        reason.pixel = pixel_size(view, sight->z);
        reason.stretch = sight->stretch;
        reason.factors = factors;
        reason.chosen = {node.object,   node.lod,      node.kind,
                         summary.error, node.error_px, sight->total};
    }
    return reason;
}

std::string path_of(const Model& model, const Cut& cut, uint32_t node) {
    std::string path;
    for (uint32_t at = node; at != kNoParent && cut.nodes.at(at).parent != kNoParent;
         at = cut.nodes[at].parent) {
        const Node& here = cut.nodes[at];
        const Object& group = model.objects[cut.nodes[here.parent].object];
        const std::string& name =
            group.representations[0].assembly().placements[here.placement].name;
        if (!path.empty())
            path.insert(path.begin(), '/');
        path.insert(0, name);
    }
    return path;
}

}  // namespace lodestone::quality
