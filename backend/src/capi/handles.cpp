// SPDX-License-Identifier: GPL-3.0-or-later
#include "capi/handles.h"

#include "base/text.h"
#include "capi/guard.h"

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

Camera camera_of(const lds_camera& camera) {
    Camera out;
    out.name = name_of(camera.name);
    out.orthographic = camera.orthographic != 0;
    out.position = vector(camera.position, "camera.position");
    out.direction = vector(camera.direction, "camera.direction");
    out.right = vector(camera.right, "camera.right");
    out.up = vector(camera.up, "camera.up");
    out.near_clip = camera.near_clip;
    if (!(out.near_clip > 0) || !std::isfinite(out.near_clip))
        fail(Status::InvalidArgument, "camera.near_clip is ", camera.near_clip,
             "; it must be more than 0");
    if (glm::length(glm::cross(out.right, out.up)) == 0 || glm::length(out.direction) == 0)
        fail(Status::InvalidArgument, "the camera's frame has no area");
    return out;
}

lds_camera camera_of(const Camera& camera) {
    lds_camera out{};
    out.struct_size = sizeof out;
    out.name = camera.name.c_str();
    out.orthographic = camera.orthographic ? 1 : 0;
    copy(camera.position, out.position);
    copy(camera.direction, out.direction);
    copy(camera.right, out.right);
    copy(camera.up, out.up);
    out.near_clip = camera.near_clip;
    return out;
}

View view_of(const lds_view* view) {
    const lds_view& given = checked(view, "view");
    View out;
    out.camera = camera_of(given.camera);
    out.width = given.width;
    out.height = given.height;
    if (out.width < 1 || out.height < 1 || out.width > 65536 || out.height > 65536)
        fail(Status::InvalidArgument, "a picture of ", out.width, " x ", out.height, " pixels");
    out.pixel_error = given.pixel_error;
    if (!(out.pixel_error >= 0) || !std::isfinite(out.pixel_error))
        fail(Status::InvalidArgument, "Pixel Error is ", given.pixel_error,
             "; it must be 0 or more");
    out.kinds = given.kinds == 0 ? kAllKinds : given.kinds;
    return out;
}

lds_model* new_model() {
    static std::atomic<uint32_t> generations{0};
    auto model = std::make_unique<lds_model>();
    do {
        model->generation = ++generations;
    } while (model->generation == 0);
    return model.release();
}

}  // namespace lodestone::capi
