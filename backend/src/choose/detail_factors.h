// SPDX-License-Identifier: GPL-3.0-or-later
// DetailFactors: all that makes one occurrence finer or coarser than Pixel Error alone (5.5.5).
#pragma once

#include "choose/image_frame.h"
#include "choose/lens_field.h"
#include "choose/off_screen.h"

#include <algorithm>

namespace lodestone::choose {

/// Each is kept, so that "why this level?" can name it. The first four refine, the others coarsen.
struct DetailFactors {
    double importance = 1;  // of the placements along its path
    double demand = 1;      // of what is most important below it
    double lenses = 1;
    double screen_lenses = 1;
    double depth = 1;
    double motion = 1;
    double darkness = 1;
    double off_screen = 1;

    /// Error counts so many times: refine / coarsen, within 1/64 ... 64, or infinite.
    double total() const;
};

/// Radiance as a display shows it: 0 ... 1 and beyond.
double displayed_radiance(double radiance);
/// What motion over so many pixels while the shutter is open coarsens: sharpness of a pixel and of
/// the way, squares added.
double coarser_by_motion(double pixels);
/// What light coarsens: differences are differences of what is displayed.
double coarser_by_darkness(double shown);

class FactorField {
public:
    /// Throws Error(InvalidArgument) for modifiers that make no sense.
    /// `in_any_order`: paths stay valid, whatever was visited since.
    FactorField(const Model& model, const View& view, bool in_any_order = false);
    FactorField(const FactorField&) = delete;
    FactorField& operator=(const FactorField&) = delete;

    /// False: all factors but importance and demand are 1 everywhere.
    bool bends() const { return bends_; }

    /// What is known along a path.
    struct FactorPath {
        LensField::LensPath lenses;
        Affine closing;       // -> world when the shutter closes
        bool moving = false;  // a placement along it moves
    };
    FactorPath root();
    /// For a child, once `at` was asked for its group.
    FactorPath below(const FactorPath& group, const Affine& world,
                     const Placement& placement) const;

    struct FactorEffect {
        DetailFactors factors;  // without importance and demand
        bool open = false;
        bool gone = false;
    };
    /// Occurrences in depth-first order, or in any where that was asked for. `path` becomes that of
    /// what is below it.
    FactorEffect at(ObjectIndex object, bool group, const Bound& local, const Affine& world,
                    const Bound& bound, double z, FactorPath& path);

    /// False: neither here nor below, for lenses are all there is, and none is near.
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
    std::vector<uint8_t> moves_below_;  // by object; when moving counts
    std::vector<uint8_t> glows_;        // by object, or below it; when darkness counts
    double background_ = 0;             // display value of the world
    double pixel_ = 0;                  // at 1 m
    bool bends_ = false;
    bool lenses_alone_ = false;  // nothing else bends
};

}  // namespace lodestone::choose
