// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/looks.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::measure {
namespace {

double encoded(double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

}  // namespace

uint16_t Looks::of(const Material& material) {
    const glm::dvec3 sum = material.base_color + material.emission;
    const glm::dvec3 color(encoded(sum.x), encoded(sum.y), encoded(sum.z));
    for (size_t i = 0; i < colors_.size(); ++i) {
        const glm::dvec3 off = glm::abs(color - colors_[i]);
        if (std::max({off.x, off.y, off.z}) <= kSameLook)
            return static_cast<uint16_t>(i);
    }
    if (colors_.size() < std::numeric_limits<uint16_t>::max())
        colors_.push_back(color);
    return static_cast<uint16_t>(colors_.size() - 1);
}

std::vector<uint16_t> Looks::of(const Mesh& mesh, std::span<const Material> materials) {
    std::vector<uint16_t> by_slot;
    for (const Material& material : materials)
        by_slot.push_back(of(material));
    const uint16_t otherwise = of(Material{});
    std::vector<uint16_t> looks(mesh.triangles.size());
    for (size_t i = 0; i < looks.size(); ++i) {
        const uint16_t slot = mesh.slot(i);
        looks[i] = slot < by_slot.size() ? by_slot[slot] : otherwise;
    }
    return looks;
}

}  // namespace lodestone::measure
