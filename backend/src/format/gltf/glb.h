// SPDX-License-Identifier: GPL-3.0-or-later
// GLB and glTF 2.0 <-> Model; one mesh a GLB for the store.
#pragma once

#include "model/model.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace lodestone::format {

/// The default scene becomes the root "gltf:scene"; a node with children a group ("gltf:node:7"), a
/// mesh an object ("gltf:mesh:3", shared by all its nodes), a node with a mesh a placement. Y up is
/// turned to Z up, EXT_meshopt_compression is unpacked. Materials keep their textures, as far as
/// Material has words for them. Cameras and lights (KHR_lights_punctual) are read; skins and morphs
/// are not. Buffers and pictures beside the file are read from below `folder` (empty: none). What
/// is broken inside a readable file is left out with a problem. Throws Error(BadFile) naming
/// `name`, also for views that do not unpack and for extensions the file requires and we do not
/// know.
Model read_glb(std::string_view bytes, const std::filesystem::path& folder, const std::string& name,
               Problems& problems);

/// The finest representations: placements as nodes, meshes shared, primitives tessellated; a group
/// used twice is written as two nodes. Pictures are in the file, each once; what of a material glTF
/// cannot say is approximated for strangers, and in extras for us: materials come back bit for bit
/// but for names that are no UTF-8. A placement that shears or flattens becomes two nodes (glTF
/// nodes cannot shear). Throws Error(InvalidArgument) above 4 million nodes or 2 GiB.
std::string write_glb(const Model& model);

/// One mesh, for a store; valid glTF for everybody else. Pictures are named as the store's files,
/// "../i/<16 hex>.png"; what glTF cannot say of a texture counts as its mean, and what is to be
/// brighter than its picture is as bright as that.
std::string write_glb_mesh(const Mesh& mesh, std::span<const Material> materials_by_slot,
                           const std::string& name);

/// Exactly what write_glb_mesh was given, bit for bit. Throws Error(BadFile) for other files.
Mesh read_glb_mesh(std::string_view bytes);

}  // namespace lodestone::format
