// SPDX-License-Identifier: GPL-3.0-or-later
// EXT_meshopt_compression: packed buffer views -> plain ones, in place.
#pragma once

#include <string>

namespace tinygltf {
class Model;
}

namespace lodestone::format {

/// Decodes each buffer view that EXT_meshopt_compression packs (attributes, triangles and indices;
/// octahedral, quaternion and exponential filters) into a buffer of its own, which the view names
/// afterwards. Counts, strides and ranges are checked before a byte is reserved; together views
/// become no larger than the codec can make of the file's bytes used once. Throws Error(BadFile)
/// naming `name` and the view.
/// source: Khronos, glTF extension EXT_meshopt_compression.
void unpack_views(tinygltf::Model& model, const std::string& name);

}  // namespace lodestone::format
