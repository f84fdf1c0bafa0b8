// SPDX-License-Identifier: GPL-3.0-or-later
// Sky occlusion: how much of the sky's uniform light each drawn thing answers to, found by rays and
// kept from picture to picture.
#pragma once

#include "base/job.h"
#include "choose/cut.h"
#include "povray_export/lamp/sky_light.h"
#include "povray_export/occurrence/picture_needs.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

namespace lodestone::povray {

/// The beginning of the file that keeps it.
/// Law: another one is another format.
inline constexpr std::string_view kSkyVersion = "LDSSKY05";

/// The choices for sky occlusion.
struct SkyOcclusionOptions {
    int rays = 128;       // that tell the share of a corner at most, of a scene that is not large
    double pixels = 1e9;  // of the picture: smaller triangles, or larger meshes, have fewer rays
    bool still = false;   // what moves in an animation rests
    /// The camera of a picture alone: what is opaque has the light of the side that it sees, and the
    /// largest copies that of where they stand. Null: nothing changes as the camera moves.
    const Camera* camera = nullptr;
    /// The most distinct triangles of a scene that is looked through.
    /// Taste: a larger value shades larger scenes, for minutes and gigabytes.
    uint64_t most_triangles = 6'000'000;
    std::filesystem::path file;  // where bakes are kept; "": nowhere
    /// The sky by direction. Null: it is the same everywhere.
    std::shared_ptr<const light::UnevenSky> uneven{};
    /// The masks of the model as far as they are decoded; null: none are.
    std::shared_ptr<image::TexelCache> texels{};
    /// The needs of the picture: the sky's light is not found on things that it does not show.
    /// Null: it shows all.
    const PictureNeeds* needs = nullptr;
    /// How many pixels of the picture something (world) is across. Null: as if it were small, so that
    /// boxes have the mean of their sides.
    std::function<double(const Bound&)> pixels_across;
    /// Makes the finest level of everything resident; asked for only where something is to be
    /// found that was not kept.
    std::function<void()> load_finest;
};

/// The sky's light on everything that a cut draws. What hides the sky are the finest levels of all
/// that rests, whatever the cut draws, so that shade does not change as the camera moves. A thing
/// that is placed once has the shares of its corners as it stands there. What is placed more often
/// has those of its own shape, times one of at most four grades of what is around its placement,
/// which changes evenly over the thing. Boxes and ellipsoids have the mean of their sides, or, where
/// they are large in the picture, the light of each. Levels have the light of the outermost places
/// near them of their finest level, crossed cards that of what they show, and what stands in for a
/// group that of all below it. What moves in an animation hides the sky from itself alone, so that
/// no frame needs rays anew; where a ground lies below it, it sees no sky there. In a picture alone
/// it rests, what is opaque has the light of the side that the camera sees, and the largest copies
/// that of where they stand.
class SkyOcclusion {
public:
    /// Where rays cannot be cast or there is too much, nothing is occluded, and a problem says so.
    /// Throws Error(Cancelled).
    SkyOcclusion(const Model& model, const choose::Cut& cut, const SkyOcclusionOptions& options,
                 Problems& problems, const Job& job);

    /// The light on a choice of the cut; null: all of it.
    SkyLightPtr of(size_t position) const { return lights_[position]; }
    /// False: the light is not found, and all of it is on everything.
    bool found() const { return found_; }
    /// Whether rays were cast, so that time has passed.
    bool baked() const { return baked_; }
    /// The same for another level of that node: one factor for all of it.
    SkyLightPtr mean_of_node(uint32_t node) const;

private:
    bool baked_ = false;
    bool found_ = false;
    std::vector<SkyLightPtr> lights_;                      // by position in cut.chosen
    std::vector<std::pair<uint32_t, SkyLightPtr>> means_;  // by node, rising
};

}  // namespace lodestone::povray
