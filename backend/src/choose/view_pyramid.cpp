// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/view_pyramid.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::choose {
namespace {

/// The side of a plane that `inner` lies on.
HalfSpace side(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& inner) {
    const double length = glm::length(normal);
    if (!(length > 0) || !std::isfinite(length))
        fail(Status::InvalidArgument, "the camera's image is a line or a point");
    const glm::dvec3 unit = normal / (glm::dot(normal, inner - point) < 0 ? -length : length);
    return {unit, -glm::dot(unit, point)};
}

/// Half the width or height of the frame, a pixel and a lens's blur added, relative to the frame.
double half_frame(const View& view, int pixels, double extent) {
    const Camera& camera = view.camera;
    double half = 0.5 + 1.0 / std::max(1, pixels);
    if (!camera.orthographic && camera.focus_distance > 0 && camera.aperture > 0 && extent > 0) {
        // The circle of confusion of the nearest thing; far things are blurred by less than 1 /
        // focus
        const double nearest = 1 / std::max(camera.near_clip, 1e-3);
        const double sharp = 1 / camera.focus_distance;
        half += 0.5 * camera.aperture * std::max(std::abs(nearest - sharp), sharp) / extent;
    }
    return half;
}

}  // namespace

void SweepInterval::cut_by(const SweptBall& sweep, const HalfSpace& space) {
    // The ball touches the half space where slope * t + at_start >= 0
    const double at_start = glm::dot(space.normal, sweep.start) + space.offset + sweep.radius;
    const double slope = glm::dot(space.normal, sweep.direction) + sweep.growth;
    if (slope > 0)
        first = std::max(first, -at_start / slope);
    else if (slope < 0)
        last = std::min(last, -at_start / slope);
    else if (at_start < 0)
        last = -1;
}

bool touches(const SweptBall& sweep, const glm::dvec3& center, double radius) {
    const double both = sweep.radius + radius;
    const glm::dvec3 to = center - sweep.start;
    if (glm::length(to) <= both || sweep.growth >= 1)
        return true;
    // The least value along the way of the distance minus the growth of the ball
    const double along = glm::dot(to, sweep.direction);
    const double beside = glm::length(to - along * sweep.direction);
    const double slope = std::sqrt(1 - sweep.growth * sweep.growth);
    return along + sweep.growth * beside / slope >= 0 &&
           beside * slope - sweep.growth * along <= both;
}

SweepInterval touched_interval(const SweptBall& sweep, const Box3& box) {
    SweepInterval out{0, std::numeric_limits<double>::infinity()};
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 normal(0.0);
        normal[axis] = 1;
        out.cut_by(sweep, {normal, -box.low[axis]});
        out.cut_by(sweep, {-normal, box.high[axis]});
    }
    return out;
}

ViewPyramid::ViewPyramid(const View& view) {
    const Camera& camera = view.camera;
    const glm::dvec3 right = camera.right * half_frame(view, view.width, glm::length(camera.right));
    const glm::dvec3 up = camera.up * half_frame(view, view.height, glm::length(camera.up));
    const glm::dvec3& eye = camera.position;
    const glm::dvec3 ahead = eye + camera.direction;
    // A plane through a corner of the frame (perspective: at distance 1), and along the view
    const auto edge = [&](const glm::dvec3& to, const glm::dvec3& along) {
        const glm::dvec3 corner = camera.orthographic ? eye + to : ahead + to;
        const glm::dvec3 view_ray = camera.orthographic ? camera.direction : corner - eye;
        return side(corner, glm::cross(view_ray, along), ahead);
    };
    sides_ = {edge(-right, up), edge(right, up), edge(-up, right), edge(up, right),
              side(eye, glm::cross(right, up), ahead)};
}

bool ViewPyramid::outside(const Bound& bound) const {
    if (bound.empty())
        return true;
    const glm::dvec3 middle = 0.5 * (bound.box.low + bound.box.high);
    const glm::dvec3 half = 0.5 * (bound.box.high - bound.box.low);
    return std::any_of(sides_.begin(), sides_.end(), [&](const HalfSpace& space) {
        return glm::dot(space.normal, bound.center) + space.offset < -bound.radius ||
               glm::dot(space.normal, middle) + space.offset <
                   -glm::dot(glm::abs(space.normal), half);
    });
}

SweepInterval ViewPyramid::touched_interval(const SweptBall& sweep, const Box3& box) const {
    SweepInterval out = choose::touched_interval(sweep, box);
    for (const HalfSpace& space : sides_)
        out.cut_by(sweep, space);
    return out;
}

}  // namespace lodestone::choose
