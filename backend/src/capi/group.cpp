// SPDX-License-Identifier: GPL-3.0-or-later
// Groups in the C interface: making them, placing objects in them, structuring them.
#include "base/clock.h"
#include "base/parallel.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "group/group_structure.h"
#include "group/loose_parts.h"
#include "group/position_groups.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>

using namespace lodestone;
using namespace lodestone::capi;

namespace {

/// A group's assembly, to change it. Assemblies are const to guard sharing; all were made as
/// Assembly, and one that is shared is copied first.
Assembly& own_assembly(Object& group) {
    auto& held = std::get<std::shared_ptr<const Assembly>>(group.representations[0].payload);
    if (held.use_count() != 1)
        held = std::make_shared<Assembly>(*held);
    return const_cast<Assembly&>(*held);
}

Assembly& group_at(lds_model& model, lds_object group) {
    Object& into = model.at(group);
    if (!into.group())
        fail(Status::InvalidArgument, "'", into.name, "' is not a group");
    return own_assembly(into);
}

Placement placement_of(const lds_model& model, lds_object child, const double* transform,
                       const char* name) {
    Placement placement;
    placement.object = model.index_of(child);
    placement.transform = Affine::from_rows(transform);
    placement.name = name_of(name);
    if (!placement.transform.finite())
        fail(Status::InvalidArgument, "the transform of '", placement.name,
             "' holds numbers that are not finite");
    return placement;
}

/// Objects that were added from `first` on can be found by their uids, too.
void list_new(lds_model& model, size_t first) {
    for (size_t i = first; i < model.model.objects.size(); ++i)
        model.by_uid.emplace(model.model.objects[i].uid, static_cast<uint32_t>(i));
    if (first < model.model.objects.size()) {
        model.summarized = false;
        ++model.structured;
    }
}

group::StructureOptions structure_options(const lds_structure_options* given) {
    const lds_structure_options options = checked(given, "options");
    if (options.fewest_children < 2)
        fail(Status::InvalidArgument, "fewest_children is ", options.fewest_children,
             "; 2 or more expected");
    if (options.orders < 1 || options.orders > 1024)
        fail(Status::InvalidArgument, "orders is ", options.orders, "; 1 to 1024 expected");
    if (!(options.similarity >= 0 && options.similarity <= 1e6))
        fail(Status::InvalidArgument, "similarity is ", options.similarity,
             "; 0 to 1,000,000 expected");
    if (!(options.group_cost >= 0 && options.group_cost <= 1e6))
        fail(Status::InvalidArgument, "group_cost is ", options.group_cost,
             "; 0 to 1,000,000 expected");
    group::StructureOptions out;
    out.fewest = options.fewest_children;
    out.most = options.most_children;
    out.orders = options.orders;
    out.similarity = options.similarity;
    out.group_cost = options.group_cost;
    out.seed = options.seed;
    return out;
}

RayMask ray_mask(uint32_t ray_classes) {
    if (ray_classes > kAllRays)
        fail(Status::InvalidArgument, "ray classes ", ray_classes, " are unknown");
    return static_cast<RayMask>(ray_classes);
}

}  // namespace

lds_status lds_model_add_group(lds_model* model, const lds_object_info* info,
                               lds_object* out_object) {
    return guard([&] {
        require(model, "model");
        require(out_object, "out_object");
        Representation finest;
        finest.summary.kind = Kind::Assembly;
        finest.payload = std::shared_ptr<const Assembly>(std::make_shared<Assembly>());
        *out_object = model->id_of(add_object(*model, info, std::move(finest)));
    });
}

lds_status lds_model_add_placement(lds_model* model, lds_object group, lds_object child,
                                   const double transform[12], const char* name) {
    return guard([&] {
        require(model, "model");
        require(transform, "transform");
        Assembly& into = group_at(*model, group);
        into.placements.push_back(placement_of(*model, child, transform, name));
        model->summarized = false;
    });
}

