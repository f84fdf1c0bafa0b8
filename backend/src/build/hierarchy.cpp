// SPDX-License-Identifier: GPL-3.0-or-later
#include "build/hierarchy.h"

#include "base/clock.h"
#include "base/parallel.h"
#include "build/flatten.h"
#include "build/stand_ins.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <optional>

namespace lodestone::build {
namespace {

// A rough figure for estimates: triangles that one core measures and simplifies in a second.
constexpr double kTrianglesPerSecond = 150000;
constexpr double kSecondsPerObject = 0.02;

/// Finds stored objects by what they were built from.
class Shelf {
public:
    Shelf(const segment::Store& store, bool ignore) {
        if (ignore || !store.exists())
            return;
        try {
            stored_ = store.read();
        } catch (const Error&) {
            return;  // unreadable or of another version: everything is built again
        }
        for (const Object& object : stored_.objects) {
            if (object.build_hash != 0)
                by_hash_.try_emplace(object.build_hash, &object);
        }
    }

    const Object* find(Hash build_hash) const {
        const auto at = by_hash_.find(build_hash);
        return at == by_hash_.end() ? nullptr : at->second;
    }

    const Model& stored() const { return stored_; }

private:
    Model stored_;
    std::map<Hash, const Object*> by_hash_;
};

/// Adds materials once by content; names of the first stay.
class Palette {
public:
    explicit Palette(Model& model) : model_(model) {
        for (uint32_t i = 0; i < model.materials.size(); ++i)
            by_hash_.try_emplace(hash_of(model.materials[i]), i);
    }

