// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/gltf/gltf_view.h"

#include "base/maths.h"
#include "base/text.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone::format {
namespace {

// Law: the luminous efficacy of 540 THz, which defines the candela (SI).
constexpr double kLumenPerWatt = 683;
// The width over the height where a camera leaves it open.
// Taste: that of most pictures; a larger value shows more at both sides.
constexpr double kAspect = 16.0 / 9;

bool positive(double value) {
    return std::isfinite(value) && value > 0;
}

/// glTF's -Z, +X and +Y of a node, in our frame and of length 1; false when one is lost.
bool axes_of(const Affine& world, glm::dvec3& ahead, glm::dvec3& right, glm::dvec3& up) {
    ahead = world.linear * glm::dvec3(0, 1, 0);
    right = world.linear * glm::dvec3(1, 0, 0);
    up = world.linear * glm::dvec3(0, 0, 1);
    for (glm::dvec3* axis : {&ahead, &right, &up}) {
        const double length = glm::length(*axis);
        if (!positive(length))
            return false;
        *axis /= length;
    }
    return world.finite();
}

bool read_camera(const tinygltf::Camera& from, const Affine& world, Camera& camera) {
    glm::dvec3 ahead;
    glm::dvec3 right;
    glm::dvec3 up;
    if (!axes_of(world, ahead, right, up))
        return false;
    double width = 0;
    double height = 0;
    camera.orthographic = from.type == "orthographic";
    if (camera.orthographic) {
        width = 2 * std::abs(from.orthographic.xmag);
        height = 2 * std::abs(from.orthographic.ymag);
        camera.near_clip = from.orthographic.znear;
    } else {
        const double aspect =
            positive(from.perspective.aspectRatio) ? from.perspective.aspectRatio : kAspect;
        height = 2 * std::tan(from.perspective.yfov / 2);
        width = height * aspect;
        camera.near_clip = from.perspective.znear;
    }
    if (!positive(width) || !positive(height) || from.perspective.yfov >= kPi)
        return false;
    if (!positive(camera.near_clip))
        camera.near_clip = 0.1;
    camera.position = world.offset;
    camera.direction = ahead;
    camera.right = right * width;
    camera.up = up * height;
    return std::abs(glm::dot(glm::cross(right, up), ahead)) > 1e-9;
}

bool read_light(const tinygltf::Light& from, const Affine& world, Light& light) {
    glm::dvec3 right;
    glm::dvec3 up;
    if (!axes_of(world, light.direction, right, up))
        return false;
    light.position = world.offset;
    for (size_t i = 0; i < 3 && i < from.color.size(); ++i)
        light.color[static_cast<int>(i)] = std::isfinite(from.color[i]) ? from.color[i] : 0;
    if (!std::isfinite(from.intensity))
        return false;
    if (from.type == "directional") {  // lux
        light.kind = LightKind::Sun;
        light.power = from.intensity / kLumenPerWatt;
        return true;
    }
    light.power = from.intensity / kLumenPerWatt * 4 * kPi;  // candela
    light.kind = from.type == "spot" ? LightKind::Spot : LightKind::Point;
    if (light.kind == LightKind::Spot) {
        const double outer = std::clamp(from.spot.outerConeAngle, 1e-3, kPi / 2);
        const double inner = std::clamp(from.spot.innerConeAngle, 0.0, outer);
        light.spot_size = 2 * outer;
        light.spot_blend = (std::cos(inner) - std::cos(outer)) / (1 - std::cos(outer));
    }
    return from.type == "spot" || from.type == "point";
}

int light_of(const tinygltf::Node& node) {
    const auto found = node.extensions.find("KHR_lights_punctual");
    if (found == node.extensions.end() || !found->second.IsObject() || !found->second.Has("light"))
        return -1;
    const tinygltf::Value& index = found->second.Get("light");
    return index.IsInt() ? index.GetNumberAsInt() : -1;
}

}  // namespace

void read_view(const tinygltf::Model& from, const std::vector<int>& order,
               const std::function<Affine(int)>& transform, Model& model, Problems& problems) {
    std::vector<Affine> world(from.nodes.size());
    for (const int index : order) {  // a node that was not reached keeps the identity, unused
        const auto at = static_cast<size_t>(index);
        const tinygltf::Node& node = from.nodes[at];
        world[at] = world[at] * transform(index);
        for (const int child : node.children)
            world[static_cast<size_t>(child)] = world[at];
        const auto name = [&](const std::string& own) {
            return valid_utf8(node.name.empty() ? own : node.name);
        };
        const auto left_out = [&](const std::string& what) {
            problems.push_back({what, Severity::Warning, "bad_view",
                                "a camera or light without a size or place is left out"});
        };
        if (node.camera >= 0 && static_cast<size_t>(node.camera) < from.cameras.size()) {
            const tinygltf::Camera& camera = from.cameras[static_cast<size_t>(node.camera)];
            Camera made;
            made.name = name(camera.name);
            if (read_camera(camera, world[at], made))
                model.cameras.push_back(std::move(made));
            else
                left_out(made.name);
        }
        const int light = light_of(node);
        if (light >= 0 && static_cast<size_t>(light) < from.lights.size()) {
            Light made;
            made.name = name(from.lights[static_cast<size_t>(light)].name);
            if (read_light(from.lights[static_cast<size_t>(light)], world[at], made))
                model.lights.push_back(std::move(made));
            else
                left_out(made.name);
        }
    }
}

}  // namespace lodestone::format
