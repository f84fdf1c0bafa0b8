// SPDX-License-Identifier: GPL-3.0-or-later
// The model as text: tileset.json with our own description inside (asset.extras.lodestone).
#pragma once

#include "model/model.h"

#include <set>
#include <string>

namespace lodestone::segment {

/// "r/<16 hex>.glb"
std::string file_of(Hash hash);

/// The whole tileset.json. Doubles are written so that reading gives the same bits.
std::string tileset_text(const Model& model);

/// The model described in a tileset.json; meshes not resident. Throws Error(BadFile) saying what is
/// wrong; nothing in the text is trusted.
Model model_of_tileset(const std::string& text);

/// Hashes of all representation files a tileset.json names; empty when it cannot be read.
std::set<Hash> files_of_tileset(const std::string& text);

}  // namespace lodestone::segment
