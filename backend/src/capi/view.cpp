// SPDX-License-Identifier: GPL-3.0-or-later
// Views in the C interface, and all that a picture is taken with: cameras, lights, world.
#include "base/maths.h"
#include "capi/guard.h"
#include "capi/handles.h"

#include <cmath>
#include <numbers>

using namespace lodestone;
using namespace lodestone::capi;

namespace {

double at_least(double value, double least, const char* what) {
    if (!std::isfinite(value) || value < least)
        fail(Status::InvalidArgument, what, " is ", value, "; ", least, " or more expected");
    return value;
}

double between(double value, double least, double most, const char* what) {
    if (!(value >= least && value <= most))
        fail(Status::InvalidArgument, what, " is ", value, "; ", least, " to ", most, " expected");
    return value;
}

Light light_of(const lds_light* light) {
    const lds_light given = checked(light, "light");
    Light out;
    out.name = name_of(given.name);
    if (given.kind < LDS_LIGHT_SUN || given.kind > LDS_LIGHT_AREA)
        fail(Status::InvalidArgument, "light '", out.name, "' has kind ", given.kind,
             "; 0 (sun) to 3 (area) expected");
    out.kind = static_cast<LightKind>(given.kind);
    out.color = vector(given.color, "light.color");
    out.power = given.power;
    out.position = vector(given.position, "light.position");
    out.direction = vector(given.direction, "light.direction");
    out.shadow = given.shadow != 0;
    if (!std::isfinite(out.power))
        fail(Status::InvalidArgument, "light '", out.name, "' has no finite power");
    if (out.kind != LightKind::Point && glm::length(out.direction) == 0)
        fail(Status::InvalidArgument, "light '", out.name, "' has no direction");
    out.radius = at_least(given.radius, 0, "light.radius");
    out.angle = between(given.angle, 0, kPi + 1e-6, "light.angle");
    if (out.kind == LightKind::Spot) {
        out.spot_size = between(given.spot_size, 1e-6, kPi + 1e-6, "light.spot_size");
        out.spot_blend = between(given.spot_blend, 0, 1, "light.spot_blend");
    }
    if (out.kind == LightKind::Area) {
        out.edge_u = vector(given.edge_u, "light.edge_u");
        out.edge_v = vector(given.edge_v, "light.edge_v");
        out.round = given.round != 0;
        out.spread = between(given.spread, 0, kPi + 1e-6, "light.spread");
    }
    return out;
}

}  // namespace

namespace lodestone::capi {

Camera camera_of(const lds_camera* camera) {
    const lds_camera given = checked(camera, "camera");
    Camera out;
    out.name = name_of(given.name);
    out.orthographic = given.orthographic != 0;
    out.position = vector(given.position, "camera.position");
    out.direction = vector(given.direction, "camera.direction");
    out.right = vector(given.right, "camera.right");
    out.up = vector(given.up, "camera.up");
    out.near_clip = given.near_clip;
    if (!(out.near_clip > 0) || !std::isfinite(out.near_clip))
        fail(Status::InvalidArgument, "camera.near_clip is ", given.near_clip,
             "; it must be more than 0");
    if (glm::length(glm::cross(out.right, out.up)) == 0 || glm::length(out.direction) == 0)
        fail(Status::InvalidArgument, "the camera's frame has no area");
    out.focus_distance = at_least(given.focus_distance, 0, "camera.focus_distance");
    out.aperture = at_least(given.aperture, 0, "camera.aperture");
    return out;
}

View view_of(const lds_view* view, const lds_model* model) {
    const lds_view given = checked(view, "view");
    View out;
    out.camera = camera_of(given.camera);
    out.width = given.width;
    out.height = given.height;
    if (out.width < 1 || out.height < 1 || out.width > 65536 || out.height > 65536)
        fail(Status::InvalidArgument, "a picture of ", out.width, " x ", out.height, " pixels");
    out.pixel_error = given.pixel_error;
    if (!(out.pixel_error >= 0) || !std::isfinite(out.pixel_error))
        fail(Status::InvalidArgument, "Pixel Error is ", out.pixel_error, "; it must be 0 or more");
    out.kinds = given.kinds == 0 ? kAllKinds : given.kinds;
    const auto& [left, top, width, height] = given.border;
    if (width != 0) {
        if (left < 0 || top < 0 || width < 1 || height < 1 || left > out.width - width ||
            top > out.height - height)
            fail(Status::InvalidArgument, "the border ", left, ", ", top, ", ", width, " x ",
                 height, " is no part of a picture of ", out.width, " x ", out.height, " pixels");
        out.border = RenderBorder{left, top, width, height};
    }
    if (given.modifiers != nullptr)
        out.modifiers = modifiers_of(given.modifiers, model, out.width, out.height);
    return out;
}

}  // namespace lodestone::capi

lds_status lds_model_add_light(lds_model* model, const lds_light* light) {
    return guard([&] {
        require(model, "model");
        model->model.lights.push_back(light_of(light));
    });
}

lds_status lds_model_add_camera(lds_model* model, const lds_camera* camera) {
    return guard([&] {
        require(model, "model");
        model->model.cameras.push_back(camera_of(camera));
    });
}

lds_status lds_model_set_world(lds_model* model, const lds_world* world) {
    return guard([&] {
        require(model, "model");
        const lds_world given = checked(world, "world");
        World made;
        made.color = vector(given.color, "world.color");
        made.transparent = given.transparent != 0;
        if (given.environment > model->pictures.size())
            fail(Status::InvalidArgument, "world.environment is ", given.environment, " of ",
                 model->pictures.size(), " pictures");
        if (given.environment > 0) {
            made.environment = model->pictures[given.environment - 1];
            made.environment_strength = vector(given.environment_strength, "world.strength");
            glm::dmat3& turn = made.environment_turn;
            for (int row = 0; row < 3; ++row) {
                const glm::dvec3 values =
                    vector(given.environment_turn + size_t{3} * row, "world.turn");
                for (int column = 0; column < 3; ++column)
                    turn[column][row] = values[column];
            }
            if (turn == glm::dmat3(0.0))
                turn = glm::dmat3(1.0);
            if (!(std::abs(glm::determinant(turn)) > 1e-12))
                fail(Status::InvalidArgument, "world.environment_turn flattens directions");
        }
        model->model.world = std::move(made);
    });
}

size_t lds_model_camera_count(const lds_model* model) {
    return model == nullptr ? 0 : model->model.cameras.size();
}

lds_status lds_model_camera(const lds_model* model, size_t position, lds_camera* out_camera) {
    return guard([&] {
        require(model, "model");
        if (position >= model->model.cameras.size())
            fail(Status::InvalidArgument, "camera ", position, " of ", model->model.cameras.size());
        const Camera& camera = model->model.cameras[position];
        lds_camera out{};
        out.name = camera.name.c_str();
        out.orthographic = camera.orthographic ? 1 : 0;
        copy(camera.position, out.position);
        copy(camera.direction, out.direction);
        copy(camera.right, out.right);
        copy(camera.up, out.up);
        out.near_clip = camera.near_clip;
        out.focus_distance = camera.focus_distance;
        out.aperture = camera.aperture;
        hand_out(out_camera, out, "out_camera");
    });
}

size_t lds_model_light_count(const lds_model* model) {
    return model == nullptr ? 0 : model->model.lights.size();
}
