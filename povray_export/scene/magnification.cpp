// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene/magnification.h"

#include "choose/criterion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::povray {
namespace {

// The largest extent of a magnified scene.
// Law: POV-Ray's rays end at 1e7, and its bounding boxes are of floats.
constexpr double kLargest = 1e5;

}  // namespace

double magnification(const View& view, std::span<const Bound> bounds) {
    double pixel = std::numeric_limits<double>::infinity();
    double reach = 0;
    for (const Bound& bound : bounds) {
        const double away = glm::length(bound.center - view.camera.position);
        if (!std::isfinite(away) || !std::isfinite(bound.radius))
            continue;
        pixel = std::min(pixel, choose::pixel_size(view, std::max(away, bound.radius)));
        reach = std::max(reach, away + bound.radius);
    }
    if (!(pixel > 0) || !(pixel < kTolerance) || !(reach > 0))
        return 1;
    const double wanted = std::exp2(std::ceil(std::log2(kTolerance / pixel)));
    const double borne = std::exp2(std::floor(std::log2(kLargest / reach)));
    return std::max(1.0, std::min(wanted, borne));
}

Camera magnified(Camera camera, double times) {
    camera.position *= times;
    camera.near_clip *= times;
    camera.focus_distance *= times;
    camera.aperture *= times;
    if (camera.orthographic) {
        camera.right *= times;
        camera.up *= times;
    }
    return camera;
}

Light magnified(Light light, double times) {
    light.position *= times;
    light.radius *= times;
    light.edge_u *= times;
    light.edge_v *= times;
    if (light.kind != LightKind::Sun)
        light.power *= times * times;
    return light;
}

Affine magnified(Affine transform, double times) {
    transform.linear *= times;
    transform.offset *= times;
    return transform;
}

Bound magnified(Bound bound, double times) {
    bound.center *= times;
    bound.radius *= times;
    if (!bound.empty()) {
        bound.box.low *= times;
        bound.box.high *= times;
    }
    return bound;
}

}  // namespace lodestone::povray
