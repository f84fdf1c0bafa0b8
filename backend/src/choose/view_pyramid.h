// SPDX-License-Identifier: GPL-3.0-or-later
// View pyramid: the part of the world that a picture shows, and the part of a growing ball's way
// that lies in it.
#pragma once

#include "model/view.h"

#include <array>

namespace lodestone::choose {

/// The points x with dot(normal, x) + offset >= 0; the normal has length 1.
struct HalfSpace {
    glm::dvec3 normal{0, 0, 1};
    double offset = 0;
};

/// A ball of radius `radius + growth * t` around `start + t * direction`, for t from 0 on.
struct SweptBall {
    glm::dvec3 start{0.0};
    glm::dvec3 direction{0, 0, -1};  // has length 1
    double radius = 0;
    double growth = 0;
};

/// The interval from `first` to `last`, in metres along a sweep; empty where last < first.
struct SweepInterval {
    double first = 0;
    double last = 0;

    bool empty() const { return !(first <= last); }
    /// Keeps the part in which the sweep's ball touches the half space.
    void cut_by(const SweptBall& sweep, const HalfSpace& space);
};

/// Whether any ball of a sweep touches another ball.
bool touches(const SweptBall& sweep, const glm::dvec3& center, double radius);

/// The part of a sweep, from its start on, that touches a box.
SweepInterval touched_interval(const SweptBall& sweep, const Box3& box);

/// Four sides through the eye (orthographic: along the view) and a fifth for what is in front of
/// it. They are a little wider than the frame: by a pixel, and by how far a lens blurs a point at
/// the near clip.
class ViewPyramid {
public:
    /// The pyramid of the whole frame, even if a border is rendered. Throws Error(InvalidArgument)
    /// for a camera whose image is a line or a point.
    explicit ViewPyramid(const View& view);

    /// True only when no point of the bound is in the pyramid.
    bool outside(const Bound& bound) const;

    /// The part of a sweep, within `box`, whose balls may touch the pyramid (never less than the
    /// truth).
    SweepInterval touched_interval(const SweptBall& sweep, const Box3& box) const;

private:
    std::array<HalfSpace, 5> sides_;
};

}  // namespace lodestone::choose
