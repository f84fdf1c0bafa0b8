// SPDX-License-Identifier: GPL-3.0-or-later
// Pixel field: how finely a picture shows the places of the world.
#pragma once

#include "choose/off_screen.h"
#include "povray_export/mesh/detail_bands.h"

#include <optional>

namespace lodestone::povray {

/// The size of what must be told apart at a place. Where the view lets things outside the picture be
/// coarser (QualityModifiers::off_screen), that holds for outlines and pictures on them, too.
/// Thread-safe. Model and view must outlive it.
class PixelField {
public:
    /// Throws Error(InvalidArgument) for a camera whose image is a line or a point.
    PixelField(const Model& model, const View& view);

    /// The metres that a pixel covers within a bound (world frame) where it covers least; more
    /// outside the picture, as far as shadows and images need. cost: OffScreenField::coarser().
    double at(const Bound& bound) const {
        return at(bound, distance(bound, view_.camera.position));
    }
    /// The same where the nearest of what is there is z metres from the eye.
    double at(const Bound& bound, double z) const;

    /// How the parts of a placed mesh with this bound (world frame) are seen, where some may be seen less finely than others; null:
    /// it is so small for its distance that all are alike. Their unit is a metre in the world.
    DetailBandsPtr bands(const Mesh& mesh, const Affine& world, const Bound& all) const;

    /// Whether the picture may show nothing but shadows of what is within a bound (world frame).
    bool only_shadows(const Bound& bound) const;

private:
    const View& view_;
    std::optional<choose::OffScreenField> off_screen_;  // none: everything is as if it were seen
};

}  // namespace lodestone::povray
