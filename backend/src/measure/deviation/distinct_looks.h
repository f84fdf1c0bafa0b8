// SPDX-License-Identifier: GPL-3.0-or-later
// LookPalette: which materials a picture can tell apart.
#pragma once

#include "ray/mesh_skin.h"

#include <map>
#include <span>

namespace lodestone::measure {

/// Numbers for materials; those whose display-encoded colors, and what they emit and let through,
/// differ by at most kSameLook share one (the first seen decides, so ask for the finest's materials
/// first). What varies by texture or vertex color has a look of its own, as long as the mesh has
/// what it varies by; its color is the mean.
class LookPalette {
public:
    static constexpr double kSameLook = 0.1;

    /// Display-encoded, of a point.
    static glm::dvec3 color_of(const ray::SurfaceAppearance& shown);
    /// The light of a display-encoded color: what mixes where a pixel shows several.
    static glm::dvec3 light_of(const glm::dvec3& color);
    static glm::dvec3 encoded(const glm::dvec3& light);
    static bool alike(const glm::dvec3& a, const glm::dvec3& b);

    /// Lights whose encoded colors are alike one color: known without encoding each.
    struct LightRange {
        glm::dvec3 least{0.0};
        glm::dvec3 most{0.0};
        bool hold(const glm::dvec3& light) const {
            return light.x >= least.x && light.y >= least.y && light.z >= least.z &&
                   light.x <= most.x && light.y <= most.y && light.z <= most.z;
        }
    };
    static LightRange lights_alike(const glm::dvec3& color);

    uint16_t of(const Material& material);
    /// One a triangle; a slot without a material looks like Material{}.
    std::vector<uint16_t> of(const Mesh& mesh, std::span<const Material> materials);

    /// Display-encoded, 0...1.
    const glm::dvec3& color(uint16_t look) const { return looks_[look].color; }
    /// What it emits, linear, the mean.
    const glm::dvec3& emission(uint16_t look) const { return looks_[look].emission; }
    /// How much of what is behind it is covered: alpha, without what is transmitted.
    double opacity(uint16_t look) const { return looks_[look].opacity; }
    size_t size() const { return looks_.size(); }

private:
    struct PaletteLook {
        glm::dvec3 color;  // display-encoded, with what it emits
        glm::dvec3 emission;
        double opacity;
        bool varies;  // looks like nothing else
    };
    uint16_t add(const PaletteLook& look);

    std::vector<PaletteLook> looks_;
    std::map<Hash, uint16_t> by_texture_;
};

}  // namespace lodestone::measure
