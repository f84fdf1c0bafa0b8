// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/hierarchy_build.h"

#include "base/clock.h"
#include "base/parallel.h"
#include "hierarchy/object_stand_ins.h"
#include "hierarchy/proposers/followed_levels.h"
#include "hierarchy/run/build_demand.h"
#include "hierarchy/run/build_plan.h"
#include "hierarchy/run/effort_estimate.h"
#include "hierarchy/run/material_palette.h"
#include "hierarchy/run/moved_copies.h"
#include "hierarchy/run/stand_in_surroundings.h"
#include "hierarchy/run/stored_stand_ins.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <optional>
#include <set>
#include <span>

namespace lodestone::hierarchy {
namespace {

constexpr const char* kNotFollowed =
    "drawn as it is: its faces, or what is painted on them, are not those of any frame that levels "
    "are made from";

/// Gives the mesh of a representation of a model, from the store where it is not resident.
MeshSource mesh_source_of(const segment::Store& store) {
    return [&store](const Representation& representation) {
        if (const auto* held = std::get_if<std::shared_ptr<const Mesh>>(&representation.payload))
            return *held;
        return store.load_mesh(representation.summary.hash);
    };
}

void add(Object& object, std::vector<StandInCandidate>&& made, Model& model,
         MaterialPalette& palette, Hash build_hash) {
    object.build_hash = build_hash;
    for (StandInCandidate& candidate : made) {
        Representation representation;
        representation.summary.kind = candidate.kind;
        representation.summary.error = candidate.error;
        representation.summary.max_error = candidate.max_error;
        representation.summary.sealed = candidate.state == CandidateState::Sealed;
        representation.payload = std::move(candidate.payload);
        representation.means = std::move(candidate.means);
        representation.surface = std::move(candidate.surface);
        for (const Material& material : candidate.materials)
            representation.materials.push_back(palette.index_of(material));
        summarize(representation, model);
        object.representations.push_back(std::move(representation));
    }
}

Model without_stand_ins(const Model& model) {
    Model out = model;
    for (Object& object : out.objects) {
        if (object.representations.size() > 1)
            object.representations.resize(1);
        object.build_hash = 0;
        object.bind_hash = 0;
        object.sources.clear();
    }
    return out;
}

/// Length of the longest way down to a leaf: groups of one height do not depend on each other.
std::vector<size_t> heights_of(const Model& model, const std::vector<ObjectIndex>& order) {
    std::vector<size_t> heights(model.objects.size(), 0);
    for (const ObjectIndex index : order) {
        if (!model.objects[index].group())
            continue;
        for (const Placement& placement :
             model.objects[index].representations[0].assembly().placements)
            heights[index] = std::max(heights[index], heights[placement.object] + 1);
    }
    return heights;
}

/// An object that deforms, and what its levels come from.
struct FollowingObject {
    ObjectIndex index;
    PoseBinding bind;
};

class HierarchyBuilder {
public:
    HierarchyBuilder(Model& model, const segment::Store& store, const BuildSettings& settings,
                     Problems& problems, const Job& job)
        : model_(model),
          store_(store),
          settings_(settings),
          problems_(problems),
          job_(job),
          palette_(model) {}

