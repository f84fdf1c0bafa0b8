// SPDX-License-Identifier: GPL-3.0-or-later
// Uneven sky: the light of a sky by direction, for surfaces whose rays find what of it they see.
#pragma once

#include "base/hash.h"
#include "light/environment/environment_sky.h"

#include <vector>

namespace lodestone::light {

/// The radiance of a sky by direction, in parts of one color: the radiance all around by which a
/// surface receives as much, in luminance, as the sky gives to that which it lights most, of those
/// facing any way with nothing around them.
class UnevenSky {
public:
    /// The base of a sky: what is not left to lights.
    explicit UnevenSky(const EnvironmentSky& sky);

    /// The color; its hue is that of level ground and what faces up. 0 of a black sky.
    const glm::dvec3& color() const { return color_; }
    /// That of the texel in a direction (world, any length but 0), in parts of the color.
    glm::dvec3 toward(const glm::dvec3& direction) const;
    /// The mean of all directions so high above the horizon; the sine of the angle.
    glm::dvec3 at_height(double sine) const;
    /// The light that a surface facing there receives with nothing around it (unit, world), in parts
    /// of what a sky of the color gives.
    glm::dvec3 received(const glm::dvec3& normal) const;
    /// The share of the light that surfaces facing any way receive in the mean, of the sky above and
    /// of a part of that below.
    double mean(double below) const;
    /// The luminance of parts of the color, in parts of its luminance.
    double share_of(const glm::dvec3& parts) const {
        return weights_.x * parts.x + weights_.y * parts.y + weights_.z * parts.z;
    }
    /// Whether surfaces facing any way receive light of about the same hue.
    bool one_hue() const { return one_hue_; }
    Hash hash() const { return hash_; }

private:
    void find_received(const EnvironmentSky& sky);
    void find_color();
    const glm::dvec3& received_at(int row, int column) const;
    void find_hash();

    int width_;
    int height_;
    glm::dmat3 to_picture_;
    glm::dvec3 color_{0.0};
    glm::dvec3 weights_{0.0};
    std::vector<glm::vec3> values_;
    std::vector<glm::vec3> by_height_;  // from below up, each with as much of the sphere
    std::vector<glm::dvec3> received_;  // of surfaces [height][turn], from the zenith down
    bool one_hue_ = true;
    Hash hash_ = 0;
};

}  // namespace lodestone::light
