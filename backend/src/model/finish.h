// SPDX-License-Identifier: GPL-3.0-or-later
// Finish: the part of a material that no level is chosen by, nor any shape: gloss, bumps, and the
// like. Levels of other finishes are the same but for these.
#pragma once

#include "model/attributes.h"
#include "model/material.h"

#include <span>
#include <vector>

namespace lodestone {

/// The hash of all of a material but its finish and name. Where light passes through, what bends
/// and stops it counts, too; of pictures of the finish whether there is one.
Hash look_hash_of(const Material& material);

/// A material with the finish of another one, which has the same look hash but for colors.
Material with_finish(Material material, const Material& finish);

/// The finish that solids have.
struct SolidFinish {
    double roughness = 0;
    double metallic = 0;
    double specular = 0;
};
/// The mean of what a material is mixed of, without its pictures.
SolidFinish mean_finish(const Material& material);
/// The mean by shares; `material_of` gives the material of a slot.
template <typename MaterialOf>
SolidFinish mean_finish(std::span<const SlotShare> shares, const MaterialOf& material_of) {
    SolidFinish out;
    for (const SlotShare& one : shares) {
        const SolidFinish own = mean_finish(material_of(one.slot));
        out.roughness += one.share * own.roughness;
        out.metallic += one.share * own.metallic;
        out.specular += one.share * own.specular;
    }
    return out;
}
void set_finish(Attributes& attributes, const SolidFinish& finish);
/// Kept within the limits of a material.
void set_finish(Material& material, const SolidFinish& finish);

/// A material as a mesh without texture coordinates shows it.
Material without_textures(Material material);

}  // namespace lodestone
