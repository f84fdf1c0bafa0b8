// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/run/material_palette.h"

#include <algorithm>
#include <iterator>
#include <optional>

namespace lodestone::hierarchy {

MaterialPalette::MaterialPalette(Model& model) : model_(model), own_(model.materials.size()) {
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

void MaterialPalette::renumber(const std::vector<ObjectIndex>& order) {
    std::vector<Material> added(
        std::make_move_iterator(model_.materials.begin() + static_cast<std::ptrdiff_t>(own_)),
        std::make_move_iterator(model_.materials.end()));
    model_.materials.resize(own_);
    std::vector<std::optional<uint32_t>> numbers(added.size());
    const auto use = [&](uint32_t& material) {
        if (material < own_)
            return;
        std::optional<uint32_t>& number = numbers.at(material - own_);
        if (!number) {
            number = static_cast<uint32_t>(model_.materials.size());
            model_.materials.push_back(std::move(added[material - own_]));
        }
        material = *number;
    };
    for (const ObjectIndex index : order) {
        Object& object = model_.objects[index];
        for (Representation& level : object.representations)
            std::for_each(level.materials.begin(), level.materials.end(), use);
        for (SourceMaterial& source : object.sources)
            use(source.material);
    }
}

}  // namespace lodestone::hierarchy
