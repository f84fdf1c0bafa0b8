// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text.h"
#include "format/gltf/glb.h"
#include "format/gltf/gltf_file.h"
#include "format/gltf/gltf_material.h"
#include "format/gltf/gltf_mesh.h"

#include <tiny_gltf.h>

#include <cmath>

namespace lodestone::format {

std::string write_glb_mesh(const Mesh& mesh, std::span<const Material> materials_by_slot,
                           const std::string& name) {
    tinygltf::Model out;
    out.asset.version = "2.0";
    out.asset.generator = "Lodestone";
    out.scenes.emplace_back();
    out.defaultScene = 0;
    std::vector<uint8_t> used(materials_by_slot.size(), 0);
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (mesh.slot(i) < used.size())
            used[mesh.slot(i)] = 1;
    }
    MaterialWriter writer(out, false);
    std::vector<SlotMaterial> materials(used.size());
    for (size_t slot = 0; slot < used.size(); ++slot) {
        if (used[slot])
            materials[slot] = {writer.add(materials_by_slot[slot], !mesh.uvs.empty()),
                               materials_by_slot[slot].vertex_colors};
    }
    tinygltf::Node node;
    node.name = valid_utf8(name);
    node.mesh = add_mesh(out, mesh, materials, node.name);
    if (node.mesh >= 0) {
        out.nodes.push_back(std::move(node));
        out.scenes[0].nodes.push_back(0);
    }
    return save_glb(out);
}

Mesh read_glb_mesh(std::string_view bytes) {
    const std::string name = "mesh";
    tinygltf::Model from;
    load_gltf(from, bytes, {}, name);
    if (from.meshes.empty() && from.asset.generator == "Lodestone")
        return {};
    std::optional<ReadMesh> read;
    if (from.meshes.size() == 1)
        read = own_mesh(from, from.meshes[0]);
    if (!read)
        fail(Status::BadFile, "the GLB does not hold one mesh as Lodestone writes it");
    Mesh* const mesh = &read->mesh;
    check(*mesh);
    for (size_t i = 0; i < mesh->positions.size(); ++i) {
        for (int c = 0; c < 4; ++c) {
            if (!std::isfinite(mesh->positions[i][c % 3]) ||
                (!mesh->normals.empty() && !std::isfinite(mesh->normals[i][c % 3])) ||
                (!mesh->uvs.empty() && !std::isfinite(mesh->uvs[i][c % 2])) ||
                (!mesh->colors.empty() && !std::isfinite(mesh->colors[i][c])))
                fail(Status::BadFile, "the GLB's vertex ", i, " has a value that is not a number");
        }
    }
    return std::move(*mesh);
}

}  // namespace lodestone::format
