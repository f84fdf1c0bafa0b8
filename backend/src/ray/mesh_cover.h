// SPDX-License-Identifier: GPL-3.0-or-later
// MeshCover: where a see-through mesh covers what is behind it, and where rays pass.
#pragma once

#include "ray/mesh_skin.h"

#include <optional>

namespace lodestone::ray {

/// The cover of one mesh. Keeps what it needs of the mesh. May be used from any thread.
class MeshCover {
public:
    MeshCover(const Mesh& mesh, SkinPtr skin);

    /// These three answer for the MeshScene's functions of the same names.
    bool ends_ray(uint32_t triangle, double u, double v) const;
    /// The same where the point's alpha() is known.
    static bool ends_ray(double alpha, uint32_t triangle, double u, double v);
    double alpha(uint32_t triangle, double u, double v) const;
    bool shows(uint32_t triangle, double u, double v) const;
    std::optional<double> uniform_alpha(uint32_t triangle) const;

private:
    Mesh mesh_;  // the mesh without positions
    SkinPtr skin_;
};

}  // namespace lodestone::ray
