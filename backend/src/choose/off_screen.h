// SPDX-License-Identifier: GPL-3.0-or-later
// Off screen: the detail of things outside the picture, which matter only by their shadows and
// images (5.3).
#pragma once

#include "choose/view_pyramid.h"
#include "model/model.h"

#include <vector>

namespace lodestone::choose {

/// The share of the light from around that a surface sends on as an image, the mean over all
/// directions; 0 for a rough surface, 1 for one that refracts.
double imaged_share(const Material& material);
/// The largest share of a representation's materials.
double imaged_share(const Model& model, const Representation& representation);

/// The share weighed by the pixels that the thing covers: errors in the image that a door knob
/// shows are small. Below kLeastImaged it does not count.
double imaged_share(double share, const View& view, const Bound& bound, double away);
/// The least share that counts, because its root is what coarsens.
/// Law: a share below it would coarsen by more than kMostImportance, the limit of all factors.
inline constexpr double kLeastImaged = 1 / (kMostImportance * kMostImportance);

/// Whether a light throws shadows at all.
bool casts_shadows(const Light& light);

/// The places where the shadow of a ball can be, the ball itself included: a swept ball.
struct ShadowReach {
    bool seen = false;  // some of it lies in the part of the world that is asked about
    double z = 0;       // the part that is seen is no nearer to the eye, in metres
    double last = 0;    // the part that is seen is no farther from the ball's center, in metres
    /// The distance from the light to the ball's center: infinite for suns; 0: the ball may contain
    /// the light.
    double away = 0;
    SweptBall sweep;
};
/// The reach within the pyramid, or without one (null) within the box of the scene.
ShadowReach shadow_reach(const Light& light, const Bound& bound, const ViewPyramid* pyramid,
                         const Box3& scene, const glm::dvec3& eye);

/// How much coarser something outside the picture may be than at its distance: by the size of a
/// pixel where its shadow may fall (equation 5.17) and along the way to it by things in the picture
/// that mirror or refract (equations 5.14 and 5.15); the smallest of these counts. All are bounds:
/// shadows are swept balls, mirrors are balls around them. Concave mirrors are treated as flat
/// ones.
class OffScreenField {
public:
    /// cost: one visit of every object, and of the larger things in the picture that mirror.
    OffScreenField(const Model& model, const View& view);

    /// The factor: 1 for a thing that may be in the picture, up to kMostImportance for others.
    /// `bound`: around all its levels (Object::reach), in the world. `z`: its distance from the
    /// eye. cost: a test of every light and mirror (at most kMostMirrors). Thread-safe.
    double coarser(const Bound& bound, double z) const;

    /// Whether the picture may show nothing but shadows of what is within a bound (world frame):
    /// it is outside, and nothing in the picture that counts mirrors or refracts. Thread-safe.
    bool only_shadows(const Bound& bound) const;

    /// The most mirrors that are looked at one by one; more are put into groups.
    /// Taste: more make factors tighter and every choice slower.
    static constexpr size_t kMostMirrors = 256;

private:
    struct MirrorGroup {
        Bound bound;       // around all levels
        double away = 0;   // the distance of the mirror from the eye, in metres
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
