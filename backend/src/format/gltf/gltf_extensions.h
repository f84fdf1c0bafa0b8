// SPDX-License-Identifier: GPL-3.0-or-later
// glTF extensions that a file needs to be read at all, and what to do about those we do not know.
#pragma once

#include <string>
#include <string_view>

namespace tinygltf {
class Model;
struct Primitive;
}  // namespace tinygltf

namespace lodestone::format {

/// Throws Error(BadFile) naming `name`, every extension that the file requires and we do not read,
/// and what writes the file without them.
void check_extensions(const tinygltf::Model& model, const std::string& name);

/// Throws Error(BadFile) when the data of a primitive is nowhere but in a Draco stream. Where plain
/// accessors are there as well, these are read.
void check_draco(const tinygltf::Model& model, const tinygltf::Primitive& primitive);

}  // namespace lodestone::format
