// SPDX-License-Identifier: GPL-3.0-or-later
// Stored stand-ins: those that a store has already, found by what they were built from.
#pragma once

#include "hierarchy/run/material_palette.h"
#include "segment/store.h"

#include <map>

namespace lodestone::hierarchy {

class StoredStandIns {
public:
    /// Empty with `ignore`, and where the store cannot be read or is of another version: then
    /// everything is built again.
    StoredStandIns(const segment::Store& store, bool ignore);

    /// The stored object of this build hash; null when there is none, or a file of it is gone.
    const Object* find(Hash build_hash) const;

    /// Takes over the stand-ins of what find() gave; the finest representation stays ours.
    void adopt(Object& object, const Object& stored, MaterialPalette& palette) const;

private:
    std::shared_ptr<const Model> stored_;
    std::map<Hash, const Object*> by_hash_;
};

}  // namespace lodestone::hierarchy
