// SPDX-License-Identifier: GPL-3.0-or-later
// Finding out how a cut draws a thing.
#include "capi/chosen.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "choose/find_choice.h"

using namespace lodestone;
using namespace lodestone::capi;

lds_status lds_cut_find_choice(lds_model* model, const lds_cut* cut, lds_object object,
                               const double world[12], int32_t* out_drawn, size_t* out_position) {
    return guard([&] {
        require(model, "model");
        require(cut, "cut");
        require(world, "world");
        require(out_drawn, "out_drawn");
        require(out_position, "out_position");
        require_current(*model, *cut);
        const ObjectIndex index = model->index_of(object);
        const Affine place = Affine::from_rows(world);
        if (!place.finite())
            fail(Status::InvalidArgument, "world is not finite");
        const choose::FoundChoice found = choose::find_choice(model->model, cut->cut, index, place);
        *out_drawn = static_cast<int32_t>(found.drawn);
        if (found.drawn != choose::DrawnState::Itself && found.drawn != choose::DrawnState::InGroup)
            return;
        const auto at =
            std::lower_bound(cut->cut.chosen.begin(), cut->cut.chosen.end(), found.node);
        *out_position = static_cast<size_t>(at - cut->cut.chosen.begin());
    });
}

lds_status lds_model_most_demanding(lds_model* model, lds_object group, const char** out_path) {
    return guard([&] {
        require(model, "model");
        require(out_path, "out_path");
        model->summarize();
        thread_local std::string path;
        path = choose::most_demanding(model->model, model->index_of(group));
        *out_path = path.c_str();
    });
}

lds_status lds_model_release_meshes(lds_model* model) {
    return guard([&] {
        require(model, "model");
        if (!model->store)
            return;
        for (Object& object : model->model.objects) {
            for (Representation& representation : object.representations) {
                if (representation.summary.kind == Kind::Mesh && representation.resident() &&
                    model->store->has_mesh(representation.summary.hash))
                    representation.payload = std::monostate();
            }
        }
    });
}
