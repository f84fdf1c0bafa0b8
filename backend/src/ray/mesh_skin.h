// SPDX-License-Identifier: GPL-3.0-or-later
// MeshSkin: the colors of a mesh's points, from its materials, their textures and vertex colors.
#pragma once

#include "image/decoded_texels.h"
#include "model/material.h"
#include "model/mesh.h"

#include <memory>
#include <optional>
#include <span>

namespace lodestone::ray {

/// The appearance of one point, in the terms of Material. A mixture shows the mean of its
/// materials.
struct SurfaceAppearance {
    glm::dvec3 color{0.8};
    glm::dvec3 emission{0.0};
    double roughness = 0.5;
    double metallic = 0;
    double specular = 0.5;
};

/// Materials made ready to be looked up at points of meshes: of the finest mesh, and of levels that
/// share its materials. Without texture coordinates a material's means count, without vertex colors
/// white. Points are given like those of ray::RayHit. Const methods may be called from any thread.
class MeshSkin {
public:
    /// `materials` are by slot; a slot without one looks like Material{}. Throws Error(BadFile)
    /// naming a picture that cannot be decoded.
    MeshSkin(std::span<const Material> materials, image::TexelCache& texels);
    ~MeshSkin();
    MeshSkin(const MeshSkin&) = delete;
    MeshSkin& operator=(const MeshSkin&) = delete;
    /// The material of a slot.

    const Material& material(uint16_t slot) const;

    /// Whether points of one triangle of the slot may show different things.
    bool varies(const Mesh& mesh, uint16_t slot) const;
    /// Whether triangles of the slot need the texture coordinates they have, for anything at all.
    bool textured(const Mesh& mesh, uint16_t slot) const;
    /// Whether any point of the mesh may cover less than everything behind it.
    bool see_through(const Mesh& mesh) const;

    /// The appearance by the slot's constants alone: of a point without texture coordinates and
    /// color.
    /// The appearance of a point.
    SurfaceAppearance mean(uint16_t slot) const;
    SurfaceAppearance at(const Mesh& mesh, uint32_t triangle, double u, double v) const;
    /// The share of what is behind the point that it covers, 0...1.
    double alpha(const Mesh& mesh, uint32_t triangle, double u, double v) const;
    /// The alpha of all points of the slot's triangles, where they have the same; else none.
    std::optional<double> uniform_alpha(const Mesh& mesh, uint16_t slot) const;
    /// The part of alpha at a point that is not transmitted, 0...1.
    double opacity(const Mesh& mesh, uint32_t triangle, double u, double v) const;
    /// Whether any of the materials transmits anything.
    bool transmits() const;

private:
    struct Slot;
    const Slot& slot(uint16_t index) const;

    std::vector<Slot> slots_;
    std::unique_ptr<Slot> otherwise_;
};

using SkinPtr = std::shared_ptr<const MeshSkin>;

/// The texture coordinates of a point; the mesh must have some.
glm::dvec2 uv_at(const Mesh& mesh, uint32_t triangle, double u, double v);

}  // namespace lodestone::ray
