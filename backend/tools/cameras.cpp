// SPDX-License-Identifier: GPL-3.0-or-later
#include "cameras.h"

#include "session.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

namespace lodestone::tools {
namespace {

using Vector = std::array<double, 3>;

/// The width in pixels of a picture without --size.
/// Taste: a larger value makes every trial picture slower.
constexpr int kWidth = 640;
/// The shape of the picture of a camera that the command makes.
/// Taste: most displays have it.
constexpr double kAspect = 16.0 / 9;

Vector vector_of(const std::string& option, const std::string& text) {
    Vector v{};
    char rest = 0;
    if (std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &v[0], &v[1], &v[2], &rest) != 3 ||
        !std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2]))
        throw UsageError("--" + option + " is '" + text + "'; X,Y,Z expected");
    return v;
}

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector scaled(const Vector& v, double factor) {
    return {v[0] * factor, v[1] * factor, v[2] * factor};
}

double length(const Vector& v) {
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

double length(const double v[3]) {
    return length(Vector{v[0], v[1], v[2]});
}

/// A perspective camera at `eye`, Z up.
lds_camera camera_at(const Vector& eye, const Vector& target, double angle_deg, double aspect) {
    Vector direction{target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]};
    if (length(direction) == 0)
        throw UsageError("--eye and --look-at are the same point");
    if (!std::isfinite(length(direction)))
        throw UsageError("--eye is too far from --look-at");
    direction = scaled(direction, 1 / length(direction));
    const Vector world_up = std::abs(direction[2]) > 0.999 ? Vector{0, 1, 0} : Vector{0, 0, 1};
    Vector right = cross(direction, world_up);
    right = scaled(right, 1 / length(right));
    const Vector up = cross(right, direction);
    const double width = 2 * std::tan(angle_deg * std::numbers::pi / 360);
    lds_camera camera{};
    camera.struct_size = sizeof camera;
    camera.near_clip = 0.1;
    for (size_t i = 0; i < 3; ++i) {
        camera.position[i] = eye[i];
        camera.direction[i] = direction[i];
        camera.right[i] = right[i] * width;
        camera.up[i] = up[i] * width / aspect;
    }
    return camera;
}

std::optional<lds_camera> camera_named(const lds_model* model, const std::string* name) {
    const size_t count = lds_model_camera_count(model);
    for (size_t i = 0; i < count; ++i) {
        lds_camera camera{};
        camera.struct_size = sizeof camera;
        check(lds_model_camera(model, i, &camera));
        if (name == nullptr || *name == camera.name)
            return camera;
    }
    if (name != nullptr)
        throw UsageError("there is no camera '" + *name + "' here");
    return std::nullopt;
}

/// The ball around a leaf, in the world; it grows as much as along the most enlarged axis.
struct LeafBall {
    Vector center{};
    double radius = 0;
};

std::vector<LeafBall> balls_of(lds_model* model) {
    size_t count = 0;
    check(lds_model_occurrence_count(model, &count));
    std::vector<lds_occurrence> leaves(count);
    check(lds_model_occurrence_copy(model, leaves.data(), count));
    std::vector<LeafBall> balls;
    for (const lds_occurrence& leaf : leaves) {
        lds_object_summary summary{};
        summary.struct_size = sizeof summary;
        check(lds_model_object_summary(model, leaf.object, &summary));
        LeafBall ball;
        for (size_t i = 0; i < 3; ++i) {
            const double* row = leaf.world + 4 * i;
            ball.center[i] = row[0] * summary.center[0] + row[1] * summary.center[1] +
                             row[2] * summary.center[2] + row[3];
            ball.radius = std::max(ball.radius, summary.radius * length(row));
        }
        balls.push_back(ball);
    }
    return balls;
}

/// A camera that sees everything from the front right above.
lds_camera camera_around(lds_model* model, double angle_deg, double aspect) {
    const std::vector<LeafBall> balls = balls_of(model);
    Vector middle{};
    for (size_t i = 0; i < 3 && !balls.empty(); ++i) {
        double low = balls[0].center[i] - balls[0].radius;
        double high = balls[0].center[i] + balls[0].radius;
        for (const LeafBall& ball : balls) {
            low = std::min(low, ball.center[i] - ball.radius);
            high = std::max(high, ball.center[i] + ball.radius);
        }
        middle[i] = 0.5 * (low + high);
    }
    double radius = 1e-6;
    for (const LeafBall& ball : balls) {
        const Vector away{ball.center[0] - middle[0], ball.center[1] - middle[1],
                          ball.center[2] - middle[2]};
        radius = std::max(radius, length(away) + ball.radius);
    }
    const double half =
        std::atan(std::tan(angle_deg * std::numbers::pi / 360) / std::max(1.0, aspect));
    const Vector back = scaled({0.55, -0.72, 0.42}, radius / std::sin(half));
    Vector eye{};
    for (size_t i = 0; i < 3; ++i)
        eye[i] = middle[i] + back[i];
    lds_camera camera = camera_at(eye, middle, angle_deg, aspect);
    camera.name = "(framing everything)";
    camera.near_clip = 1e-3 * radius;
    return camera;
}

}  // namespace

std::optional<std::pair<int, int>> size_of(const CommandArguments& arguments) {
    const auto text = arguments.text("size");
    if (!text)
        return std::nullopt;
    std::pair<int, int> size;
    char rest = 0;
    if (std::sscanf(text->c_str(), "%dx%d%c", &size.first, &size.second, &rest) != 2 ||
        size.first < 1 || size.second < 1)
        throw UsageError("--size is '" + *text + "'; WxH expected, e.g. 640x360");
    return size;
}

lds_view view_of(const CommandArguments& arguments, lds_model* model, bool frame,
                 lds_camera& camera) {
    const auto size = size_of(arguments);
    const double angle_deg = arguments.number("angle-deg", 50, 0.01, 175);
    const double aspect = size ? static_cast<double>(size->first) / size->second : kAspect;
    const auto eye = arguments.text("eye");
    const auto name = arguments.text("camera");
    lds_view view{};
    view.struct_size = sizeof view;
    view.pixel_error = arguments.number("pixel-error", 1, 0, 1e9);
    const std::optional<lds_camera> own =
        eye ? std::nullopt : camera_named(model, name ? &*name : nullptr);
    if (eye)
        camera = camera_at(vector_of("eye", *eye),
                           vector_of("look-at", arguments.text("look-at").value_or("0,0,0")),
                           angle_deg, aspect);
    else if (own)
        camera = *own;
    else if (frame)
        camera = camera_around(model, angle_deg, aspect);
    else
        throw UsageError("the model has no camera: give --eye X,Y,Z");
    view.camera = &camera;
    const double shape = length(camera.right) / length(camera.up);
    view.width = size ? size->first : kWidth;
    view.height = size ? size->second
                       : static_cast<int>(std::clamp(std::round(kWidth / shape), 1.0, 65536.0));
    for (double& part : camera.up)
        part *= shape * view.height / view.width;
    return view;
}

}  // namespace lodestone::tools
