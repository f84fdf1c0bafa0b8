// SPDX-License-Identifier: GPL-3.0-or-later
// Ray need: how far the outline of a thing may be off that the picture shows by its shadow or image
// alone (5.3).
#pragma once

#include "choose/cut.h"
#include "choose/off_screen.h"
#include "measure/visible/convex_shape.h"

#include <functional>

namespace lodestone::choose {

/// The facts about a mesh, alone or beside a box or ellipsoid, that decide whether only some rays
/// may meet it.
struct RayShape {
    measure::ShapeConvexity convexity;
    std::optional<measure::ScaledSolid> inside;  // the largest solid inside the mesh
    std::optional<measure::ScaledSolid> around;  // the smallest solid around the mesh
};
/// The shape of a mesh that is resident; `solid`: a box or ellipsoid, or null.
RayShape shape_of(const Representation& mesh, const Representation* solid);
/// A function that gives the shape of a mesh that may not be resident. It depends on its arguments
/// only.
using ShapeOf = std::function<RayShape(const Representation& mesh, const Representation* solid)>;

/// Something in the picture that shows images, of itself or of things behind it.
struct PictureMirror {
    uint32_t node = 0;
    Bound bound;
    double away = 0;    // in metres, from the eye
    double share = 0;   // see imaged_share()
    bool flat = false;  // images in it are no larger than in a flat mirror
};

class RayNeed {
public:
    /// `bounds`: those of the cut's nodes, in the world. cost: one visit of each.
    RayNeed(const Model& model, const View& view, const Cut& cut, const std::vector<Bound>& bounds);

    bool mirrored() const { return !mirrors_.empty(); }

    /// How far, in metres at the thing, the outline that throws its shadow may be off for each
    /// pixel of Pixel Error: a pixel where the shadow may be nearest to the eye (the shadow on the
    /// thing itself is left out), divided by how much the light enlarges it. Soft edges may move so
    /// far that the mean square of the change equals that of a sharp edge that moves by the Pixel
    /// Error.
    struct ShadowEdge {
        double sharp = 0;  // for lights of any size
        double any = 0;    // for lights of their size; at least `sharp`
    };
    /// `clear_of`: the distance in metres to the nearest thing that a sweep touches.
    ShadowEdge shadow(const Bound& bound,
                      const std::function<double(const SweptBall&)>& clear_of) const;

    /// The same for the image of the thing: the length of the path (5.14) over the root of the
    /// share that is mirrored (5.15). In mirrors of unknown curvature things are assumed to be as
    /// large as seen directly. Infinite without mirrors.
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
