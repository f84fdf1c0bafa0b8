// SPDX-License-Identifier: GPL-3.0-or-later
#include "capi/handles.h"

#include "base/text.h"
#include "capi/guard.h"
#include "povray_export/scene/povray_costs.h"

#include <atomic>
#include <cmath>

using namespace lodestone;

ObjectIndex lds_model::index_of(lds_object object) const {
    if (object.generation != generation)
        fail(Status::StaleId, object.generation == 0
                                  ? "no object was given"
                                  : "the object belongs to another model or one that is gone");
    if (object.index >= model.objects.size())
        fail(Status::StaleId, "object ", object.index, " of ", model.objects.size());
    return object.index;
}

void lds_model::summarize() {
    if (summarized)
        return;
    summarize_assemblies(model, bottom_up(model));
    summarized = true;
    table.reset();
}

std::shared_ptr<const choose::ChoiceTable> lds_model::table_for(KindMask kinds) {
    summarize();
    if (model.root >= model.objects.size())
        fail(Status::InvalidArgument, "the model has no root object");
    if (!table || table->kinds() != kinds) {
        table.reset();
        table = std::make_shared<const choose::ChoiceTable>(
            choose::ChoiceTable::whole(model, model.root, kinds));
    }
    return table;
}

void lds_model::load(Representation& representation) {
    if (representation.resident())
        return;
    if (!store)
        fail(Status::Internal, "a mesh is neither in memory nor in a store");
    store->load(representation);
}

void lds_model::load_finest() {
    for (const ObjectIndex index : bottom_up(model)) {
        if (!model.objects[index].representations.empty())
            load(model.objects[index].representations[0]);
    }
    load_pictures();
}

void lds_model::load_pictures() {
    if (store)
        store->load_pictures(model);
}

namespace lodestone::capi {

glm::dvec3 vector(const double values[3], const char* what) {
    const glm::dvec3 out(values[0], values[1], values[2]);
    if (!std::isfinite(out.x) || !std::isfinite(out.y) || !std::isfinite(out.z))
        fail(Status::InvalidArgument, what, " is not finite");
    return out;
}

void copy(const glm::dvec3& from, double to[3]) {
    for (int i = 0; i < 3; ++i)
        to[i] = from[i];
}

std::string name_of(const char* text) {
    return text == nullptr ? "" : valid_utf8(text);
}

lds_model* new_model() {
    static std::atomic<uint32_t> generations{0};
    auto model = std::make_unique<lds_model>();
    model->model.costs = povray::povray_costs();
    do {
        model->generation = ++generations;
    } while (model->generation == 0);
    return model.release();
}

}  // namespace lodestone::capi
