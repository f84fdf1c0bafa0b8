// SPDX-License-Identifier: GPL-3.0-or-later
// Off screen: what the picture does not show matters only by its shadows and images (5.3).
#pragma once

#include "choose/view_pyramid.h"
#include "model/model.h"

#include <vector>

namespace lodestone::choose {

/// Share of the light from around that a surface sends on as an image of it, the mean over all
/// directions; 0 for what is rough, 1 for what refracts.
double imaged_share(const Material& material);
/// The largest of a representation's materials.
double imaged_share(const Model& model, const Representation& representation);

/// The same weighed by the pixels something covers: what is wrong in a door knob is small whatever
/// it shows. Below kLeastImaged it does not count.
double imaged_share(double share, const View& view, const Bound& bound, double away);
inline constexpr double kLeastImaged = 1 / (kMostImportance * kMostImportance);  // its root counts

/// Whether a light throws shadows at all.
bool casts_shadows(const Light& light);

/// Where the shadow of a ball can be, itself included: a swept ball.
struct ShadowReach {
    bool seen = false;  // in the part of the world that is asked about
    double z = 0;       // there no nearer to the eye, metres
    double last = 0;    // there no farther from the ball's center
    /// From the light to the ball's center: infinite for suns; 0: the ball may be all around it.
    double away = 0;
    SweptBall sweep;
};
/// In the pyramid, or anywhere (null), as far as the scene's box goes.
ShadowReach shadow_reach(const Light& light, const Bound& bound, const ViewPyramid* pyramid,
                         const Box3& scene, const glm::dvec3& eye);

/// How much coarser than at its distance something may be that is not in the picture: by how large
/// a pixel is, at least, where its shadow may fall (equation 5.17) and along the way to it by what
/// mirrors or refracts in the picture (equations 5.14 and 5.15). Bounds throughout: shadows are
/// swept balls, mirrors are balls around them. Concave mirrors are taken for flat ones.
class OffScreenField {
public:
    /// cost: one visit of every object, and of the larger things in the picture that mirror.
    OffScreenField(const Model& model, const View& view);

    /// 1 for what may be in the picture, up to kMostImportance for what is not. `bound`: around all
    /// that it may be drawn by (Object::reach), in the world. z: its distance from the eye. cost:
    /// that of every light and mirror (at most kMostMirrors). Thread-safe.
    double coarser(const Bound& bound, double z) const;

    static constexpr size_t kMostMirrors = 256;

private:
    struct MirrorGroup {
        Bound bound;       // around all levels
        double away = 0;   // of it, metres from the eye
        double share = 1;  // see imaged_share()
    };

    double shadow_pixel(const Light& light, const Bound& bound) const;
    void find_mirrors(const Model& model);

    const View& view_;
    const std::vector<Light>& lights_;
    ViewPyramid pyramid_;
    Box3 scene_;
    double most_ = 1;
    std::vector<MirrorGroup> mirrors_;
};

}  // namespace lodestone::choose
