// SPDX-License-Identifier: GPL-3.0-or-later
// glTF files: bytes -> tinygltf's model with nothing decoded, guarded against hostile files; back.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tinygltf {
class Model;
}

namespace lodestone::format {

/// Loads GLB or glTF text, told by the first bytes. Buffers in files of their own are read only
/// from below `folder` (empty: none); pictures in files of their own are not read, those of data:
/// URIs stay encoded, in Image::image. Fallback buffers of EXT_meshopt_compression hold one byte:
/// what they would hold is unpacked by unpack_views(). References inside the model are not checked.
/// Throws Error(BadFile) naming `name`.
void load_gltf(tinygltf::Model& model, std::string_view bytes, const std::filesystem::path& folder,
               const std::string& name);

/// The model as GLB (a scene of nothing is removed first); its first buffer becomes the binary
/// chunk. Throws Error(InvalidArgument) when that has 2 GiB or more.
std::string save_glb(tinygltf::Model& model);

/// The path that a URI names: %41 becomes A.
std::string percent_decoded(std::string_view uri);

}  // namespace lodestone::format
