// SPDX-License-Identifier: GPL-3.0-or-later
// Materials in extras.lodestone: what glTF has no words for, so that ours come back bit for bit.
//
//   of     16 hex: the hash of the material as its glTF words alone read. When they read otherwise
//          now, somebody has edited the file, and the rest is not believed.
//   <key>  every member of Material that differs from those words; a texture names its picture by
//          "image" or "view" (a buffer view) and by its hash; false is none.
#pragma once

#include "model/material.h"

namespace tinygltf {
class Value;
}

namespace lodestone::format {

class GltfPictureReader;
class GltfPictureWriter;

/// The extras that make `material` of `seen`; null when they are the same. Pictures that are needed
/// are added to the file; textures whose picture is not resident, numbers that are not finite and
/// mixtures of more than 32 are left out.
tinygltf::Value extras_of_material(const Material& material, const Material& seen,
                                   GltfPictureWriter& pictures);

/// Applies extras to the material that was seen. Returns false, and changes nothing, when they make
/// no sense or belong to another material.
bool apply_material_extras(const tinygltf::Value& words, GltfPictureReader& pictures,
                           Material& seen);

}  // namespace lodestone::format
