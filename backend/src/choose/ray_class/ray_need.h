// SPDX-License-Identifier: GPL-3.0-or-later
// Ray need: how far outlines may be off of what a picture shows by its shadow or image alone (5.3).
#pragma once

#include "choose/cut.h"
#include "choose/off_screen.h"
#include "measure/visible/convex_shape.h"

#include <functional>

namespace lodestone::choose {

/// What must be known of a mesh, alone or beside a box or ellipsoid, to be met by some rays only.
struct RayShape {
    measure::ShapeConvexity convexity;
    std::optional<measure::ScaledSolid> inside;  // the largest solid in it
    std::optional<measure::ScaledSolid> around;  // the smallest around it
};
/// Of a mesh that is resident; `solid`: a box or ellipsoid, or null.
RayShape shape_of(const Representation& mesh, const Representation* solid);
/// The same of one that may not be. Pure.
using ShapeOf = std::function<RayShape(const Representation& mesh, const Representation* solid)>;

/// Something in the picture that shows images, of itself or of what is behind it.
struct PictureMirror {
    uint32_t node = 0;
    Bound bound;
    double away = 0;    // metres from the eye
    double share = 0;   // see imaged_share()
    bool flat = false;  // images in it are no larger than in a flat mirror
};

class RayNeed {
public:
    /// `bounds`: of the cut's nodes, in the world. cost: one visit of each.
    RayNeed(const Model& model, const View& view, const Cut& cut, const std::vector<Bound>& bounds);

    bool mirrored() const { return !mirrors_.empty(); }

    /// Metres, at the thing, that the outline it throws a shadow by may be off for each pixel of
    /// Pixel Error: a pixel where the shadow may be nearest to the eye (that on itself left out),
    /// by how much light enlarges it. Soft edges may be moved so far that the mean square of what
    /// changes is that of a sharp edge moved by the Pixel Error.
    struct ShadowEdge {
        double sharp = 0;  // whatever size lights have
        double any = 0;    // at least `sharp`
    };
    /// `clear_of`: metres to the nearest thing that a sweep touches.
    ShadowEdge shadow(const Bound& bound,
                      const std::function<double(const SweptBall&)>& clear_of) const;

    /// The same for its image: the path's length (5.14) over the root of what is mirrored (5.15).
    /// In mirrors of unknown curvature things are taken to be as large as seen directly. Infinite
    /// without mirrors.
    double image(const Bound& bound, const ShapeOf& shape_of);

private:
    void find_shapes(const ShapeOf& shape_of);

    const Model& model_;
    const View& view_;
    const Cut& cut_;
    ViewPyramid pyramid_;
    Box3 scene_;
    std::vector<PictureMirror> mirrors_;
    bool shapes_known_ = false;
};

}  // namespace lodestone::choose