    BuildReport run() {
        BuildReport report;
        const double wall = wall_seconds();
        const double cpu = cpu_seconds();
        const std::vector<ObjectIndex> order = bottom_up(model_);
        for (const ObjectIndex index : order) {  // of an earlier build
            std::vector<Representation>& own = model_.objects[index].representations;
            own.resize(std::min<size_t>(own.size(), 1));
            for (Representation& finest : own)
                finest.surface = nullptr;
        }
        summarize_assemblies(model_, order);
        const StoredStandIns shelf(store_, settings_.rebuild);
        const std::vector<size_t> heights = heights_of(model_, order);
        surroundings_ = surroundings_of(model_, order, mesh_source(), job_);
        BuildPlan plan = plan_build(model_, order, surroundings_, shelf, palette_, settings_);
        report.objects = plan.objects;
        for (const ObjectIndex index : plan.not_followed)
            problems_.push_back(
                {model_.objects[index].name, Severity::Info, "not_followed", kNotFollowed});
        if (!plan.tasks.empty())
            store_.load_pictures(model_);  // those of cards, which groups above are flattened with
        wanted_ = std::move(plan.wanted);

        std::vector<BuildTask>& tasks = plan.tasks;
        const size_t all = stale_in(tasks);
        if (settings_.demand)
            keep_called_for(tasks);
        report.left = all - stale_in(tasks);

        std::map<size_t, std::vector<ObjectIndex>> stale;  // by height
        std::map<size_t, std::vector<MovedCopy>> moved;    // likewise
        std::vector<std::pair<ObjectIndex, ObjectIndex>> copies;
        const auto count = [&](ObjectIndex index) {
            ++report.built;
            total_ += weight(model_.objects[index]);
        };
        for (const MovedCopy& one : plan.moved)
            count(one.index);
        for (BuildTask& task : tasks) {
            for (const ObjectIndex copy : task.copies)
                copies.emplace_back(copy, task.index);
            for (const MovedCopy& one : task.moved) {
                moved[heights[task.index]].push_back(one);
                count(one.index);
            }
            if (task.bind) {
                following_.push_back({task.index, *task.bind});
                continue;
            }
            const Object& object = model_.objects[task.index];
            stale[heights[task.index]].push_back(task.index);
            count(task.index);
            if (!object.group())
                report.triangles += object.representations[0].summary.cost.triangles;
        }
        follow(report);
        for (const MovedCopy& one : plan.moved)
            finish(one);
        for (auto& [height, objects] : stale) {
            // Copies of lower objects must be complete before a group above them is flattened.
            copy_lists(copies, heights, height);
            build(objects);
            for (const MovedCopy& one : moved[height])
                finish(one);
        }
        copy_lists(copies, heights, model_.objects.size() + 1);
        palette_.renumber(order);
        report.bytes_written += kept_bytes_ + put(job_.part(kBuildShare, 1));
        for (const ObjectIndex index : order)
            report.representations += model_.objects[index].representations.size();
        report.wall_s = wall_seconds() - wall;
        report.cpu_s = cpu_seconds() - cpu;
        return report;
    }

private:
    // The share of the progress bar that is building; writing has all else.
    // Taste: a larger value lets the bar wait longer at its end.
    static constexpr double kBuildShare = 0.92;

    static double weight(const Object& object) {
        return static_cast<double>(
                   std::min<uint64_t>(object.representations[0].summary.cost.triangles, 60000)) +
               1000;
    }

    /// How many objects and groups are built for themselves or as others moved.
    static size_t stale_in(const std::vector<BuildTask>& tasks) {
        size_t count = tasks.size();
        for (const BuildTask& task : tasks)
            count += task.moved.size();
        return count;
    }

    /// Leaves what a demand does not call for as it is.
    void keep_called_for(std::vector<BuildTask>& tasks) const {
        std::vector<StaleObject> stale(tasks.begin(), tasks.end());
        for (size_t i = 0; i < tasks.size(); ++i) {
            for (const MovedCopy& one : tasks[i].moved)
                stale[i].copies.push_back(one.index);
        }
        const std::vector<uint8_t> called = select_demanded(model_, stale, settings_, job_);
        size_t kept = 0;
        for (size_t i = 0; i < tasks.size(); ++i) {
            if (called[i] != 0)
                std::swap(tasks[kept++], tasks[i]);
        }
        tasks.resize(kept);
    }

    void copy_lists(std::vector<std::pair<ObjectIndex, ObjectIndex>>& copies,
                    const std::vector<size_t>& heights, size_t below) {
        for (auto& [copy, original] : copies) {
            if (copy == kNoObject || heights[copy] >= below)
                continue;
            Object& to = model_.objects[copy];
            const Object& from = model_.objects[original];
            to.attributes = from.attributes;
            to.build_hash = from.build_hash;
            to.bind_hash = from.bind_hash;
            to.sources = from.sources;
            to.representations.insert(to.representations.end(), from.representations.begin() + 1,
                                      from.representations.end());
            copy = kNoObject;
        }
    }

    MeshSource mesh_source() const { return mesh_source_of(store_); }

