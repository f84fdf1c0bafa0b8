// SPDX-License-Identifier: GPL-3.0-or-later
// glTF meshes <-> Mesh: Y up <-> Z up, v down <-> v up, primitives <-> slots.
//
// Ours are written so that they come back bit for bit, and marked in mesh.extras.lodestone:
//   version  1
//   slots    the slot of each primitive, in order of first use (absent: the mesh has no slots)
//   order    accessor of the slot of each triangle (absent: triangles are sorted as primitives are)
// Where v does not survive 1 - (1 - v), the attribute _LODESTONE_V has the true one. Colors that
// the material does not use are _LODESTONE_COLOR: glTF would multiply by COLOR_0.
#pragma once

#include "model/mesh.h"

#include <optional>
#include <span>
#include <string>

namespace tinygltf {
class Model;
struct Mesh;
}  // namespace tinygltf

namespace lodestone::format {

/// The material that a slot of a mesh is written with.
struct SlotMaterial {
    int index = -1;  // into the file's materials, or none
    bool vertex_colors = false;
};

/// Adds a mesh and returns its index, or -1 for one without vertices. Slots beyond `materials` have
/// none. A mesh without triangles becomes points. Throws Error(InvalidArgument) for numbers that
/// are not finite.
int add_mesh(tinygltf::Model& model, const Mesh& mesh, std::span<const SlotMaterial> materials,
             const std::string& name);

struct ReadMesh {
    Mesh mesh;
    std::vector<int> materials;  // by slot, into the file's materials or -1; not checked
};

/// The mesh, not repaired, when all is as add_mesh() writes it; else nothing.
std::optional<ReadMesh> own_mesh(const tinygltf::Model& model, const tinygltf::Mesh& from);

/// The numbers of vertices and triangles that may still be read of a file.
struct GltfReadBudget {
    uint64_t vertices = 0;
    uint64_t triangles = 0;
};

/// Reads any mesh: lists, strips and fans of triangles. Primitives that are broken or no triangles
/// are left out with a problem of `name`.
ReadMesh foreign_mesh(const tinygltf::Model& model, const tinygltf::Mesh& from,
                      const std::string& name, GltfReadBudget& budget, Problems& problems);

}  // namespace lodestone::format
