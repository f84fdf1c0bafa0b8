// SPDX-License-Identifier: GPL-3.0-or-later
// Environment sky: a world's environment picture, reduced to texels of the sphere.
#pragma once

#include "model/view.h"

#include <vector>

namespace lodestone::light {

struct SkyTexel {
    glm::dvec3 direction{0.0};  // the direction in which it is seen, in the world
    glm::dvec3 radiance{0.0};
    double solid_angle = 0;
    glm::dvec3 base{0.0};  // of its radiance, what lights do not stand for

    glm::dvec3 power() const { return radiance * solid_angle; }
    /// The power that lights stand for; negative where the base is more than there is.
    glm::dvec3 above() const { return (radiance - base) * solid_angle; }
};

/// The texels of an environment, rows from the picture's top.
class EnvironmentSky {
public:
    /// The world has an environment. Throws Error(BadFile) for a picture that cannot be decoded.
    /// cost: that of decoding
    explicit EnvironmentSky(const World& world);

    int width() const { return width_; }
    int height() const { return height_; }
    const SkyTexel& at(int x, int y) const {
        return texels_[static_cast<size_t>(y) * static_cast<size_t>(width_) +
                       static_cast<size_t>(x)];
    }
    const std::vector<SkyTexel>& texels() const { return texels_; }
    /// The turn of the world's directions to the picture's.
    const glm::dmat3& to_picture() const { return to_picture_; }

    /// Makes the base what every block of texels has at least; returns it.
    glm::dvec3 take_uniform();
    /// Makes the base all but the peaks: what texels have above several times the mean.
    void take_below_peaks();

private:
    int width_;
    int height_;
    glm::dmat3 to_picture_{1.0};
    std::vector<SkyTexel> texels_;
};

/// The direction of a texel at (u, v) in 0...1, in the picture's own frame: u = 1/2 is +X, falling
/// u turns to +Y; v = 1 is +Z. This is Blender's equirectangular mapping.
glm::dvec3 equirectangular_direction(double u, double v);
/// The (u, v) of a direction of any length but 0.
glm::dvec2 equirectangular_place(const glm::dvec3& direction);

}  // namespace lodestone::light
