// SPDX-License-Identifier: GPL-3.0-or-later
// Attributes: what replacements are matched on (dissertation 4.2), in the object's own frame.
#pragma once

#include "base/maths.h"

#include <cstdint>
#include <vector>

namespace lodestone {

/// The share of something that a slot's triangles have.
struct SlotShare {
    uint16_t slot = 0;
    double share = 0;
};
/// By slot, rising; the shares come to 1.
using SlotShares = std::vector<SlotShare>;

struct Attributes {
    double visible_area = 0;    // VSA, m^2; open sheets count both sides
    double surface_area = 0;    // area that could be seen at all: VSA / it = visibility
    glm::dvec3 centroid{0.0};   // of the visible surface
    glm::dmat3 moments{0.0};    // integral of (x-c)(x-c)^T dA over the visible surface, m^4
    glm::dmat3 axes{1.0};       // principal frame (columns, right-handed), longest axis first
    double normal_moment = 0;   // mean of sum n_i^4 in that frame: box 1, sphere 0.6
    glm::dvec3 color{0.8};      // mean base color, by visible area
    glm::dvec3 emission{0.0};   // likewise
    double roughness = 0.5;     // likewise, of the materials' means
    double metallic = 0;        // likewise
    double specular = 0.5;      // likewise
    SlotShares shares{};        // of the visible area, by which these are means; empty: not known
    double relative_error = 0;  // of visible_area, 95 % confidence
    uint64_t rays = 0;          // how many were cast

    bool empty() const { return !(visible_area > 0); }
    /// sqrt(trace(moments) / VSA): the length that centroid errors are judged by.
    double radius_of_gyration() const;
    /// Surface inertia tensor (dissertation 4.20): trace(moments) I - moments.
    glm::dmat3 inertia() const;
};

}  // namespace lodestone
