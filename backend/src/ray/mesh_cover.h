// SPDX-License-Identifier: GPL-3.0-or-later
// MeshCover: where a see-through mesh is there, and where rays pass.
#pragma once

#include "ray/mesh_skin.h"

#include <optional>

namespace lodestone::ray {

/// Keeps of the mesh what it needs. Any thread.
class MeshCover {
public:
    MeshCover(const Mesh& mesh, SkinPtr skin);

    /// As the MeshScene's.
    bool ends_ray(uint32_t triangle, double u, double v) const;
    bool shows(uint32_t triangle, double u, double v) const;
    std::optional<double> uniform_alpha(uint32_t triangle) const;

private:
    Mesh mesh_;  // without positions
    SkinPtr skin_;
};

}  // namespace lodestone::ray
