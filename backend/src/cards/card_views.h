// SPDX-License-Identifier: GPL-3.0-or-later
// CardViews: what rays of orthographic pictures from above the horizon meet of a thing and its
// cards.
#pragma once

#include "cards/card_picture.h"

#include <optional>

namespace lodestone::cards {

/// A place where a ray meets a card: the four texels that are interpolated there.
struct CardCrossing {
    std::array<uint32_t, 4> texels{};
    std::array<float, 4> parts{};  // of each in the interpolated share
    double distance = 0;           // from the ray's origin, in lengths of its direction

    /// The linear color, straight, and the share that is covered.
    glm::vec4 texel(const CardPicture& picture) const;
    /// Whether the card is there.
    bool shows(const CardPicture& picture) const;
};

/// Where a line meets a card; nothing beside it, or where it is seen too flat to show anything.
std::optional<CardCrossing> crossing_of(const CardPlane& plane, const CardPatch& patch,
                                        const CardPicture& picture, const glm::dvec3& origin,
                                        const glm::dvec3& along);

/// The sphere around all cards.
struct CardBall {
    glm::dvec3 center{0.0};
    double radius = 0;

    explicit CardBall(std::span<const CardPlane> planes);
};

/// All rays of one view.
struct CardView {
    glm::dvec3 towards{0.0};              // unit, to the viewer
    std::vector<CardCrossing> crossings;  // by sample
    std::vector<uint32_t> begin;          // by sample, its first crossing; one more at the end
    std::vector<float> wanted;            // by pixel: the share of it in which the thing is seen
    float all_wanted = 0;                 // the sum of these

    size_t samples() const { return begin.size() - 1; }
    std::span<const CardCrossing> at(size_t sample) const {
        return std::span(crossings).subspan(begin[sample], begin[sample + 1] - begin[sample]);
    }
    /// The pixel that a sample lies in, and the share of it that the sample stands for.
    static size_t pixel_of(size_t sample);
    static float share_of_sample();
    /// The pixels that cards cover more than the thing does, in all.
    double too_much(const CardPicture& picture) const;
};

/// Directions that fill the half sphere above evenly (a spiral by the golden angle from the horizon
/// to straight above): of `count` those from number `first` on, each `step`-th. `turn`: radians around
/// the vertical.
struct SkyDirections {
    size_t count = 26;
    size_t first = 0;
    size_t step = 1;
    double turn = 0;

    std::vector<glm::dvec3> all() const;  // unit
};

/// Views along directions. The bits are the same on any number of threads.
std::vector<CardView> card_views(const CardPicture& picture, std::span<const CardPlane> planes,
                                 const ray::MeshScene& scene, const SkyDirections& directions,
                                 uint64_t seed, const Job& job);

}  // namespace lodestone::cards
