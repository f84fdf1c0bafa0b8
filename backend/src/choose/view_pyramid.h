// SPDX-License-Identifier: GPL-3.0-or-later
// ViewPyramid: the part of the world that a picture shows, and what of a growing ball's way lies in it.
#pragma once

#include "model/view.h"

#include <array>

namespace lodestone::choose {

/// Points x with dot(normal, x) + offset >= 0; the normal has length 1.
struct HalfSpace {
    glm::dvec3 normal{0, 0, 1};
    double offset = 0;
};

/// A ball of radius `radius + growth * t` around `start + t * direction`, for t from 0 on.
struct SweptBall {
    glm::dvec3 start{0.0};
    glm::dvec3 direction{0, 0, -1};  // of length 1
    double radius = 0;
    double growth = 0;
};

/// From `first` to `last`, in metres along a sweep; empty where last < first.
struct SweepInterval {
    double first = 0;
    double last = 0;

    bool empty() const { return !(first <= last); }
    /// What of it the sweep's ball touches the half space in.
    void cut_by(const SweptBall& sweep, const HalfSpace& space);
};

/// Whether any of a sweep's balls touches another ball.
bool touches(const SweptBall& sweep, const glm::dvec3& center, double radius);

/// What of a sweep, from its start on, touches a box.
SweepInterval touched_interval(const SweptBall& sweep, const Box3& box);

/// Four sides through the eye (orthographic: along the view) and what is in front of it, a little
/// wider than the frame: by a pixel, and by how far a lens blurs what is at the near clip.
class ViewPyramid {
public:
    /// Of the whole frame, whatever border is rendered. Throws Error(InvalidArgument) for a camera
    /// whose image is a line or a point.
    explicit ViewPyramid(const View& view);

    /// True only when nothing of the bound is in it.
    bool outside(const Bound& bound) const;

    /// The part of a sweep, within `box`, whose balls may touch the pyramid (never less than true).
    SweepInterval touched_interval(const SweptBall& sweep, const Box3& box) const;

private:
    std::array<HalfSpace, 5> sides_;
};

}  // namespace lodestone::choose
