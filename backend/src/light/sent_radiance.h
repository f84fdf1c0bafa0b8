// SPDX-License-Identifier: GPL-3.0-or-later
// Sent radiance: what a point of a surface sends to the eye of the light of a lamp.
#pragma once

#include "model/view.h"

#include <cstdint>
#include <vector>

namespace lodestone::light {

/// How a surface reflects lamps beside its diffuse light, as POV-Ray draws it.
struct SurfaceHighlight {
    double albedo = 0;    // of lamps at the horizon
    double exponent = 1;  // that of the cosine of the half vector
    double fading = 0;    // the share of the albedo that a lamp overhead does not have (Fresnel)
};

/// A point of a surface that a view shows.
struct LitPoint {
    glm::dvec3 position{0.0};
    glm::dvec3 aside{0.0};       // the way to where its rays begin
    glm::dvec3 normal{0, 0, 1};  // has length 1; toward the side from which it is seen
    glm::dvec3 to_eye{0, 0, 1};  // has length 1
    glm::dvec3 albedo{0.8};
    glm::dvec3 other_light{0.0};  // the radiance it sends to the eye from suns and sky
    SurfaceHighlight highlight;
    uint32_t region = 0;  // the points of one region are lit by the same lights
    /// The points next to it: lamps that reach these count as reaching it.
    std::vector<uint32_t> beside;
};

/// The radiance that a point sends to the eye from a light that nothing hides.
glm::dvec3 sent_radiance(const Light& light, const LitPoint& point);

}  // namespace lodestone::light
