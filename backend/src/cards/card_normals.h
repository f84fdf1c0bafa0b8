// SPDX-License-Identifier: GPL-3.0-or-later
// SideNormals: the shading normals of one side of a card, by the mean of those that it shows.
#pragma once

#include "cards/card_picture.h"

namespace lodestone::cards {

class SideNormals {
public:
    /// `seen`: the normals that the side shows; `face`: its own unit normal.
    SideNormals(const SeenNormals& seen, const glm::dvec3& face);
    /// The unit normal at (x, y), each -1...1 from border to border: between those of the corners.
    glm::dvec3 at(const glm::dvec2& place) const;

private:
    std::array<glm::dvec3, 4> corners_;  // lower left, lower right, upper left, upper right
};

}  // namespace lodestone::cards
