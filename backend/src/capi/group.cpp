// SPDX-License-Identifier: GPL-3.0-or-later
// Groups in the C interface: making them, placing objects in them, structuring them.
#include "capi/guard.h"
#include "capi/handles.h"
#include "group/position.h"

#include <algorithm>
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
                                    const lds_object* children, const double* transforms,
                                    const char* const* names, const uint32_t* hidden) {
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
            added.push_back(placement_of(*model, children[i], transforms + 12 * i, names[i]));
            if (hidden != nullptr)
                added.back().hidden = ray_mask(hidden[i]);
        }
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

lds_status lds_model_group_by_position(lds_model* model, lds_object group, uint32_t most_children,
                                       size_t* out_added) {
    return guard([&] {
        require(model, "model");
        const ObjectIndex index = model->index_of(group);
        const size_t before = model->model.objects.size();
        const size_t added = group::group_by_position(model->model, index, most_children);
        for (size_t i = before; i < model->model.objects.size(); ++i)
            model->by_uid.emplace(model->model.objects[i].uid, static_cast<uint32_t>(i));
        if (added > 0)
            model->summarized = false;
        if (out_added != nullptr)
            *out_added = added;
    });
}
