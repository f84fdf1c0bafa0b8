// SPDX-License-Identifier: GPL-3.0-or-later
// Street lamps, shared by the tests of what glows and of thin posts.
#pragma once

#include "scenes/small_models.h"

#include <vector>

namespace lodestone::lamps {

enum Slot : uint16_t { kPost, kGlass, kBulb };

inline std::vector<Material> materials() {
    std::vector<Material> out{models::colored("post", {0.03, 0.03, 0.04}),
                              models::colored("glass", {0.9, 0.95, 0.95}),
                              models::colored("bulb", {0.8, 0.7, 0.5})};
    out[kGlass].transmission = 1;
    out[kBulb].emission = {0.8, 0.7, 0.4};
    return out;
}

inline Mesh moved_up(Mesh mesh, double z, uint16_t slot) {
    for (glm::vec3& position : mesh.positions)
        position.z += static_cast<float>(z);
    mesh.slots.assign(mesh.triangles.size(), slot);
    return mesh;
}

/// A post of 2.8 m and that radius, on it a globe of glass around a bulb.
inline Mesh lamp(double radius) {
    Mesh mesh = moved_up(shapes::ellipsoid({radius, radius, 1.4}, 3), 1.4, kPost);
    append(mesh, moved_up(shapes::sphere(0.2, 2), 3.1, kGlass), {});
    append(mesh, moved_up(shapes::sphere(0.09, 2), 3.1, kBulb), {});
    return mesh;
}

}  // namespace lodestone::lamps