    uint32_t index_of(const Material& material) {
        const auto [at, fresh] =
            by_hash_.try_emplace(hash_of(material), static_cast<uint32_t>(model_.materials.size()));
        if (fresh)
            model_.materials.push_back(material);
        return at->second;
    }

private:
    Model& model_;
    std::map<Hash, uint32_t> by_hash_;
};

Hash build_hash_of(const Object& object, Hash settings) {
    return Hasher().value(object.source_hash).value(settings).result();
}

/// Takes over a stored object's stand-ins; its finest representation stays ours.
void adopt(Object& object, const Object& stored, const Model& shelf, Palette& palette) {
    object.build_hash = stored.build_hash;
    object.attributes = stored.attributes;
    for (size_t lod = 1; lod < stored.representations.size(); ++lod) {
        Representation representation = stored.representations[lod];
        for (uint32_t& material : representation.materials)
            material = palette.index_of(shelf.materials.at(material));
        object.representations.push_back(std::move(representation));
    }
}

void add(Object& object, StandIns&& made, Model& model, Palette& palette, Hash build_hash) {
    object.build_hash = build_hash;
    object.attributes = made.attributes;
    for (Candidate& candidate : made.candidates) {
        Representation representation;
        representation.summary.kind = candidate.kind;
        representation.summary.error = candidate.error;
        representation.summary.max_error = candidate.max_error;
        if (candidate.kind == Kind::Mesh)
            representation.payload = std::move(candidate.mesh);
        else
            representation.payload = candidate.primitive;
        for (const Material& material : candidate.materials)
            representation.materials.push_back(palette.index_of(material));
        summarize(representation, model);
        object.representations.push_back(std::move(representation));
    }
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

/// Whether an object may be built: true for everything below the scope, or for all without one.
std::vector<bool> within(const std::vector<ObjectIndex>& scope, const Model& model,
                         const std::vector<ObjectIndex>& order) {
    std::vector<bool> inside(model.objects.size(), scope.empty());
    for (const ObjectIndex index : scope) {
        if (index >= model.objects.size())
            fail(Status::InvalidArgument, "the scope names object ", index, " of ",
                 model.objects.size());
        inside[index] = true;
    }
    for (auto at = order.rbegin(); at != order.rend(); ++at) {  // parents before children
        const Object& object = model.objects[*at];
        if (!inside[*at] || !object.group())
            continue;
        for (const Placement& placement : object.representations[0].assembly().placements)
            inside[placement.object] = true;
    }
    return inside;
}

class Builder {
public:
    Builder(Model& model, const segment::Store& store, const Settings& settings, Problems& problems,
            const Job& job)
        : model_(model),
          store_(store),
          settings_(settings),
          problems_(problems),
          job_(job),
          palette_(model) {}

    Report run() {
        Report report;
        const double wall = wall_seconds();
        const double cpu = cpu_seconds();
        const std::vector<ObjectIndex> order = bottom_up(model_);
        summarize_assemblies(model_, order);
        const Hash settings = hash_of(settings_);
        const Shelf shelf(store_, settings_.rebuild);
        const std::vector<size_t> heights = heights_of(model_, order);
        surroundings_ = {uses_of(model_), with_environment(model_), with_hidden(model_)};
        const std::vector<bool> inside = within(settings_.scope, model_, order);
        const std::vector<uint8_t> deforming = with_deforming(model_);

        std::map<size_t, std::vector<ObjectIndex>> stale;  // by height
        std::map<Hash, ObjectIndex> first_of;              // content-equal objects are built once
        std::vector<std::pair<ObjectIndex, ObjectIndex>> copies;
        for (const ObjectIndex index : order) {
            Object& object = model_.objects[index];
            if (object.representations.empty())
                continue;
            ++report.objects;
            if (deforming[index] != 0)
                continue;
            const Hash wanted = build_hash_of(object, settings);
            const auto first = first_of.find(wanted);
            if (first != first_of.end()) {
                copies.emplace_back(index, first->second);
            } else if (const Object* stored = shelf.find(wanted)) {
                first_of.emplace(wanted, index);
                adopt(object, *stored, shelf.stored(), palette_);
            } else if (inside[index]) {
                first_of.emplace(wanted, index);
                stale[heights[index]].push_back(index);
                ++report.built;
                total_ += weight(object);
                if (!object.group())
                    report.triangles += object.representations[0].summary.cost.triangles;
            }
        }
        for (auto& [height, objects] : stale) {
            // Copies of lower objects must be complete before a group above them is flattened.
            copy_lists(copies, heights, height);
            build(objects, settings);
        }
        copy_lists(copies, heights, model_.objects.size() + 1);
        report.bytes_written = store_.write(model_, job_.part(kBuildShare, 1));
        for (const ObjectIndex index : order)
            report.representations += model_.objects[index].representations.size();
        report.wall_s = wall_seconds() - wall;
        report.cpu_s = cpu_seconds() - cpu;
        return report;
    }

private:
    static constexpr double kBuildShare = 0.92;  // of the bar; the rest is writing

    static double weight(const Object& object) {
        return static_cast<double>(
                   std::min<uint64_t>(object.representations[0].summary.cost.triangles, 60000)) +
               1000;
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
            to.representations.insert(to.representations.end(), from.representations.begin() + 1,
                                      from.representations.end());
            copy = kNoObject;
        }
    }

    void build(std::vector<ObjectIndex>& objects, Hash settings) {
        // Large ones first, so that the last core does not wait for one of them.
        std::stable_sort(objects.begin(), objects.end(), [&](ObjectIndex a, ObjectIndex b) {
            return weight(model_.objects[a]) > weight(model_.objects[b]);
        });
        const MeshSource source = [this](const Representation& representation) {
            if (const auto* held =
                    std::get_if<std::shared_ptr<const Mesh>>(&representation.payload))
                return *held;
            return store_.load_mesh(representation.summary.hash);
        };
        std::vector<std::optional<StandIns>> made(objects.size());
        std::vector<Problems> found(objects.size());
        parallel_for(objects.size(), [&](size_t i) {
            job_.check();
            const Object& object = model_.objects[objects[i]];
            const bool group = object.group();
            job_.stage(group ? Stage::Group : Stage::Simplify);
            try {
                made[i] = group
                              ? stand_ins_of_group(model_, objects[i], surroundings_, settings_,
                                                   source, texels_, job_)
                              : stand_ins_of_leaf(model_, object, settings_, source, texels_, job_);
            } catch (const Error& error) {
                if (error.status == Status::Cancelled || error.status == Status::RaysUnavailable)
                    throw;
                found[i].push_back({object.name, Severity::Warning, "not_simplified",
                                    text("no simpler levels could be made: ", error.what())});
            }
            const double step = weight(object);
            double before = done_.load();
            while (!done_.compare_exchange_weak(before, before + step)) {
            }
            job_.progress(kBuildShare * (before + step) / std::max(1.0, total_));
        });
        for (size_t i = 0; i < objects.size(); ++i) {
            Object& object = model_.objects[objects[i]];
            problems_.insert(problems_.end(), found[i].begin(), found[i].end());
            if (made[i])
                add(object, std::move(*made[i]), model_, palette_, build_hash_of(object, settings));
        }
    }

    Model& model_;
    const segment::Store& store_;
    const Settings& settings_;
    Problems& problems_;
    const Job& job_;
    Palette palette_;
    Surroundings surroundings_;
    image::TexelCache texels_;
    double total_ = 0;
    std::atomic<double> done_{0};
};

}  // namespace

Report estimate(Model& model, const segment::Store& store, const Settings& settings) {
    Report report;
    const std::vector<ObjectIndex> order = bottom_up(model);
    summarize_assemblies(model, order);
    const Shelf shelf(store, settings.rebuild);
    const Hash hash = hash_of(settings);
    const std::vector<bool> inside = within(settings.scope, model, order);
    const std::vector<uint8_t> deforming = with_deforming(model);
    double triangles = 0;
    for (const ObjectIndex index : order) {
        const Object& object = model.objects[index];
        if (object.representations.empty())
            continue;
        ++report.objects;
        if (!inside[index] || deforming[index] != 0 ||
            shelf.find(build_hash_of(object, hash)) != nullptr)
            continue;
        ++report.built;
        const uint64_t own = object.representations[0].summary.cost.triangles;
        if (!object.group())
            report.triangles += own;
        triangles +=
            static_cast<double>(object.group() ? std::min(own, settings.group_triangles) : own);
    }
    report.wall_s =
        (triangles / kTrianglesPerSecond + kSecondsPerObject * static_cast<double>(report.built)) /
        static_cast<double>(hardware_threads());
    return report;
}

Report build_hierarchy(Model& model, const segment::Store& store, const Settings& settings,
                       Problems& problems, const Job& job) {
    // Work on a copy of the lists (payloads are shared), so that a cancelled build changes nothing.
    Model next = model;
    for (Object& object : next.objects) {
        if (object.representations.size() > 1)
            object.representations.resize(1);
        object.build_hash = 0;
    }
    const Report report = Builder(next, store, settings, problems, job).run();
    model = std::move(next);
    return report;
}

}  // namespace lodestone::build
