// SPDX-License-Identifier: GPL-3.0-or-later
// Stored stand-ins: those that a store has already, found by what they were built from.
#pragma once

#include "hierarchy/run/changed_finishes.h"
#include "hierarchy/run/material_palette.h"
#include "segment/store.h"

#include <map>

namespace lodestone::hierarchy {

class StoredStandIns {
public:
    /// The store must outlive it. Empty with `ignore`, and where the store cannot be read or is of
    /// another version: then everything is built again.
    StoredStandIns(const segment::Store& store, bool ignore);

    /// Gives an object the stand-ins of this build hash, or those that the store held before; the
    /// finest representation stays ours. Where materials have other finishes, so have those of its
    /// stand-ins, which are then what a build would make. What it places must have its own
    /// stand-ins already. False when there are none, a file of them is gone, or materials that were
    /// one are now two, or the other way.
    bool adopt(Model& model, ObjectIndex index, Hash build_hash, MaterialPalette& palette) const;

private:
    /// An object of the store, and the model that it is in.
    struct StoredObject {
        const Model* model;
        const Object* object;
    };
    using StoredObjects = std::multimap<Hash, StoredObject>;  // by build hash

    void list(const std::shared_ptr<const Model>& model) const;
    bool adopt_listed(Model& model, ObjectIndex index, Hash build_hash,
                      MaterialPalette& palette) const;
    static void take(const StoredObject& from, Object& object, MaterialPalette& palette);
    bool take(const StoredObject& from, const ChangedFinishes& changed, Model& model,
              ObjectIndex index, MaterialPalette& palette) const;

    const segment::Store& store_;
    bool ignore_;
    /// Read when they are asked for; not safe from several threads.
    mutable std::vector<std::shared_ptr<const Model>> models_;
    mutable StoredObjects by_hash_;
};

}  // namespace lodestone::hierarchy
