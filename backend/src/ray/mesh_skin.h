// SPDX-License-Identifier: GPL-3.0-or-later
// MeshSkin: what the points of a mesh look like: its materials with their textures and vertex colors.
#pragma once

#include "image/decoded_texels.h"
#include "model/material.h"
#include "model/mesh.h"

#include <memory>
#include <optional>
#include <span>

namespace lodestone::ray {

/// What one point shows, in the terms of Material. A mixture shows the mean of what it mixes.
struct SurfaceAppearance {
    glm::dvec3 color{0.8};
    glm::dvec3 emission{0.0};
    double roughness = 0.5;
    double metallic = 0;
    double specular = 0.5;
};

/// Materials made ready to be looked up at points of meshes: the finest's, and those of levels that
/// share its materials. Without texture coordinates a material's means count, without vertex colors
/// white. Points are given as for ray::RayHit. Const methods may be called from any thread.
class MeshSkin {
public:
    /// `materials` by slot; a slot without one looks like Material{}. Throws Error(BadFile) naming
    /// a picture that cannot be decoded.
    MeshSkin(std::span<const Material> materials, image::TexelCache& texels);
    ~MeshSkin();
    MeshSkin(const MeshSkin&) = delete;
    MeshSkin& operator=(const MeshSkin&) = delete;

    const Material& material(uint16_t slot) const;

    /// Whether points of one triangle of the slot may show different things.
    bool varies(const Mesh& mesh, uint16_t slot) const;
    /// Whether its triangles need the texture coordinates they have, for whatever.
    bool textured(const Mesh& mesh, uint16_t slot) const;
    /// Whether any point of the mesh may cover less than everything behind it.
    bool see_through(const Mesh& mesh) const;

    /// Of the slot's constants: what a point shows that has neither texture coordinates nor color.
    SurfaceAppearance mean(uint16_t slot) const;
    SurfaceAppearance at(const Mesh& mesh, uint32_t triangle, double u, double v) const;
    /// 0...1: how much of what is behind the point is covered by it.
    double alpha(const Mesh& mesh, uint32_t triangle, double u, double v) const;
    /// The alpha of all points of the slot's triangles, where they have the same.
    std::optional<double> uniform_alpha(const Mesh& mesh, uint16_t slot) const;
    /// Of alpha, what is not transmitted.
    double opacity(const Mesh& mesh, uint32_t triangle, double u, double v) const;
    /// Whether any of its materials transmits anything.
    bool transmits() const;

private:
    struct Slot;
    const Slot& slot(uint16_t index) const;

    std::vector<Slot> slots_;
    std::unique_ptr<Slot> otherwise_;
};

using SkinPtr = std::shared_ptr<const MeshSkin>;

/// Texture coordinates of a point; the mesh must have some.
glm::dvec2 uv_at(const Mesh& mesh, uint32_t triangle, double u, double v);

}  // namespace lodestone::ray