lds_status lds_model_add_placements(lds_model* model, lds_object group, size_t count,
                                    const lds_object* children, const float* transforms,
                                    const char* names, const uint32_t* hidden) {
    return guard([&] {
        require(model, "model");
        Assembly& into = group_at(*model, group);
        if (count == 0)
            return;
        require(children, "children");
        require(transforms, "transforms");
        require(names, "names");
        std::vector<Placement> added;
        added.reserve(count);
        for (size_t i = 0; i < count; ++i) {
            std::array<double, 12> rows{};
            std::copy_n(transforms + 12 * i, rows.size(), rows.begin());
            added.push_back(placement_of(*model, children[i], rows.data(), names));
            names += std::strlen(names) + 1;
            if (hidden != nullptr)
                added.back().hidden = ray_mask(hidden[i]);
        }
        if (into.placements.empty())
            into.placements = std::move(added);
        else
            std::move(added.begin(), added.end(), std::back_inserter(into.placements));
        model->summarized = false;
    });
}

lds_status lds_model_hide_placement(lds_model* model, lds_object group, uint32_t ray_classes) {
    return guard([&] {
        require(model, "model");
        Object& into = model->at(group);
        const RayMask mask = ray_mask(ray_classes);
        if (!into.group() || into.representations[0].assembly().placements.empty())
            fail(Status::InvalidArgument, "'", into.name, "' places nothing");
        own_assembly(into).placements.back().hidden = mask;
        model->summarized = false;
    });
}

lds_status lds_model_decide_placement(lds_model* model, lds_object group, size_t position,
                                      double importance, uint32_t coarsest) {
    return guard([&] {
        require(model, "model");
        if (!(importance >= 1 / kMostImportance && importance <= kMostImportance))
            fail(Status::InvalidArgument, "an importance of ", importance, "; 1/64 to 64 expected");
        std::vector<Placement>& placements = group_at(*model, group).placements;
        if (position >= placements.size())
            fail(Status::InvalidArgument, "child ", position, " of ", placements.size());
        placements[position].importance = importance;
        placements[position].coarsest = coarsest;
        placements[position].finest = 0;
        model->summarized = false;
    });
}

lds_status lds_model_pin_placement(lds_model* model, lds_object group, size_t position,
                                   uint32_t lod) {
    return guard([&] {
        require(model, "model");
        std::vector<Placement>& placements = group_at(*model, group).placements;
        if (position >= placements.size())
            fail(Status::InvalidArgument, "child ", position, " of ", placements.size());
        placements[position].coarsest = lod;
        placements[position].finest = lod == kAnyLevel ? 0 : lod;
        model->summarized = false;
    });
}

lds_status lds_model_change_placement(lds_model* model, lds_object group, size_t position,
                                      const double transform[12], uint32_t hidden) {
    return guard([&] {
        require(model, "model");
        std::vector<Placement>& placements = group_at(*model, group).placements;
        if (position >= placements.size())
            fail(Status::InvalidArgument, "child ", position, " of ", placements.size());
        const RayMask mask = ray_mask(hidden);
        Placement& placement = placements[position];
        if (transform != nullptr) {
            const Affine there = Affine::from_rows(transform);
            if (!there.finite())
                fail(Status::InvalidArgument, "the transform of '", placement.name,
                     "' holds numbers that are not finite");
            placement.transform = there;
        }
        placement.hidden = mask;
        // No level is as coarse: nothing but the groups around it is limited by that.
        placement.coarsest = std::min(placement.coarsest, kAnyLevel - 1);
        model->summarized = false;
    });
}

lds_status lds_model_move_placement(lds_model* model, lds_object group, size_t position,
                                    const double closing[12]) {
    return guard([&] {
        require(model, "model");
        std::vector<Placement>& placements = group_at(*model, group).placements;
        if (position >= placements.size())
            fail(Status::InvalidArgument, "child ", position, " of ", placements.size());
        if (closing == nullptr) {
            placements[position].closing = nullptr;
            return;
        }
        const Affine there = Affine::from_rows(closing);
        if (!there.finite())
            fail(Status::InvalidArgument, "the transform to which child ", position,
                 " moves is not finite");
        placements[position].closing = std::make_shared<const Affine>(there);
    });
}

lds_status lds_model_group_by_position(lds_model* model, lds_object group, uint32_t most_children,
                                       size_t* out_added) {
    return guard([&] {
        require(model, "model");
        const ObjectIndex index = model->index_of(group);
        const size_t before = model->model.objects.size();
        const size_t added = group::group_by_position(model->model, index, most_children);
        list_new(*model, before);
        if (out_added != nullptr)
            *out_added = added;
    });
}

