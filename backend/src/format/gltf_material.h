// SPDX-License-Identifier: GPL-3.0-or-later
// glTF materials <-> Material.
#pragma once

#include "base/error.h"
#include "model/material.h"

#include <string>
#include <vector>

namespace tinygltf {
class Model;
}

namespace lodestone::format {

/// All of the file, then the one for parts without any. Factors times the mean of their textures;
/// emission times KHR_materials_emissive_strength; specular from extras.lodestone.
std::vector<Material> read_materials(const tinygltf::Model& model, const std::string& name,
                                     Problems& problems);

/// Returns its index. Base colors are clamped to 0...1, as glTF asks.
int add_material(tinygltf::Model& model, const Material& material);

/// The same text with bytes that are no UTF-8 replaced by U+FFFD.
std::string valid_utf8(const std::string& name);

}  // namespace lodestone::format
