// SPDX-License-Identifier: GPL-3.0-or-later
// Detail factors: all that makes one occurrence finer or coarser than Pixel Error alone (5.5.5).
#pragma once

#include "choose/image_frame.h"
#include "choose/lens_field.h"
#include "choose/off_screen.h"

#include <algorithm>

namespace lodestone::choose {

/// Each factor is kept, so that "why this level?" can name it.
struct DetailFactors {
    // These refine.
    double importance = 1;  // the product over the placements along its path
    double demand = 1;      // that of the most important object below it
    double lenses = 1;
    double screen_lenses = 1;
    // These coarsen.
    double depth = 1;
    double motion = 1;
    double darkness = 1;
    double off_screen = 1;

    /// The error is multiplied by this: refine / coarsen, within 1/64 ... 64, or infinite.
    double total() const;
};

/// The factor by which motion over `pixels` pixels, while the shutter is open, coarsens. The
/// squares of the widths of a pixel and of the motion are added.
double coarser_by_motion(double pixels);
/// The factor by which darkness or brightness coarsens: an error is the difference between
/// displayed values.
double coarser_by_darkness(double shown);

class FactorField {
public:
    /// Throws Error(InvalidArgument) for modifiers that make no sense. `in_any_order`: paths stay
    /// valid, whatever was visited since.
    FactorField(const Model& model, const View& view, bool in_any_order = false);
    FactorField(const FactorField&) = delete;
    FactorField& operator=(const FactorField&) = delete;

    /// False: all factors but importance and demand are 1 everywhere.
    bool bends() const { return bends_; }

    /// The facts that are known along a path.
    struct FactorPath {
        LensField::LensPath lenses;
        Affine closing;       // the map to the world when the shutter closes
        bool moving = false;  // a placement along it moves
    };
    /// Whether anything but lenses is known along a path. Else below() returns its group's path, and
    /// need not be asked.
    bool follows_paths() const { return view_.modifiers.when_moving; }
    FactorPath root();
    /// The path of a child, after `at` was asked for its group.
    FactorPath below(const FactorPath& group, const Affine& world,
                     const Placement& placement) const;

    struct FactorEffect {
        DetailFactors factors;  // without importance and demand
        bool open = false;
        bool gone = false;
    };
    /// The effect on an occurrence. Occurrences are asked for in depth-first order, or in any order
    /// where the constructor was told so. `path` becomes the path of its children.
    FactorEffect at(ObjectIndex object, bool group, const Bound& local, const Affine& world,
                    const Bound& bound, double z, FactorPath& path);

    /// False: all factors are 1 here and below, because there are only lenses and none of them is
    /// near.
    bool bends(const FactorPath& path) const {
        return bends_ && (path.lenses.begin < path.lenses.end || !lenses_alone_);
    }

    const ImageFrame& frame() const { return frame_; }
    /// pixel_size() of the view.
    double pixel(double z) const {
        return view_.camera.orthographic ? pixel_ : pixel_ * std::max(z, view_.camera.near_clip);
    }

private:
    double screen_lenses(const Bound& bound) const;
    double motion(ObjectIndex object, const Bound& local, const Affine& world,
                  const FactorPath& path) const;
    double darkness(ObjectIndex object, const Bound& bound) const;

    const Model& model_;
    const View& view_;
    LensField lenses_;
    ImageFrame frame_;
    std::optional<ImageFrame> closing_;
    std::optional<OffScreenField> off_screen_;
    std::vector<uint8_t> moves_below_;  // by object; empty where motion does not count
    /// By object, true also if something below glows; empty where darkness does not count.
    std::vector<uint8_t> glows_;
    double background_ = 0;  // the displayed value of the world
    double pixel_ = 0;       // the size of a pixel at 1 m
    bool bends_ = false;
    bool lenses_alone_ = false;  // lenses are the only factors
};

}  // namespace lodestone::choose