lds_status lds_structure_options_default(lds_structure_options* options) {
    return guard([&] {
        const group::StructureOptions defaults;
        lds_structure_options out{};
        out.fewest_children = static_cast<uint32_t>(defaults.fewest);
        out.most_children = static_cast<uint32_t>(defaults.most);
        out.orders = defaults.orders;
        out.similarity = defaults.similarity;
        out.group_cost = defaults.group_cost;
        out.seed = defaults.seed;
        hand_out(options, out, "options");
    });
}

lds_status lds_model_structure(lds_model* model, const lds_object* groups, size_t group_count,
                               const lds_structure_options* options, lds_job* job,
                               lds_structure_report* out_report) {
    return guard([&] {
        require(model, "model");
        known_bytes(out_report, "out_report");
        const group::StructureOptions given = structure_options(options);
        const ThreadLimit limit(options->threads);
        std::vector<ObjectIndex> wanted;
        if (groups == nullptr)
            wanted = group::flat_groups(model->model, given.fewest);
        for (size_t i = 0; groups != nullptr && i < group_count; ++i)
            wanted.push_back(model->index_of(groups[i]));
        const double cpu = cpu_seconds();
        const size_t before = model->model.objects.size();
        const group::StructureReport made =
            group::structure_groups(model->model, wanted, given, job_of(job));
        list_new(*model, before);
        lds_structure_report report{};
        report.structured = made.structured;
        report.made = made.made;
        report.cost_before = made.cost_before;
        report.cost_after = made.cost_after;
        report.cpu_s = cpu_seconds() - cpu;
        hand_out(out_report, report, "out_report");
    });
}

lds_status lds_loose_options_default(lds_loose_options* options) {
    return guard([&] {
        const group::LooseOptions defaults;
        lds_loose_options out{};
        out.fewest_triangles = static_cast<uint32_t>(defaults.fewest_triangles);
        out.most_clusters = static_cast<uint32_t>(defaults.most_clusters);
        hand_out(options, out, "options");
    });
}

lds_status lds_model_split_loose_parts(lds_model* model, const lds_object* objects,
                                       size_t object_count, const lds_loose_options* options,
                                       lds_job* job, lds_loose_report* out_report) {
    return guard([&] {
        require(model, "model");
        known_bytes(out_report, "out_report");
        const lds_loose_options given = checked(options, "options");
        if (given.fewest_triangles < 1 || given.most_clusters < 2)
            fail(Status::InvalidArgument, "clusters of ", given.fewest_triangles,
                 " triangles, at most ", given.most_clusters, "; 1 and 2 or more expected");
        const ThreadLimit limit(given.threads);
        std::vector<ObjectIndex> wanted;
        if (objects == nullptr)
            wanted = group::leaves_of(model->model);
        for (size_t i = 0; objects != nullptr && i < object_count; ++i)
            wanted.push_back(model->index_of(objects[i]));
        group::LooseOptions loose;
        loose.always = given.always != 0;
        loose.fewest_triangles = given.fewest_triangles;
        loose.most_clusters = given.most_clusters;
        const double cpu = cpu_seconds();
        for (const ObjectIndex index : wanted) {  // else what a store holds stays as it is
            Object& object = model->model.objects[index];
            if (loose.always && !object.representations.empty() && !object.group())
                model->load(object.representations[0]);
        }
        const size_t before = model->model.objects.size();
        const group::LooseReport made =
            group::split_loose_parts(model->model, wanted, loose, job_of(job));
        list_new(*model, before);
        lds_loose_report report{};
        report.split = made.split;
        report.parts = made.parts;
        report.made = made.made;
        report.cpu_s = cpu_seconds() - cpu;
        hand_out(out_report, report, "out_report");
    });
}

lds_status lds_model_child(const lds_model* model, lds_object group, size_t position,
                           lds_placement* out_placement) {
    return guard([&] {
        require(model, "model");
        const Object& from = model->model.objects[model->index_of(group)];
        if (!from.group())
            fail(Status::InvalidArgument, "'", from.name, "' is not a group");
        const std::vector<Placement>& placements = from.representations[0].assembly().placements;
        if (position >= placements.size())
            fail(Status::InvalidArgument, "child ", position, " of ", placements.size());
        const Placement& placement = placements[position];
        lds_placement out{};
        out.object = model->id_of(placement.object);
        placement.transform.to_rows(out.transform);
        out.name = placement.name.c_str();
        out.hidden = placement.hidden;
        out.coarsest = placement.coarsest;
        out.importance = placement.importance;
        hand_out(out_placement, out, "out_placement");
    });
}
