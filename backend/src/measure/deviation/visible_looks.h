// SPDX-License-Identifier: GPL-3.0-or-later
// VisibleLooks: where the finest surface shows which look, searched by look, color or mixture.
#pragma once

#include "measure/deviation/point_tree.h"
#include "measure/deviation/surface_samples.h"

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace lodestone::measure {

/// A search among samples that can be seen; they must outlive it. "From the same side" means that
/// both points are seen at once, not the grass from above and the road from below. May be used from
/// any thread.
class VisibleLooks {
public:
    VisibleLooks(const std::vector<SurfaceSample>& visible, const LookPalette* palette);

    /// Whether a look is a lamp among the others: its own emission is much brighter than the whole
    /// is in the mean.
    bool glows(uint16_t look) const { return look < glowing_.size() && glowing_[look] != 0; }

    /// The distance in metres to the nearest visible point of look `look`, from the same side;
    /// `most` where it is not less.
    double nearest(const SurfaceSample& from, uint16_t look, double most) const;

    /// The distance in metres to the nearest visible point of that display-encoded color, from the
    /// same side; `most` where it is not less.
    double nearest_of_color(const SurfaceSample& from, const glm::dvec3& color, double most) const;

    /// The radius in metres around a point within which the visible colors mix (as light does, in a
    /// pixel that shows them all) to `color`; `most` where it is not less, or where not even all of
    /// them mix to it.
    double mixing_radius(const SurfaceSample& from, const glm::dvec3& color, double most) const;

    /// Whether these are the samples that the numbers of this search belong to.
    bool holds(const std::vector<SurfaceSample>& samples) const { return &samples == &visible_; }

    /// The mixing radius around visible point `number`, however large; infinite where the colors
    /// never mix to `color`. The answer is kept for the next stand-in of that color.
    double mixing_radius_at(size_t number, const glm::dvec3& color) const;

private:
    /// Mixing radii for one color, by visible point; negative where not asked for yet.
    struct MixingRadii {
        glm::dvec3 color;
        std::unique_ptr<std::atomic<double>[]> by_number;
    };
    struct MixingSample {
        glm::dvec3 point;
        glm::dvec3 side;
        glm::dvec3 light;
        bool sided;
    };

    const std::map<uint16_t, PointTree>& by_look() const;
    std::shared_ptr<const MixingRadii> radii_of(const glm::dvec3& color) const;

    const std::vector<SurfaceSample>& visible_;
    std::vector<uint8_t> glowing_;  // one number a look
    std::vector<MixingSample> mixed_;
    mutable std::once_flag once_;  // makes the trees: most are never asked for
    mutable std::map<uint16_t, PointTree> by_look_;
    mutable std::mutex mutex_;
    mutable std::shared_ptr<const MixingRadii> radii_;
};

}  // namespace lodestone::measure