    /// The problem of one object; throws on what concerns all of them.
    static Problem not_simplified(const Object& object, const Error& error) {
        if (error.status == Status::Cancelled || error.status == Status::RaysUnavailable)
            throw Error(error);
        return {object.name, Severity::Warning, "not_simplified",
                text("no simpler levels could be made: ", error.what())};
    }

    void advance(double step) {
        double before = done_.load();
        while (!done_.compare_exchange_weak(before, before + step)) {
        }
        job_.progress(share_done(before + step));
    }

    double share_done(double done) const { return kBuildShare * done / std::max(1.0, total_); }

    /// Puts what is finished into the store.
    uint64_t put(const Job& job) {
        return store_.write(model_, job,
                            settings_.of_one_frame ? segment::StoreUpdate::Objects
                                                   : segment::StoreUpdate::Anything);
    }

    /// Does so when it is time to; the bar stays where it is.
    void keep_when_due() {
        if (wall_seconds() - kept_at_ < settings_.keep_every_s)
            return;
        const double share = share_done(done_.load());
        kept_bytes_ += put(job_.part(share, share));
        kept_at_ = wall_seconds();
    }

    /// Treats objects that deform: their levels are collapsed where that has not been done yet, and
    /// moved to the pose that the object has now.
    void follow(BuildReport& report) {
        std::map<Hash, segment::BoundLevels> levels;
        std::vector<const FollowingObject*> missing;
        for (const FollowingObject& one : following_) {
            const auto [at, fresh] = levels.try_emplace(one.bind.hash);
            if (!fresh)
                continue;
            auto stored = settings_.rebuild ? std::nullopt : store_.load_bound(one.bind.hash);
            if (stored)
                at->second = std::move(*stored);
            else
                missing.push_back(&one);
        }
        for (const FollowingObject* one : missing) {
            ++report.built;
            const Object& object = model_.objects[one->index];
            report.triangles += object.representations[0].summary.cost.triangles;
            total_ += weight(object);
        }
        std::vector<std::optional<segment::BoundLevels>> made(missing.size());
        std::vector<Problems> found(std::max(missing.size(), following_.size()));
        const MeshSource source = mesh_source();
        parallel_for(missing.size(), [&](size_t i) {
            job_.check();
            job_.stage(JobStage::Simplify);
            const Object& object = model_.objects[missing[i]->index];
            try {
                made[i] = bound_levels_of_leaf(missing[i]->bind, settings_, source, texels_, job_);
            } catch (const Error& error) {
                found[i].push_back(not_simplified(object, error));
            }
            advance(weight(object));
        });
        for (size_t i = 0; i < missing.size(); ++i) {
            if (!made[i])
                continue;
            report.bytes_written += store_.save_bound(missing[i]->bind.hash, *made[i]);
            levels[missing[i]->bind.hash] = std::move(*made[i]);
        }
        std::vector<std::vector<StandInCandidate>> followed(following_.size());
        parallel_for(following_.size(), [&](size_t i) {
            job_.check();
            const Object& object = model_.objects[following_[i].index];
            try {
                followed[i] =
                    followed_levels(model_, object, levels.at(following_[i].bind.hash), job_);
            } catch (const Error& error) {
                found[i].push_back(not_simplified(object, error));
            }
        });
        for (size_t i = 0; i < following_.size(); ++i) {
            Object& object = model_.objects[following_[i].index];
            object.bind_hash = following_[i].bind.hash;
            add(object, std::move(followed[i]), model_, palette_, wanted_[following_[i].index]);
        }
        for (const Problems& problems : found)
            problems_.insert(problems_.end(), problems.begin(), problems.end());
    }

    /// All objects of one height.
    void build(std::vector<ObjectIndex>& objects) {
        // Large ones first, so that the last core does not wait for one of them.
        std::stable_sort(objects.begin(), objects.end(), [&](ObjectIndex a, ObjectIndex b) {
            return weight(model_.objects[a]) > weight(model_.objects[b]);
        });
        std::span<const ObjectIndex> left = objects;
        while (!left.empty()) {
            const size_t count = count_until_kept(left);
            build_all(left.first(count));
            left = left.subspan(count);
            keep_when_due();
        }
    }

