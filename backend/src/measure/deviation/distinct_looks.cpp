// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/deviation/distinct_looks.h"

#include "base/color.h"
#include "base/maths.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::measure {
namespace {

double encode(double linear) {
    return encode_srgb(std::clamp(linear, 0.0, 1.0));
}

double decode(double encoded) {
    return decode_srgb(std::clamp(encoded, 0.0, 1.0));
}

/// The mean look of a material where nothing is looked up; materials that are mixed count as mixed.
struct MeanLook {
    glm::dvec3 light;  // color and emission
    glm::dvec3 emission;
    double opacity;

    explicit MeanLook(const Material& material)
        : light(material.base_color + material.emission), emission(material.emission), opacity(1) {
        if (material.alpha_mode == AlphaMode::Blend)
            opacity = material.alpha;
        else if (material.alpha_mode == AlphaMode::Clip)
            opacity = material.alpha_texture || material.alpha >= material.alpha_cutoff ? 1 : 0;
        opacity *= 1 - material.transmission * (1 - material.metallic);
        if (material.other) {
            const MeanLook second(*material.other);
            light = glm::mix(light, second.light, material.mix);
            emission = glm::mix(emission, second.emission, material.mix);
            opacity = glm::mix(opacity, second.opacity, material.mix);
        }
    }
};

/// Whether two looks emit alike. Lamps may be brighter than any picture shows: twice as bright is
/// another lamp.
bool emit_alike(const glm::dvec3& a, const glm::dvec3& b) {
    // The factor from which on lamps differ.
    // Taste: a larger value takes brighter and darker lamps for one.
    constexpr double kSameLamp = 2;
    for (int i = 0; i < 3; ++i) {
        const double less = std::min(a[i], b[i]);
        const double more = std::max(a[i], b[i]);
        if (more > kSameLamp * less &&
            (more >= 1 || encode(more) - encode(less) > LookPalette::kSameLook))
            return false;
    }
    return true;
}

bool varies_by_texture(const Material& material) {
    return material.base_color_texture || material.emission_texture ||
           (material.other && (material.mix_texture || varies_by_texture(*material.other)));
}

bool varies_by_vertex(const Material& material) {
    return material.vertex_colors || (material.other && varies_by_vertex(*material.other));
}

}  // namespace

glm::dvec3 LookPalette::color_of(const ray::SurfaceAppearance& shown) {
    return encoded(shown.color + shown.emission);
}

glm::dvec3 LookPalette::encoded(const glm::dvec3& light) {
    return {encode(light.x), encode(light.y), encode(light.z)};
}

glm::dvec3 LookPalette::light_of(const glm::dvec3& color) {
    return {decode(color.x), decode(color.y), decode(color.z)};
}

LookPalette::LightRange LookPalette::lights_alike(const glm::dvec3& color) {
    LightRange out;
    for (int i = 0; i < 3; ++i) {
        // Encoding rises with light, and shows everything above 1 as 1.
        out.least[i] = color[i] - kSameLook > 0 ? decode(color[i] - kSameLook) : -kInfinity;
        out.most[i] = color[i] + kSameLook < 1 ? decode(color[i] + kSameLook) : kInfinity;
    }
    return out;
}

bool LookPalette::alike(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 off = glm::abs(a - b);
    return std::max({off.x, off.y, off.z}) <= kSameLook;
}

uint16_t LookPalette::add(const PaletteLook& look) {
    if (looks_.size() < std::numeric_limits<uint16_t>::max())
        looks_.push_back(look);
    return static_cast<uint16_t>(looks_.size() - 1);
}

uint16_t LookPalette::of(const Material& material) {
    const MeanLook mean(material);
    const glm::dvec3 color = encoded(mean.light);
    for (size_t i = 0; i < looks_.size(); ++i) {
        const PaletteLook& known = looks_[i];
        if (!known.varies && alike(color, known.color) &&
            emit_alike(mean.emission, known.emission) &&
            std::abs(mean.opacity - known.opacity) <= kSameLook)
            return static_cast<uint16_t>(i);
    }
    return add({color, mean.emission, mean.opacity, false});
}

std::vector<uint16_t> LookPalette::of(const Mesh& mesh, std::span<const Material> materials) {
    std::vector<uint16_t> by_slot;
    for (const Material& material : materials) {
        if (!(varies_by_texture(material) && !mesh.uvs.empty()) &&
            !(varies_by_vertex(material) && !mesh.colors.empty())) {
            by_slot.push_back(of(material));
            continue;
        }
        const auto [at, fresh] = by_texture_.try_emplace(hash_of(material), uint16_t{0});
        if (fresh) {
            const MeanLook mean(material);
            at->second = add({encoded(mean.light), mean.emission, mean.opacity, true});
        }
        by_slot.push_back(at->second);
    }
    const uint16_t otherwise = of(Material{});
    std::vector<uint16_t> looks(mesh.triangles.size());
    for (size_t i = 0; i < looks.size(); ++i) {
        const uint16_t slot = mesh.slot(i);
        looks[i] = slot < by_slot.size() ? by_slot[slot] : otherwise;
    }
    return looks;
}

}  // namespace lodestone::measure
