// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/follow/cut_stepper.h"

#include "choose/follow/lens_change.h"

#include <algorithm>
#include <utility>

namespace lodestone::choose {
namespace {

// The limits from which on choosing anew is faster than a step. Either less than one of kLeastKept
// nodes has not expired, or more than one of kLeastShare has to be decided again; kSome nodes are
// never too many.
// Fitted: by tests/bench/speed/bench_cut.cpp, leaps of 1000 m over 1,048,576 houses.
constexpr size_t kLeastKept = 4;
// Fitted: by tests/bench/speed/bench_cut.cpp, steps of 100 m over 1,048,576 houses.
constexpr size_t kLeastShare = 16;
// Taste: a larger number makes steps of small cuts slower, a smaller one chooses more anew.
constexpr size_t kSome = 64;
// The most choices in a row that keep no facts for steps. Choosing takes twice as long when it
// keeps them. After a useless step none are kept once, after the next one three times, and so on up
// to this.
// Fitted: by tests/bench/speed/bench_cut.cpp, a walk over 1,048,576 houses with steps of 100 m.
constexpr uint32_t kMostPlain = 31;
// How many nodes ahead memory is asked for.
// Taste: as kAhead in cut_chooser.cpp; more displace what is still needed, fewer come too late.
constexpr size_t kFetched = 8;

/// True if no modifier that changes detail depends on the eye.
bool rigid(const QualityModifiers& modifiers) {
    // A new modifier breaks this line, so that its author decides here.
    const auto& [criterion, lenses, screen_lenses, depth, focus, when_moving, closing, when_dark,
                 off_screen, ray_classes] = modifiers;  // classes do not change the camera's cut
    return criterion == DetailCriterion::Resolution && screen_lenses.empty() && depth == 1 &&
           !when_moving && !when_dark && off_screen == OffScreen::Full;
}

}  // namespace

void CutStepper::step(const View& view, Cut& cut, const Job& job) {
    refuse_nonsense(view);
    if (table_->kinds() != view.kinds)
        fail(Status::Internal, "the table was made for other kinds");
    if (known_) {
        if (steps(view) && move(view, cut, job)) {
            in_vain_ = 0;
            return;
        }
        in_vain_ = std::min(2 * in_vain_ + 1, kMostPlain);
        plain_ = in_vain_;
    }
    choose_anew(view, cut, job);
}

/// Whether the view differs from the last one only in where the eye is, in which direction it
/// looks, and in lenses that hide nothing.
bool CutStepper::steps(const View& view) const {
    const auto& [camera, width, height, pixel_error, kinds, border, modifiers] = view;
    const View& last = walk_->view;
    if (!rigid(modifiers) || !rigid(last.modifiers) || width != last.width ||
        height != last.height || pixel_error != last.pixel_error || camera.orthographic ||
        last.camera.orthographic || camera.near_clip != last.camera.near_clip)
        return false;
    const double frame = pixel_at_1m(view);
    const auto usual = [](double value) { return value > 1e-100 && value < 1e100; };
    return usual(frame) && EyeWalk::same_pixels(frame, walk_->frame) &&
           (pixel_error == 0 || usual(pixel_error)) && camera.near_clip >= 0 &&
           camera.near_clip < 1e100;
}

void CutStepper::choose_anew(const View& view, Cut& cut, const Job& job) {
    known_ = false;
    field_.reset();
    const bool plain = plain_ > 0;
    plain_ -= plain ? 1 : 0;
    if (plain || !rigid(view.modifiers) || view.camera.orthographic) {
        cut = choose_cut(*table_, view, job);
        looked_at_ = cut.nodes.size();
        return;
    }
    walk_.emplace(*table_, view);
    field_ = std::make_unique<FactorField>(table_->model(), walk_->view);
    const uint32_t root = table_->find(table_->model().root);
    fresh_.clear();
    fresh_.reserve(table_->expected());
    CutChooser(*table_, nullptr, walk_->view, *field_, job).run(root, fresh_);
    fresh_.slack.resize(0);
    fresh_.ranges.clear();
    look_at_fresh(0);
    tally_.clear(*table_);
    edits_.clear();
    Cut made;
    made.nodes.swap(fresh_.nodes);
    made.transforms.swap(fresh_.transforms);
    for (size_t i = 0; i < made.nodes.size(); ++i) {
        if (!made.nodes[i].opened)
            made.chosen.push_back(static_cast<uint32_t>(i));
        count(made.nodes[i], fresh_.seen[i], true, made);
    }
    made.kinds = counts_by_kind(tally_.kinds());
    kept_.seen.swap(fresh_.seen);
    kept_.ranges.swap(fresh_.ranges);
    kept_.free.clear();
    std::swap(kept_.slack, fresh_.slack);
    kept_.slack.find_largest(*walk_, kept_.seen, kept_.ranges, made, kNoParent);
    fresh_.nodes.swap(cut.nodes);  // so that their memory is used again
    fresh_.transforms.swap(cut.transforms);
    cut = std::move(made);
    table_->expect(cut.nodes.size());
    looked_at_ = cut.nodes.size();
    known_ = true;
}

/// False: nothing was done, and the cut should be chosen anew.
bool CutStepper::move(const View& view, Cut& cut, const Job& job) {
    job.check();
    const ImageFrame refused(view.camera, view.width, view.height);
    known_ = false;  // until the step is complete
    if (!walk_->advance_to(view))
        return false;
    kept_.slack.find_expired(walk_->travel, expired_);
    if (expired_.size() > std::max(kSome, cut.nodes.size() - cut.nodes.size() / kLeastKept))
        return false;
    keep_what_holds(cut);
    if (!change_lenses(view.modifiers.lenses, cut))
        return false;
    if (expired_.size() > std::max(kSome, cut.nodes.size() / kLeastShare))
        return false;
    looked_at_ = expired_.size();
    find_edits(cut, job);
    uint32_t guess = cut.largest_error_node;
    if (!edits_.empty()) {
        commit(cut);
        if (guess >= cut.nodes.size())
            guess = kNoParent;
    }
    kept_.slack.find_largest(*walk_, kept_.seen, kept_.ranges, cut, guess);
    known_ = true;
    return true;
}

/// Removes from the expired nodes all that are still within their range.
void CutStepper::keep_what_holds(const Cut& cut) {
    const size_t count = expired_.size();
    size_t left = 0;
    for (size_t i = 0; i < count; ++i) {
        if (i + 2 * kFetched < count)
            __builtin_prefetch(&cut.nodes[expired_[i + 2 * kFetched]].transform);
        if (i + kFetched < count)
            __builtin_prefetch(&kept_.ranges[cut.nodes[expired_[i + kFetched]].transform]);
        const uint32_t index = expired_[i];
        const uint32_t transform = cut.nodes[index].transform;
        if (kept_.slack.renew(index, *walk_, kept_.ranges[transform]))
            continue;
        expired_[left++] = index;
        __builtin_prefetch(&kept_.seen[transform]);
        __builtin_prefetch(&cut.transforms[transform].linear);
        __builtin_prefetch(&cut.transforms[transform].offset);
    }
    expired_.resize(left);
}

/// Adds the nodes that changed lenses reach to the expired ones. False: something may appear.
bool CutStepper::change_lenses(const std::vector<DetailLens>& lenses, const Cut& cut) {
    const auto changed = changed_lenses(walk_->view.modifiers.lenses, lenses);
    if (changed.empty())
        return true;
    if (std::any_of(changed.begin(), changed.end(),
                    [](const DetailLens& lens) { return lens.filter == LensFilter::Show; }))
        return false;
    walk_->view.modifiers.lenses = lenses;
    field_ = std::make_unique<FactorField>(table_->model(), walk_->view);
    refresh_lens_factors(*table_, walk_->view, changed, *field_, cut, kept_.seen, reached_);
    const auto middle = expired_.insert(expired_.end(), reached_.begin(), reached_.end());
    std::inplace_merge(expired_.begin(), middle, expired_.end());
    expired_.erase(std::unique(expired_.begin(), expired_.end()), expired_.end());
    return true;
}

/// Computes the ranges and the slack of the fresh nodes from `begin` on.
void CutStepper::look_at_fresh(size_t begin) {
    fresh_.slack.resize(fresh_.nodes.size());
    fresh_.ranges.reserve(fresh_.nodes.size());
    for (size_t i = begin; i < fresh_.nodes.size(); ++i) {
        const CutNode& node = fresh_.nodes[i];
        const SeenNode& seen = fresh_.seen[i];
        fresh_.ranges.emplace_back(*walk_, node, fresh_.transforms[i], seen);
        fresh_.slack.set(i, *walk_, fresh_.ranges[i], node, seen);
    }
}

/// Builds the path again, because lenses need all groups around a node, in order.
FactorField::FactorPath CutStepper::path_below(const Cut& cut, uint32_t node) {
    FactorField::FactorPath path = field_->root();
    if (!field_->bends())
        return path;
    std::vector<uint32_t> way;
    for (uint32_t at = node; at != kNoParent; at = cut.nodes[at].parent)
        way.push_back(at);
    for (size_t i = way.size(); i-- > 0;) {
        const CutNode& here = cut.nodes[way[i]];
        const SeenNode& seen = kept_.seen[here.transform];
        const TableRow& row = table_->row(seen.row);
        path = path_to(*field_, path, table_->model(), cut, here);
        OccurrenceSight sight;
        DetailFactors factors;
        find_sight(walk_->view, *field_, {here, cut.world(here)}, row.group,
                   table_->bound(seen.row), table_->object(seen.row).demand, seen.stretch, path,
                   sight, factors);
    }
    return path;
}

void CutStepper::find_edits(const Cut& cut, const Job& job) {
    edits_.clear();
    fresh_.clear();
    fresh_.slack.resize(0);
    fresh_.ranges.clear();
    CutChooser chooser(*table_, nullptr, walk_->view, *field_, job);
    uint32_t next = 0;  // the first node behind the group that was closed
    for (const uint32_t index : expired_) {
        if (index < next)
            continue;
        const CutNode& node = cut.nodes[index];
        const PlacedNode placed{node, cut.world(node)};
        SeenNode& seen = kept_.seen[node.transform];
        const OccurrenceSight sight = walk_->sight_of(placed.world, seen);
        const LevelDecision made = decide_level(*table_, walk_->view, seen.row, node, sight);
        const SeenNode now(*table_, seen.row, sight, made);
        if (made.opened == node.opened && (made.opened || made.level->lod == node.lod)) {
            seen = now;
            kept_.ranges[node.transform] = DrawnRange(*walk_, node, placed.world, seen);
            kept_.slack.set(index, *walk_, kept_.ranges[node.transform], node, seen);
            continue;
        }
        NodeEdit edit;
        edit.at = index;
        edit.begin = static_cast<uint32_t>(fresh_.nodes.size());
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
            chooser.open(placed, now, path_below(cut, index), fresh_);
        } else {
            CutNode drawn = node;
            drawn.opened = false;
            drawn.lod = made.level->lod;
            drawn.kind = made.level->kind;
            fresh_.nodes.push_back(drawn);
            fresh_.transforms.push_back(placed.world);
            fresh_.seen.push_back(now);
        }
        look_at_fresh(edit.begin);
        edit.end = static_cast<uint32_t>(fresh_.nodes.size());
        edits_.push_back(edit);
    }
}

void CutStepper::count(const CutNode& node, const SeenNode& seen, bool more, Cut& cut) {
    if (!node.opened)
        tally_.count(table_->level(seen.level), more, cut);
}

void CutStepper::commit(Cut& cut) {
    splicer_.reserve(edits_, fresh_, cut, kept_);  // all that may fail comes first
    const auto kinds = tally_.kinds();
    for (const NodeEdit& edit : edits_) {
        for (uint32_t i = edit.at; i < edit.at + edit.removed; ++i)
            count(cut.nodes[i], kept_.seen[cut.nodes[i].transform], false, cut);
        for (uint32_t i = edit.begin; i < edit.end; ++i)
            count(fresh_.nodes[i], fresh_.seen[i], true, cut);
    }
    splicer_.replace(edits_, fresh_, cut, kept_);
    if (kinds != tally_.kinds())
        cut.kinds = counts_by_kind(tally_.kinds());
}

}  // namespace lodestone::choose
