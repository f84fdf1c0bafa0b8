// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/step.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

namespace lodestone::quality {
namespace {

// Margins. Where a decision turns is known to some 1e-15 of a distance, a distance to as much of the
// coordinates it is made of, and a turning camera's pixels to some 1e-15.
constexpr double kTurned = 1e-9;  // by so much pixels may differ and count as the same
constexpr double kRounding = 1e-8;
constexpr double kOfPlaces = 1e-11;
constexpr double kOfTravel = 1e-12;
constexpr double kFarthest = 1e9;  // metres of travel
constexpr size_t kBlock = 16;      // nodes that are skipped together
constexpr size_t kLeastShare =
    2;  // where more than one in so many is expired, choosing anew is sooner

bool same(const DetailLens& a, const DetailLens& b) {
    const auto& [name, shape, transform, radius, strength, falloff, filter, objects] = a;
    return shape == b.shape && transform.linear == b.transform.linear &&
           transform.offset == b.transform.offset && radius == b.radius && strength == b.strength &&
           falloff == b.falloff && filter == b.filter && objects == b.objects;
}

/// Nothing that bends quality depends on the eye.
bool rigid(const Modifiers& modifiers) {
    // Whoever adds one has to think of it here.
    const auto& [criterion, lenses, screen_lenses, depth, focus, when_moving, closing, when_dark,
                 off_screen, ray_classes] = modifiers;  // classes do not change the camera's cut
    return criterion == Criterion::Resolution && screen_lenses.empty() && depth == 1 &&
           !when_moving && !when_dark && off_screen == OffScreen::Full;
}

template <typename Value>
void grow(std::vector<Value>& values, size_t most) {
    if (values.capacity() < most)
        values.reserve(most + most / 4);
}

}  // namespace

void Stepper::Hot::resize(size_t count) {
    expires.resize(count);
    sizes.resize(count);
    places.resize(count);
}

void Stepper::step(const View& view, Cut& cut, const Job& job) {
    refuse_nonsense(view);
    if (table_->kinds() != view.kinds)
        fail(Status::Internal, "the table was made for other kinds");
    if (!known_ || !steps(view) || !move(view, cut, job))
        choose_anew(view, cut, job);
}

/// Whether the view differs from the last in where the eye is and what way it looks alone.
bool Stepper::steps(const View& view) const {
    const auto& [camera, width, height, pixel_error, kinds, border, modifiers] = view;
    if (!rigid(modifiers) || !rigid(view_.modifiers) || width != view_.width ||
        height != view_.height || pixel_error != view_.pixel_error || camera.orthographic ||
        view_.camera.orthographic || camera.near_clip != view_.camera.near_clip ||
        modifiers.lenses.size() != view_.modifiers.lenses.size())
        return false;
    if (!std::equal(modifiers.lenses.begin(), modifiers.lenses.end(),
                    view_.modifiers.lenses.begin(), same))
        return false;
    const double frame = pixel_at_1m(view);
    const auto usual = [](double value) { return value > 1e-100 && value < 1e100; };
    return usual(frame) && std::abs(frame - frame_) <= kTurned * frame_ &&
           (pixel_error == 0 || usual(pixel_error)) && camera.near_clip >= 0 &&
           camera.near_clip < 1e100;
}

void Stepper::choose_anew(const View& view, Cut& cut, const Job& job) {
    known_ = false;
    field_.reset();
    if (!rigid(view.modifiers) || view.camera.orthographic) {  // nothing kept could be used
        cut = choose(*table_, view, job);
        looked_at_ = cut.nodes.size();
        return;
    }
    view_ = view;
    field_ = std::make_unique<FactorField>(table_->model(), view_);
    frame_ = pixel_ = pixel_at_1m(view);
    travel_ = 0;
    const uint32_t root = table_->find(table_->model().root);
    fresh_.clear();
    fresh_seen_.clear();
    const size_t expected = table_->expected();
    fresh_.reserve(expected);
    fresh_seen_.reserve(expected);
    Chooser(*table_, nullptr, view_, *field_, job).run(root, fresh_, fresh_seen_);
    fresh_hot_.resize(0);
    look_at_fresh(0);
    uses_.assign(table_->distinct(), 0);
    kinds_.fill(0);
    edits_.clear();
    Cut made;
    made.nodes.swap(fresh_);
    for (size_t i = 0; i < made.nodes.size(); ++i) {
        if (!made.nodes[i].opened)
            made.chosen.push_back(static_cast<uint32_t>(i));
        count(made.nodes[i], fresh_seen_[i], true, made);
    }
    made.kinds = named(kinds_);
    seen_.swap(fresh_seen_);
    std::swap(hot_, fresh_hot_);
    find_largest(made, kNoParent);
    fresh_.swap(cut.nodes);  // for its memory
    cut = std::move(made);
    table_->expect(cut.nodes.size());
    looked_at_ = cut.nodes.size();
    known_ = true;
}

/// False: nothing was done, and it should be chosen anew.
bool Stepper::move(const View& view, Cut& cut, const Job& job) {
    job.check();
    const ImageFrame refused(view.camera, view.width, view.height);
    const double moved = glm::length(view.camera.position - view_.camera.position);
    travel_ = std::nextafter(travel_ + moved * (1 + kRounding), kInfinity);
    known_ = false;  // until all is done
    if (!(travel_ < kFarthest))
        return false;
    view_.camera = view.camera;
    pixel_ = pixel_at_1m(view);
    view_.border = view.border;
    find_expired();
    if (kLeastShare * expired_.size() > cut.nodes.size())
        return false;
    looked_at_ = expired_.size();
    find_edits(cut, job);
    uint32_t guess = cut.largest_error_node;
    if (!edits_.empty()) {
        commit(cut);
        if (guess >= cut.nodes.size())
            guess = kNoParent;
    }
    find_largest(cut, guess);
    known_ = true;
    return true;
}

Sight Stepper::sight_of(const Node& node, const Seen& seen) const {
    Sight sight;
    sight.z = distance_of(table_->bound(seen.row), node.world, seen.stretch, view_.camera.position);
    sight.pixel = pixel_ * std::max(sight.z, view_.camera.near_clip);
    sight.stretch = seen.stretch;
    sight.total = seen.total;
    return sight;
}

/// How far rounding may be off in distances of a node, and in sums of them and the travel.
double Stepper::margin(const Node& node, const Seen& seen, double z) const {
    const Bound bound = table_->bound(seen.row);
    return kOfPlaces * (glm::length(view_.camera.position) + glm::length(node.world(bound.center)) +
                        bound.radius * seen.stretch + z) +
           kOfTravel * travel_;
}

/// From where to where the decision holds, and so for how long.
void Stepper::look(Hot& hot, size_t index, const Node& node, const Seen& seen, const Sight& sight,
                   const Decision& made) const {
    const TableRow& row = table_->row(seen.row);
    const double per_metre = view_.pixel_error * frame_;
    bool numbers = true;
    /// The distance from which on an error is good enough.
    const auto from = [&](double error) {
        if (std::isinf(sight.total))
            return kInfinity;
        const double size = error * sight.stretch * sight.total;
        numbers = numbers && size >= 0;
        return size > 0 ? size / per_metre : 0;
    };
    double low = 0;
    double high = kInfinity;
    bool first = true;
    for (uint32_t i = row.level_count; i-- > 0;) {
        const TableLevel& level = table_->level(row.first_level + i);
        if (level.lod > node.coarsest)
            continue;
        if (!first && level.lod < node.finest)
            break;
        first = false;
        if (made.good && &level == made.level) {
            low = from(level.error);
            break;
        }
        high = std::min(high, from(level.error));
    }
    if (made.good && !made.pinned && made.level->opens_from < kInfinity) {
        const double opens = from(made.level->opens_from);
        if (made.cheaper)
            low = std::max(low, opens);
        else
            high = std::min(high, opens);
    }
    const double near = view_.camera.near_clip;
    const double z = sight.z;
    const double nearer = low <= near * (1 - kRounding) ? kInfinity : z - low * (1 + kRounding);
    const double farther = high * (1 - kRounding) - z;
    const double slack = std::min(nearer, farther);
    const double off = margin(node, seen, z);
    hot.expires[index] = numbers && slack > 0 ? travel_ + slack - off : -kInfinity;
    hot.sizes[index] = made.opened ? -1 : made.level->error * seen.stretch / frame_;
    hot.places[index] = z + travel_ - off;
}

/// Of what was visited from `begin` on.
void Stepper::look_at_fresh(size_t begin) {
    fresh_hot_.resize(fresh_.size());
    for (size_t i = begin; i < fresh_.size(); ++i) {
        const Sight sight = sight_of(fresh_[i], fresh_seen_[i]);
        look(fresh_hot_, i, fresh_[i], fresh_seen_[i], sight,
             decide(*table_, view_, fresh_seen_[i].row, fresh_[i], sight));
    }
}

void Stepper::find_expired() {
    expired_.clear();
    const size_t count = hot_.size();
    const double* expires = hot_.expires.data();
    for (size_t begin = 0; begin < count; begin += kBlock) {
        const size_t end = std::min(begin + kBlock, count);
        int any = 0;
        for (size_t i = begin; i < end; ++i)
            any |= static_cast<int>(!(expires[i] > travel_));
        if (any == 0)
            continue;
        for (size_t i = begin; i < end; ++i) {
            if (!(expires[i] > travel_))
                expired_.push_back(static_cast<uint32_t>(i));
        }
    }
}

/// Lenses need all groups around a node, in order.
FactorField::Path Stepper::path_below(const Cut& cut, uint32_t node) {
    FactorField::Path path = field_->root();
    if (!field_->bends())
        return path;
    std::vector<uint32_t> way;
    for (uint32_t at = node; at != kNoParent; at = cut.nodes[at].parent)
        way.push_back(at);
    for (size_t i = way.size(); i-- > 0;) {
        const Node& here = cut.nodes[way[i]];
        const Seen& seen = seen_[way[i]];
        const TableRow& row = table_->row(seen.row);
        Sight sight;
        Factors factors;
        see(view_, *field_, here, row.group, table_->bound(seen.row),
            table_->object(seen.row).demand, seen.stretch, path, sight, factors);
    }
    return path;
}

void Stepper::find_edits(const Cut& cut, const Job& job) {
    edits_.clear();
    fresh_.clear();
    fresh_seen_.clear();
    fresh_hot_.resize(0);
    Chooser chooser(*table_, nullptr, view_, *field_, job);
    uint32_t next = 0;  // behind what was closed
    for (const uint32_t index : expired_) {
        if (index < next)
            continue;
        const Node& node = cut.nodes[index];
        const Seen& seen = seen_[index];
        const Sight sight = sight_of(node, seen);
        const Decision made = decide(*table_, view_, seen.row, node, sight);
        if (made.opened == node.opened && (made.opened || made.level->lod == node.lod)) {
            look(hot_, index, node, seen, sight, made);
            continue;
        }
        Edit edit;
        edit.at = index;
        edit.begin = static_cast<uint32_t>(fresh_.size());
        if (node.opened) {
            while (index + edit.removed < cut.nodes.size()) {
                const uint32_t parent = cut.nodes[index + edit.removed].parent;
                if (parent == kNoParent || parent < index)
                    break;
                ++edit.removed;
            }
        }
        next = index + edit.removed;
        if (made.opened) {
            chooser.open(node, seen, path_below(cut, index), fresh_, fresh_seen_);
        } else {
            Node drawn = node;
            drawn.opened = false;
            drawn.lod = made.level->lod;
            drawn.kind = made.level->kind;
            fresh_.push_back(drawn);
            Seen now = seen;
            now.level = static_cast<uint32_t>(made.level - &table_->level(0));
            fresh_seen_.push_back(now);
        }
        look_at_fresh(edit.begin);
        edit.end = static_cast<uint32_t>(fresh_.size());
        edits_.push_back(edit);
    }
}

/// Adds a node's costs to the cut's sums, or takes them away.
void Stepper::count(const Node& node, const Seen& seen, bool more, Cut& cut) {
    if (node.opened)
        return;
    const TableLevel& level = table_->level(seen.level);
    uint32_t& uses = uses_[level.distinct];
    // A composite is copied for each occurrence.
    const bool own = level.kind == Kind::Composite || uses == (more ? 0u : 1u);
    const uint64_t bytes = kBytesPerOccurrence + (own ? level.bytes : 0);
    const uint64_t original = level.lod == 0 ? 1 : 0;
    uint64_t& kind = kinds_[static_cast<size_t>(level.kind)];
    if (more) {
        ++uses;
        ++kind;
        cut.triangles += level.triangles;
        cut.bytes += bytes;
        cut.originals += original;
    } else {
        --uses;
        --kind;
        cut.triangles -= level.triangles;
        cut.bytes -= bytes;
        cut.originals -= original;
    }
}

void Stepper::commit(Cut& cut) {
    const auto kinds = kinds_;
    bool in_place = true;
    for (const Edit& edit : edits_)
        in_place = in_place && edit.removed == 1 && edit.end - edit.begin == 1;
    if (!in_place) {  // what may fail comes first
        const size_t most = cut.nodes.size() + fresh_.size();
        grow(cut.nodes, most);
        grow(seen_, most);
        for (std::vector<double>* one : {&hot_.expires, &hot_.sizes, &hot_.places})
            grow(*one, most);
        spare_chosen_.reserve(most);
        runs_.reserve(edits_.size() + 1);
    }
    for (const Edit& edit : edits_) {
        for (uint32_t i = edit.at; i < edit.at + edit.removed; ++i)
            count(cut.nodes[i], seen_[i], false, cut);
        for (uint32_t i = edit.begin; i < edit.end; ++i)
            count(fresh_[i], fresh_seen_[i], true, cut);
    }
    if (in_place) {
        spare_chosen_.clear();
        spare_chosen_.reserve(edits_.size());
        for (const Edit& edit : edits_)
            insert(cut, edit, edit.at, fresh_[edit.begin].parent);
    } else {
        splice(cut);
    }
    if (kinds != kinds_)
        cut.kinds = named(kinds_);
}

/// Moves what stays, in its place, and puts the fresh nodes between.
void Stepper::splice(Cut& cut) {
    runs_.assign(1, {});
    for (const Edit& edit : edits_) {
        Run& before = runs_.back();
        before.end = edit.at;
        const uint32_t shift = before.shift + (edit.end - edit.begin) - edit.removed;
        runs_.push_back({edit.at + edit.removed, 0, shift});
    }
    const auto count = static_cast<uint32_t>(cut.nodes.size());
    runs_.back().end = count;
    const uint32_t wanted = count + runs_.back().shift;
    const uint32_t room = std::max(count, wanted);
    cut.nodes.resize(room);
    seen_.resize(room);
    hot_.resize(room);
    const auto moved = [&](uint32_t index) {
        if (index == kNoParent)
            return index;
        const auto after =
            std::upper_bound(runs_.begin(), runs_.end(), index,
                             [](uint32_t value, const Run& run) { return value < run.begin; });
        return index + (after - 1)->shift;
    };
    const auto move = [&](const Run& run) {
        const auto one = [&](auto* all) {
            if (run.shift != 0)
                std::memmove(all + (run.begin + run.shift), all + run.begin,
                             (run.end - run.begin) * sizeof(*all));
        };
        static_assert(std::is_trivially_copyable_v<Node> && std::is_trivially_copyable_v<Seen>);
        one(seen_.data());
        one(hot_.expires.data());
        one(hot_.sizes.data());
        one(hot_.places.data());
        one(cut.nodes.data());
        for (uint32_t i = run.begin + run.shift; run.begin > 0 && i < run.end + run.shift; ++i) {
            uint32_t& parent = cut.nodes[i].parent;
            parent =
                parent >= run.begin && parent != kNoParent ? parent + run.shift : moved(parent);
        }
    };
    // What moves down overwrites only what has moved down before it, or is gone; then, from the end,
    // what moves up overwrites only what has moved.
    const auto down = [](const Run& run) { return static_cast<int32_t>(run.shift) < 0; };
    for (size_t i = 0; i < runs_.size(); ++i) {
        if (down(runs_[i]))
            move(runs_[i]);
    }
    for (size_t i = runs_.size(); i-- > 0;) {
        if (!down(runs_[i]))
            move(runs_[i]);
    }
    cut.nodes.resize(wanted);
    seen_.resize(wanted);
    hot_.resize(wanted);
    spare_chosen_.clear();
    auto chosen = cut.chosen.begin();
    for (size_t k = 0; k < runs_.size(); ++k) {
        const Run& run = runs_[k];
        chosen = std::lower_bound(chosen, cut.chosen.end(), run.begin);
        const auto end = std::lower_bound(chosen, cut.chosen.end(), run.end);
        for (; chosen != end; ++chosen)
            spare_chosen_.push_back(*chosen + run.shift);
        if (k < edits_.size())
            insert(cut, edits_[k], run.end + run.shift, moved(fresh_[edits_[k].begin].parent));
    }
    cut.chosen.swap(spare_chosen_);
}

/// Puts the fresh nodes of an edit at a place that is free. `parent`: of the first of them.
void Stepper::insert(Cut& cut, const Edit& edit, uint32_t place, uint32_t parent) {
    for (uint32_t from = edit.begin; from < edit.end; ++from) {
        const uint32_t to = place + (from - edit.begin);
        Node& node = cut.nodes[to] = fresh_[from];
        node.parent = from == edit.begin ? parent : node.parent - edit.begin + place;
        seen_[to] = fresh_seen_[from];
        hot_.expires[to] = fresh_hot_.expires[from];
        hot_.sizes[to] = fresh_hot_.sizes[from];
        hot_.places[to] = fresh_hot_.places[from];
        if (!node.opened)
            spare_chosen_.push_back(to);
    }
}

/// The first of the largest errors on screen. Errors grow no faster than the eye may have come
/// nearer; only what may then be the largest is computed. `guess`: a node, or none.
void Stepper::find_largest(Cut& cut, uint32_t guess) {
    cut.largest_error_px = 0;
    cut.largest_error_node = kNoParent;
    const auto consider = [&](size_t index) {
        const Node& node = cut.nodes[index];
        if (node.opened)
            return;
        const Sight sight = sight_of(node, seen_[index]);
        const double z = sight.z;
        hot_.places[index] = z + travel_ - margin(node, seen_[index], z);
        const TableLevel& level = table_->level(seen_[index].level);
        const double error = error_on_screen(sight, level.error);
        if (error > cut.largest_error_px ||
            (error == cut.largest_error_px && index < cut.largest_error_node && error > 0)) {
            cut.largest_error_px = error;
            cut.largest_error_node = static_cast<uint32_t>(index);
        }
    };
    if (guess != kNoParent)
        consider(guess);
    const size_t count = hot_.size();
    const double* sizes = hot_.sizes.data();
    const double* places = hot_.places.data();
    const double near = view_.camera.near_clip;
    for (size_t begin = 0; begin < count; begin += kBlock) {
        const size_t end = std::min(begin + kBlock, count);
        const double best = cut.largest_error_px * (1 - 2 * kRounding);
        int any = 0;
        for (size_t i = begin; i < end; ++i)
            any |= static_cast<int>(!(sizes[i] <= best * std::max(places[i] - travel_, near)));
        if (any == 0)
            continue;
        for (size_t i = begin; i < end; ++i) {
            const double least = cut.largest_error_px * (1 - 2 * kRounding);
            if (!(sizes[i] <= least * std::max(places[i] - travel_, near)))
                consider(i);
        }
    }
}

}  // namespace lodestone::quality