    /// How many are built before what is finished is kept: at least one.
    size_t count_until_kept(std::span<const ObjectIndex> objects) const {
        double seconds = settings_.keep_every_s * hardware_threads();
        size_t count = 0;
        do {
            seconds -= seconds_to_build(model_.objects[objects[count++]], settings_);
        } while (count < objects.size() && seconds > 0);
        return count;
    }

    /// Finishes a group that is another one moved, once that is built.
    void finish(const MovedCopy& moved) {
        if (model_.objects[moved.original].build_hash != 0) {
            add_moved_copy(model_, moved, mesh_source());
            model_.objects[moved.index].build_hash = wanted_[moved.index];
        }
        advance(weight(model_.objects[moved.index]));
    }

    void build_all(std::span<const ObjectIndex> objects) {
        const MeshSource source = mesh_source();
        std::vector<std::optional<StandIns>> made(objects.size());
        std::vector<Problems> found(objects.size());
        parallel_for(objects.size(), [&](size_t i) {
            job_.check();
            const Object& object = model_.objects[objects[i]];
            const bool group = object.group();
            job_.stage(group ? JobStage::Group : JobStage::Simplify);
            try {
                made[i] = group ? stand_ins_of_group(model_, objects[i], surroundings_, settings_,
                                                     source, texels_, job_)
                                : stand_ins_of_leaf(model_, objects[i], surroundings_, settings_,
                                                    source, texels_, job_);
            } catch (const Error& error) {
                found[i].push_back(not_simplified(object, error));
            }
            advance(weight(object));
        });
        for (size_t i = 0; i < objects.size(); ++i) {
            Object& object = model_.objects[objects[i]];
            problems_.insert(problems_.end(), found[i].begin(), found[i].end());
            if (!made[i])
                continue;
            object.attributes = made[i]->attributes;
            object.sources = std::move(made[i]->sources);
            object.representations[0].surface = std::move(made[i]->surface);
            for (SourceMaterial& one : object.sources)  // as it is when read from the store
                one.material = palette_.index_of(model_.materials.at(one.material));
            add(object, std::move(made[i]->candidates), model_, palette_, wanted_[objects[i]]);
        }
    }

    Model& model_;
    const segment::Store& store_;
    const BuildSettings& settings_;
    Problems& problems_;
    const Job& job_;
    MaterialPalette palette_;
    std::vector<Hash> wanted_;  // build hashes, by object
    std::vector<FollowingObject> following_;
    StandInSurroundings surroundings_;
    image::TexelCache texels_;
    double total_ = 0;
    std::atomic<double> done_{0};
    double kept_at_ = wall_seconds();
    uint64_t kept_bytes_ = 0;
};

}  // namespace

BuildReport estimate_build(Model& given, const segment::Store& store,
                           const BuildSettings& settings) {
    BuildReport report;
    const std::vector<ObjectIndex> order = bottom_up(given);
    summarize_assemblies(given, order);
    Model model = without_stand_ins(given);
    MaterialPalette palette(model);
    const StoredStandIns shelf(store, settings.rebuild);
    const StandInSurroundings surroundings =
        surroundings_of(model, order, mesh_source_of(store), {});
    const BuildPlan plan = plan_build(model, order, surroundings, shelf, palette, settings);
    report.objects = plan.objects;
    std::set<Hash> binds;  // counted already
    double seconds = 0;
    for (const BuildTask& task : plan.tasks) {
        if (task.bind && (!binds.insert(task.bind->hash).second ||
                          (!settings.rebuild && store.load_bound(task.bind->hash))))
            continue;
        const Object& object = model.objects[task.index];
        ++report.built;
        if (!object.group())
            report.triangles += object.representations[0].summary.cost.triangles;
        report.built += task.moved.size();
        seconds += seconds_to_build(object, settings);
    }
    report.built += plan.moved.size();
    report.wall_s = seconds / static_cast<double>(hardware_threads());
    return report;
}

BuildReport build_hierarchy(Model& model, const segment::Store& store,
                            const BuildSettings& settings, Problems& problems, const Job& job) {
    // Work on a copy of the lists (payloads are shared), so that a cancelled build changes nothing.
    Model next = without_stand_ins(model);
    const BuildReport report = HierarchyBuilder(next, store, settings, problems, job).run();
    model = std::move(next);
    return report;
}

}  // namespace lodestone::hierarchy
