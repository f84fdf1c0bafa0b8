// SPDX-License-Identifier: GPL-3.0-or-later
// Material palette: the materials of a model, each content once.
#pragma once

#include "base/hash.h"
#include "model/model.h"

#include <cstdint>
#include <map>

namespace lodestone::hierarchy {

/// The list of a model's materials, found by content. Not safe from several threads.
class MaterialPalette {
public:
    /// A palette of the materials that the model has already; it must outlive the palette.
    explicit MaterialPalette(Model& model);

    /// The place of a material in the model's list, where it is added when its content is new; the
    /// name of the first stays.
    uint32_t index_of(const Material& material);

    /// Numbers what was added in the order in which the levels of `order` use it, whatever was
    /// built first, and drops what none uses. Ends the use of the palette.
    void renumber(const std::vector<ObjectIndex>& order);

private:
    Model& model_;
    size_t own_;  // the materials that the model has had before
    std::map<Hash, uint32_t> by_hash_;
};

}  // namespace lodestone::hierarchy
