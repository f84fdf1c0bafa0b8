// SPDX-License-Identifier: GPL-3.0-or-later
// Changed finishes: what stand-ins of a store look like where materials have other finishes.
#pragma once

#include "model/finish.h"
#include "model/model.h"

#include <map>
#include <optional>

namespace lodestone::hierarchy {

/// The materials that stored stand-ins were made from, as they are now.
class ChangedFinishes {
public:
    /// For an object of the same build hash as a stored one. None where two materials have become
    /// one or one has become two: then a build makes other stand-ins. None either where what a
    /// group places has not its stand-ins yet, or where it is not known what a material is made of.
    static std::optional<ChangedFinishes> between(const Model& stored, const Object& from,
                                                  const Model& model, ObjectIndex index);

    /// The material of a slot of a stored stand-in, `before`, as it is now.
    Material changed(const Representation& level, size_t slot, const Material& before) const;
    /// Brings the means over the surface up to date.
    void change(Attributes& attributes) const;
    /// The number in the model of a material that a group was made from, by that in the store.
    uint32_t number_of(uint32_t stored_material) const { return numbers_.at(stored_material); }

private:
    std::vector<Material> sources_;  // by slot
    std::map<uint32_t, uint32_t> numbers_;
};

}  // namespace lodestone::hierarchy
