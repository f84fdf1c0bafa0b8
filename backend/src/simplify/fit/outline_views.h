// SPDX-License-Identifier: GPL-3.0-or-later
// Outline views: the pixels that a mesh covers, seen from several sides without perspective.
#pragma once

#include "model/mesh.h"
#include "simplify/collapse/collapse_mesh.h"

#include <array>
#include <span>
#include <vector>

namespace lodestone::simplify {

/// The pixels that an original covers in each view.
class OutlineViews {
public:
    /// The number of views.
    /// Taste: more tell more of the outline, in more time.
    static constexpr int kViews = 8;
    /// The pixels along a side of a view.
    /// Taste: more tell smaller differences, in more time.
    static constexpr int kSide = 160;

    OutlineViews(std::span<const glm::vec3> positions, std::span<const Triangle> triangles);

    /// A pixel that only one of both covers, with a triangle that is seen there.
    struct OddPixel {
        uint32_t source = kNone;    // of the original; kNone: the other mesh covers it
        uint32_t triangle = kNone;  // of the other mesh, or kNone
    };
    /// The pixels of all views in which a mesh, in the same frame, differs from the original.
    std::vector<OddPixel> odd_pixels(std::span<const glm::vec3> positions,
                                     std::span<const Triangle> triangles) const;

private:
    /// The triangle that was drawn last at each pixel of a view, or kNone.
    std::vector<uint32_t> draw(int view, std::span<const glm::vec3> positions,
                               std::span<const Triangle> triangles) const;

    float zoom_ = 1;  // pixels a unit
    std::array<std::vector<uint32_t>, kViews> covered_;
};

}  // namespace lodestone::simplify
