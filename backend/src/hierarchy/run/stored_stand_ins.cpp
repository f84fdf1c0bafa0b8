// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/run/stored_stand_ins.h"

#include <algorithm>
#include <utility>

namespace lodestone::hierarchy {

StoredStandIns::StoredStandIns(const segment::Store& store, bool ignore) : store_(store) {
    if (ignore || !store.exists())
        return;
    try {
        stored_ = store.read_shared();
    } catch (const Error&) {
        return;
    }
    for (const Object& object : stored_->objects) {
        if (object.build_hash != 0 && store.has_stand_ins(object))
            by_hash_.emplace(object.build_hash, &object);
    }
}

bool StoredStandIns::adopt(Model& model, ObjectIndex index, Hash build_hash,
                           MaterialPalette& palette) const {
    const Object& object = model.objects[index];
    const auto [first, last] = by_hash_.equal_range(build_hash);
    for (auto at = first; at != last; ++at) {
        if (at->second->source_hash == object.source_hash) {
            take(*at->second, model.objects[index], palette);
            return true;
        }
    }
    for (auto at = first; at != last && !object.deforms; ++at) {
        const auto changed = ChangedFinishes::between(*stored_, *at->second, model, index);
        if (changed && take(*at->second, *changed, model, index, palette))
            return true;
    }
    return false;
}

void StoredStandIns::take(const Object& from, Object& object, MaterialPalette& palette) const {
    const auto number_of = [&](uint32_t material) {
        return palette.index_of(stored_->materials.at(material));
    };
    object.build_hash = from.build_hash;
    object.bind_hash = from.bind_hash;
    object.attributes = from.attributes;
    for (const SourceMaterial& source : from.sources)
        object.sources.push_back({number_of(source.material), source.plain});
    for (size_t lod = 1; lod < from.representations.size(); ++lod) {
        Representation& level = object.representations.emplace_back(from.representations[lod]);
        std::transform(level.materials.begin(), level.materials.end(), level.materials.begin(),
                       number_of);
    }
}

bool StoredStandIns::take(const Object& from, const ChangedFinishes& changed, Model& model,
                          ObjectIndex index, MaterialPalette& palette) const {
    std::vector<Representation> levels(from.representations.begin() + 1,
                                       from.representations.end());
    try {  // their files are others, for they hold the materials, too
        for (Representation& level : levels)
            store_.load(level);
    } catch (const Error&) {
        return false;
    }
    Object& object = model.objects[index];
    object.build_hash = from.build_hash;
    object.attributes = from.attributes;
    if (object.attributes)
        changed.change(*object.attributes);
    for (const SourceMaterial& source : from.sources)
        object.sources.push_back({changed.number_of(source.material), source.plain});
    for (Representation& level : levels) {
        const Representation stored = level;
        for (size_t slot = 0; slot < level.materials.size(); ++slot)
            level.materials[slot] = palette.index_of(
                changed.changed(stored, slot, stored_->materials.at(stored.materials[slot])));
        summarize(level, model);
        object.representations.push_back(std::move(level));
    }
    return true;
}

}  // namespace lodestone::hierarchy
