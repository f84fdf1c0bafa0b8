// SPDX-License-Identifier: GPL-3.0-or-later
// Seen parts: what of the drawn things a picture shows, and what throws shadows into it.
#pragma once

#include "light/light_plan.h"

#include <span>
#include <vector>

namespace lodestone::light {

/// The needs of a picture for a triangle, as bits.
/// Law: a bit of a byte: it is seen, in mirrors too.
inline constexpr uint8_t kSeen = 1;
/// Law: another bit: its shadow may be seen.
inline constexpr uint8_t kShades = 2;

/// The parts of drawn things that a picture needs, found by rays: through the picture, from what
/// these meet to lights, and toward what they did not meet. Parts are groups of neighboring triangles
/// some pixels wide, and a part counts as a whole. So what is not needed changes less than a pixel,
/// here and there.
class SeenParts {
public:
    /// Model, drawn things and view as for plan_lights(); `lights`: all that may throw shadows.
    /// Of very many, everything throws some. Throws Error(RaysUnavailable),
    /// Error(BadFile), Error(Cancelled). The result does not depend on the number of threads.
    /// cost: rays(view) rays through the picture, to one or two lights from every other one; a tree
    /// of boxes for each mesh.
    SeenParts(const Model& model, const RendererSurfaces& renderer,
              std::span<const DrawnThing> drawn, const View& view, std::span<const Light> lights,
              const Job& job);

    /// False: something in the picture sends rays on where only the renderer knows (glass, or bumps
    /// of a mirror). Then everything is needed.
    bool known() const { return known_; }
    /// The needs for all of a thing together: 0, and its picture is the same without it.
    uint8_t needs(size_t drawn) const { return known_ ? all_[drawn] : kSeen | kShades; }
    /// The needs for each triangle of a thing; of solids, for those they are tessellated to.
    std::span<const uint8_t> triangles(size_t drawn) const {
        return std::span(needs_).subspan(first_[drawn], first_[drawn + 1] - first_[drawn]);
    }

    /// The share of the picture where anything is seen, about.
    double covered() const { return covered_; }

    /// The rays through a picture.
    static double rays(const View& view);

private:
    bool known_ = true;
    double covered_ = 1;
    std::vector<uint8_t> all_;    // by drawn thing
    std::vector<size_t> first_;   // of needs_, by drawn thing; one more at the end
    std::vector<uint8_t> needs_;  // by triangle
};

}  // namespace lodestone::light
