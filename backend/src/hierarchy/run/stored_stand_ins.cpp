// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/run/stored_stand_ins.h"

#include <utility>

namespace lodestone::hierarchy {

StoredStandIns::StoredStandIns(const segment::Store& store, bool ignore) {
    if (ignore || !store.exists())
        return;
    try {
        stored_ = store.read_shared();
    } catch (const Error&) {
        return;
    }
    for (const Object& object : stored_->objects) {
        if (object.build_hash != 0 && store.has_stand_ins(object))
            by_hash_.try_emplace(object.build_hash, &object);
    }
}

const Object* StoredStandIns::find(Hash build_hash) const {
    const auto at = by_hash_.find(build_hash);
    return at == by_hash_.end() ? nullptr : at->second;
}

void StoredStandIns::adopt(Object& object, const Object& stored, MaterialPalette& palette) const {
    object.build_hash = stored.build_hash;
    object.bind_hash = stored.bind_hash;
    object.attributes = stored.attributes;
    for (size_t lod = 1; lod < stored.representations.size(); ++lod) {
        Representation representation = stored.representations[lod];
        for (uint32_t& material : representation.materials)
            material = palette.index_of(stored_->materials.at(material));
        object.representations.push_back(std::move(representation));
    }
}

}  // namespace lodestone::hierarchy
