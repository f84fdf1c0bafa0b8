// SPDX-License-Identifier: GPL-3.0-or-later
// LookPalette: the materials that a picture can tell apart, each with a number.
#pragma once

#include "ray/mesh_skin.h"

#include <map>
#include <span>

namespace lodestone::measure {

/// The palette gives numbers to materials. Materials whose display-encoded colors, emission and
/// opacity differ by at most kSameLook share one number (the first one seen decides, so ask for the
/// materials of the finest first). A material that varies by texture or vertex color has a look of
/// its own, as long as the mesh has the coordinates or colors it varies by; the color of such a
/// look is the mean.
class LookPalette {
public:
    /// Two looks whose display-encoded values (0...1) differ by no more than this are one look.
    /// Taste: a larger value takes more materials for one, so that levels lose colors for no error.
    static constexpr double kSameLook = 0.1;

    /// The display-encoded color of a point, its emission included.
    static glm::dvec3 color_of(const ray::SurfaceAppearance& shown);
    /// The linear light of a display-encoded color: light is what mixes where a pixel shows several
    /// colors.
    static glm::dvec3 light_of(const glm::dvec3& color);
    /// The display-encoded color of linear light; the inverse of light_of().
    static glm::dvec3 encoded(const glm::dvec3& light);
    /// Whether two display-encoded colors differ by at most kSameLook in every channel.
    static bool alike(const glm::dvec3& a, const glm::dvec3& b);

    /// The range of linear lights whose encoded colors are alike one color, so that single lights
    /// need no encoding.
    struct LightRange {
        glm::dvec3 least{0.0};
        glm::dvec3 most{0.0};
        /// Whether a light lies in the range.
        bool hold(const glm::dvec3& light) const {
            return light.x >= least.x && light.y >= least.y && light.z >= least.z &&
                   light.x <= most.x && light.y <= most.y && light.z <= most.z;
        }
    };
    /// The range for a display-encoded color.
    static LightRange lights_alike(const glm::dvec3& color);

    /// The look of a material that does not vary.
    uint16_t of(const Material& material);
    /// The looks of a mesh's triangles, one number a triangle; a slot without a material looks like
    /// Material{}.
    std::vector<uint16_t> of(const Mesh& mesh, std::span<const Material> materials);

    /// The color of a look, display-encoded, 0...1.
    const glm::dvec3& color(uint16_t look) const { return looks_[look].color; }
    /// The mean light that a look emits, linear.
    const glm::dvec3& emission(uint16_t look) const { return looks_[look].emission; }
    /// The share of what is behind that a look covers: its alpha, without what is transmitted.
    double opacity(uint16_t look) const { return looks_[look].opacity; }
    /// The number of looks.
    size_t size() const { return looks_.size(); }

private:
    struct PaletteLook {
        glm::dvec3 color;  // display-encoded, with the emission
        glm::dvec3 emission;
        double opacity;
        bool varies;  // true: the look is like no other
    };
    uint16_t add(const PaletteLook& look);

    std::vector<PaletteLook> looks_;
    std::map<Hash, uint16_t> by_texture_;
};

}  // namespace lodestone::measure
