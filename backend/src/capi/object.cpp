// SPDX-License-Identifier: GPL-3.0-or-later
// The contents of a model for the C interface: totals, objects, representations, occurrences and
// problems.
#include "capi/guard.h"
#include "capi/handles.h"

#include <algorithm>

using namespace lodestone;
using namespace lodestone::capi;

lds_status lds_model_totals(lds_model* model, lds_totals* out_totals) {
    return guard([&] {
        require(model, "model");
        model->summarize();
        const ModelTotals sums = totals(model->model);
        lds_totals out{};
        for (const ObjectIndex index : bottom_up(model->model))
            out.representations += model->model.objects[index].representations.size();
        out.objects = sums.objects;
        out.occurrences = sums.occurrences;
        out.triangles_placed = sums.triangles_placed;
        out.triangles_unique = sums.triangles_unique;
        hand_out(out_totals, out, "out_totals");
    });
}

size_t lds_model_object_count(const lds_model* model) {
    return model == nullptr ? 0 : model->model.objects.size();
}

lds_status lds_model_object_at(const lds_model* model, size_t position, lds_object* out_object) {
    return guard([&] {
        require(model, "model");
        require(out_object, "out_object");
        if (position >= model->model.objects.size())
            fail(Status::InvalidArgument, "object ", position, " of ", model->model.objects.size());
        *out_object = model->id_of(static_cast<ObjectIndex>(position));
    });
}

lds_status lds_model_find_object(const lds_model* model, const char* uid, lds_object* out_object) {
    return guard([&] {
        require(model, "model");
        require(uid, "uid");
        require(out_object, "out_object");
        const auto at = model->by_uid.find(name_of(uid));
        *out_object = at == model->by_uid.end() ? lds_object{0, 0} : model->id_of(at->second);
    });
}

lds_status lds_model_object_summary(lds_model* model, lds_object object,
                                    lds_object_summary* out_summary) {
    return guard([&] {
        require(model, "model");
        model->summarize();
        const Object& from = model->at(object);
        lds_object_summary out{};
        out.uid = from.uid.c_str();
        out.name = from.name.c_str();
        out.role = static_cast<int32_t>(from.role);
        out.group = from.group() ? 1 : 0;
        out.representation_count = static_cast<uint32_t>(from.representations.size());
        if (from.group())
            out.child_count =
                static_cast<uint32_t>(from.representations[0].assembly().placements.size());
        out.source_hash = from.source_hash;
        if (!from.representations.empty()) {
            copy(from.bound().center, out.center);
            out.radius = from.bound().radius;
        }
        hand_out(out_summary, out, "out_summary");
    });
}

lds_status lds_model_representation(lds_model* model, lds_object object, uint32_t lod,
                                    lds_representation* out_representation) {
    return guard([&] {
        require(model, "model");
        model->summarize();
        const Object& from = model->at(object);
        if (lod >= from.representations.size())
            fail(Status::InvalidArgument, "LOD ", lod, " of '", from.name, "', which has ",
                 from.representations.size());
        const RepresentationSummary& summary = from.representations[lod].summary;
        lds_representation out{};
        out.kind = static_cast<int32_t>(summary.kind);
        out.error = summary.error;
        out.max_error = summary.max_error;
        out.triangles = summary.cost.triangles;
        out.bytes = summary.cost.bytes;
        out.hash = summary.hash;
        hand_out(out_representation, out, "out_representation");
    });
}

lds_status lds_model_occurrence_count(lds_model* model, size_t* out_count) {
    return guard([&] {
        require(model, "model");
        require(out_count, "out_count");
        *out_count = static_cast<size_t>(totals(model->model).occurrences);
    });
}

lds_status lds_model_occurrence_copy(lds_model* model, lds_occurrence* out_occurrences,
                                     size_t capacity) {
    return guard([&] {
        require(model, "model");
        if (capacity > 0)
            require(out_occurrences, "out_occurrences");
        size_t count = 0;
        for_each_occurrence(model->model, [&](const Occurrence& occurrence) {
            if (count >= capacity)
                return;
            out_occurrences[count].object = model->id_of(occurrence.object);
            occurrence.world.to_rows(out_occurrences[count].world);
            ++count;
        });
    });
}

lds_status lds_model_occurrence_hidden(lds_model* model, uint32_t* out_ray_classes,
                                       size_t capacity) {
    return guard([&] {
        require(model, "model");
        if (capacity > 0)
            require(out_ray_classes, "out_ray_classes");
        size_t count = 0;
        for_each_occurrence(model->model, [&](const Occurrence& occurrence) {
            if (count < capacity)
                out_ray_classes[count++] = occurrence.hidden;
        });
    });
}

size_t lds_model_problem_count(const lds_model* model) {
    return model == nullptr ? 0 : model->problems.size();
}

lds_status lds_model_problem(const lds_model* model, size_t position, lds_problem* out_problem) {
    return guard([&] {
        require(model, "model");
        if (position >= model->problems.size())
            fail(Status::InvalidArgument, "problem ", position, " of ", model->problems.size());
        const Problem& problem = model->problems[position];
        lds_problem out{};
        out.object = problem.object.c_str();
        out.severity = static_cast<int32_t>(problem.severity);
        out.code = problem.code.c_str();
        out.message = problem.message.c_str();
        hand_out(out_problem, out, "out_problem");
    });
}
