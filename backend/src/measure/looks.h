// SPDX-License-Identifier: GPL-3.0-or-later
// Looks: which materials a picture can tell apart.
#pragma once

#include "model/material.h"
#include "model/mesh.h"

#include <span>

namespace lodestone::measure {

/// Numbers for materials; those whose display-encoded colors differ by at most kSameLook in every
/// channel share one (the first seen decides, so ask for the finest's materials first).
class Looks {
public:
    static constexpr double kSameLook = 0.1;

    uint16_t of(const Material& material);
    /// One a triangle; a slot without a material looks like Material{}.
    std::vector<uint16_t> of(const Mesh& mesh, std::span<const Material> materials);

    /// Display-encoded, 0...1.
    const glm::dvec3& color(uint16_t look) const { return colors_[look]; }

private:
    std::vector<glm::dvec3> colors_;  // display-encoded
};

}  // namespace lodestone::measure
