// SPDX-License-Identifier: GPL-3.0-or-later
// The model as text: tileset.json with our own description inside (asset.extras.lodestone).
#pragma once

#include "model/model.h"

#include <set>
#include <string>

namespace lodestone::segment {

/// The number of the description's format.
/// Law: raised with every change that earlier readers would misread.
inline constexpr int kStoreFormat = 3;

/// The name of a mesh's file: "r/<16 hex>.glb".
std::string file_of(Hash hash);
/// The name of the file of bound levels: "b/<16 hex>.bound".
std::string bound_file_of(Hash bind_hash);
/// The name of the file of a surface level's chunks: "r/<16 hex>.chunks".
std::string chunk_file_of(const SurfaceLevel& level);
/// The name of a picture's file: "i/<16 hex>.png", ".jpg" or ".exr".
std::string file_of(const Picture& picture);
/// The names of the files of every representation, bound levels and pictures of a model.
std::set<std::string> files_of(const Model& model);

/// Our own description, the value of asset.extras.lodestone, in two parts, one after the other.
/// Doubles keep their bits.
struct DescriptionText {
    std::string objects;
    std::string view;  // cameras, lights and the world
};
DescriptionText description_text(const Model& model);

/// The first part of tileset.json, up to the end of our description (or of its objects alone). All
/// that follows is made of what the description says.
std::string tileset_head(const DescriptionText& description, bool with_view = true);
/// The whole tileset.json. Doubles are written so that reading gives the same bits.
std::string tileset_text(const Model& model, const DescriptionText& description);
inline std::string tileset_text(const Model& model) {
    return tileset_text(model, description_text(model));
}

/// A description by itself, and what it describes. Throws as model_of_tileset().
std::string described(const Model& model);
Model model_of_description(const std::string& text);

/// The model described in a tileset.json; meshes and pictures not resident. Throws Error(BadFile)
/// saying what is wrong; nothing in the text is trusted.
Model model_of_tileset(const std::string& text);

}  // namespace lodestone::segment
