// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/image_frame.h"

#include "base/error.h"
#include "base/maths.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::choose {
namespace {

ImageRect everything() {
    return {glm::dvec2(-kInfinity), glm::dvec2(kInfinity), false};
}

ImageRect nothing() {
    ImageRect rect;
    rect.behind = true;
    return rect;
}

/// Finds the two u for which the plane (row - u depth) . x = 0 through the eye touches the sphere.
bool tangents(const glm::dvec3& row, const glm::dvec3& depth, const glm::dvec3& center,
              double radius, double& low, double& high) {
    const double a = glm::dot(row, center);
    const double b = glm::dot(depth, center);
    const double square = radius * radius;
    const double first = b * b - square * glm::dot(depth, depth);
    const double half = a * b - square * glm::dot(row, depth);
    const double last = a * a - square * glm::dot(row, row);
    if (!(first > 0))
        return false;
    const double root = std::sqrt(std::max(0.0, half * half - first * last));
    low = (half - root) / first;
    high = (half + root) / first;
    return true;
}

}  // namespace

double ImageRect::area() const {
    const glm::dvec2 size = high - low;
    return behind ? 0 : size.x * size.y;
}

double ImageRect::nearest(const glm::dvec2& point) const {
    return glm::length(glm::max(glm::max(low - point, point - high), glm::dvec2(0.0)));
}

double ImageRect::farthest(const glm::dvec2& point) const {
    return glm::length(glm::max(glm::abs(low - point), glm::abs(high - point)));
}

ImageFrame::ImageFrame(const Camera& camera, int width, int height)
    : orthographic_(camera.orthographic), eye_(camera.position), size_(width, height) {
    const glm::dmat3 frame(camera.direction, camera.right, camera.up);
    const double volume =
        glm::length(camera.direction) * glm::length(camera.right) * glm::length(camera.up);
    if (!(std::abs(glm::determinant(frame)) > 1e-12 * volume))
        fail(Status::InvalidArgument, "the image of camera '", camera.name, "' has no area");
    const glm::dmat3 rows = glm::transpose(glm::inverse(frame));
    depth_ = rows[0];
    across_ = rows[1];
    upward_ = rows[2];
}

glm::dvec2 ImageFrame::pixels(double u, double v) const {
    return {(u + 0.5) * size_.x, (0.5 - v) * size_.y};
}

glm::dvec2 ImageFrame::point(const glm::dvec3& at, bool& in_front) const {
    const glm::dvec3 x = at - eye_;
    const double depth = glm::dot(depth_, x);
    in_front = orthographic_ || depth > 0;
    const double scale = orthographic_ ? 1 : 1 / depth;
    return pixels(glm::dot(across_, x) * scale, glm::dot(upward_, x) * scale);
}

ImageRect ImageFrame::rect_of_sphere(const Bound& bound) const {
    const glm::dvec3 center = bound.center - eye_;
    double left = 0;
    double right = 0;
    double down = 0;
    double up = 0;
    if (orthographic_) {
        const double u = glm::dot(across_, center);
        const double v = glm::dot(upward_, center);
        left = u - bound.radius * glm::length(across_);
        right = u + bound.radius * glm::length(across_);
        down = v - bound.radius * glm::length(upward_);
        up = v + bound.radius * glm::length(upward_);
    } else {
        const double depth = glm::dot(depth_, center);
        const double reach = bound.radius * glm::length(depth_);
        if (depth + reach <= 0)
            return nothing();
        if (depth - reach <= 0 || !tangents(across_, depth_, center, bound.radius, left, right) ||
            !tangents(upward_, depth_, center, bound.radius, down, up))
            return everything();
    }
    return {pixels(left, up), pixels(right, down), false};
}

ImageRect ImageFrame::rect_of_box(const Bound& bound) const {
    if (bound.empty())
        return nothing();
    ImageRect rect{glm::dvec2(kInfinity), glm::dvec2(-kInfinity), false};
    int front = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at((corner & 1u) != 0 ? bound.box.high.x : bound.box.low.x,
                            (corner & 2u) != 0 ? bound.box.high.y : bound.box.low.y,
                            (corner & 4u) != 0 ? bound.box.high.z : bound.box.low.z);
        bool in_front = false;
        const glm::dvec2 here = point(at, in_front);
        if (!in_front)
            continue;
        ++front;
        rect.low = glm::min(rect.low, here);
        rect.high = glm::max(rect.high, here);
    }
    if (front == 0)
        return nothing();
    return front == 8 ? rect : everything();
}

ImageRect ImageFrame::rect(const Bound& bound) const {
    const ImageRect box = rect_of_box(bound);
    if (box.behind)
        return box;
    const ImageRect sphere = rect_of_sphere(bound);
    if (sphere.behind)
        return sphere;
    return {glm::max(box.low, sphere.low), glm::min(box.high, sphere.high), false};
}

}  // namespace lodestone::choose
