// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/run/material_palette.h"

namespace lodestone::hierarchy {

MaterialPalette::MaterialPalette(Model& model) : model_(model) {
    for (uint32_t i = 0; i < model.materials.size(); ++i)
        by_hash_.try_emplace(hash_of(model.materials[i]), i);
}

uint32_t MaterialPalette::index_of(const Material& material) {
    const auto [at, fresh] =
        by_hash_.try_emplace(hash_of(material), static_cast<uint32_t>(model_.materials.size()));
    if (fresh)
        model_.materials.push_back(material);
    return at->second;
}

}  // namespace lodestone::hierarchy
