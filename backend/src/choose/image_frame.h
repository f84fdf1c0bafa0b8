// SPDX-License-Identifier: GPL-3.0-or-later
// Image frame: where in the picture something in the world lies, in pixels.
#pragma once

#include "model/view.h"

namespace lodestone::choose {

/// A part of the image plane, in pixels from the left and the top; it may reach beyond the picture.
struct ImageRect {
    glm::dvec2 low{0.0};
    glm::dvec2 high{0.0};
    bool behind = false;  // nothing of it is in front of the eye

    double area() const;
    /// The least and the greatest distance of a point of the rectangle from `point`.
    double nearest(const glm::dvec2& point) const;
    double farthest(const glm::dvec2& point) const;
};

class ImageFrame {
public:
    /// Throws Error(InvalidArgument) for a camera whose image is a line or a point.
    ImageFrame(const Camera& camera, int width, int height);

    /// A rectangle that contains the image of everything in the bound; the whole plane where the
    /// eye may be inside. source: tangent planes through the eye, for the sphere; the corners, for
    /// the box
    ImageRect rect(const Bound& bound) const;
    /// The bounding rectangle of the image of the bound's box (5.2.2, Figure 5.6).
    ImageRect rect_of_box(const Bound& bound) const;
    /// The image of a point. `in_front`: whether the point lies in front of the eye.
    glm::dvec2 point(const glm::dvec3& at, bool& in_front) const;
    double width() const { return size_.x; }
    double height() const { return size_.y; }

private:
    ImageRect rect_of_sphere(const Bound& bound) const;
    glm::dvec2 pixels(double u, double v) const;

    bool orthographic_;
    glm::dvec3 eye_;
    // The axes of the frame: along the direction of view, and across it.
    glm::dvec3 depth_;
    glm::dvec3 across_;
    glm::dvec3 upward_;
    glm::dvec2 size_;
};

}  // namespace lodestone::choose
