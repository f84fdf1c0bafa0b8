// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/run/stored_stand_ins.h"

#include <algorithm>
#include <utility>

namespace lodestone::hierarchy {
namespace {

/// Whether the pictures of its stand-ins' own materials are there; those of the finest are the
/// caller's. `shown`: by material, whether its are.
bool shows(const Object& object, const std::vector<uint8_t>& shown) {
    if (object.representations.empty())
        return true;
    const std::vector<uint32_t>& given = object.representations[0].materials;
    for (size_t lod = 1; lod < object.representations.size(); ++lod) {
        for (const uint32_t material : object.representations[lod].materials) {
            if (shown.at(material) == 0 &&
                std::find(given.begin(), given.end(), material) == given.end())
                return false;
        }
    }
    return true;
}

}  // namespace

StoredStandIns::StoredStandIns(const segment::Store& store, bool ignore)
    : store_(store), ignore_(ignore || !store.exists()) {
    if (ignore_)
        return;
    try {
        list(store.read_shared());
    } catch (const Error&) {
        ignore_ = true;
    }
}

void StoredStandIns::list(const std::shared_ptr<const Model>& model) const {
    models_.push_back(model);
    std::vector<uint8_t> shown;
    for (const Material& material : model->materials)
        shown.push_back(store_.has_pictures(material) ? 1 : 0);
    for (const Object& object : model->objects) {
        if (object.build_hash != 0 && store_.has_stand_ins(object) && shows(object, shown))
            by_hash_.emplace(object.build_hash, StoredObject{model.get(), &object});
    }
}

bool StoredStandIns::adopt(Model& model, ObjectIndex index, Hash build_hash,
                           MaterialPalette& palette) const {
    if (ignore_)
        return false;
    if (adopt_listed(model, index, build_hash, palette))
        return true;
    if (models_.size() > 1)
        return false;
    list(store_.read_earlier());
    return adopt_listed(model, index, build_hash, palette);
}

bool StoredStandIns::adopt_listed(Model& model, ObjectIndex index, Hash build_hash,
                                  MaterialPalette& palette) const {
    const Object& object = model.objects[index];
    const auto [first, last] = by_hash_.equal_range(build_hash);
    for (auto at = first; at != last; ++at) {
        if (at->second.object->source_hash == object.source_hash) {
            take(at->second, model.objects[index], palette);
            return true;
        }
    }
    for (auto at = first; at != last && !object.deforms; ++at) {
        const auto changed =
            ChangedFinishes::between(*at->second.model, *at->second.object, model, index);
        if (changed && take(at->second, *changed, model, index, palette))
            return true;
    }
    return false;
}

void StoredStandIns::take(const StoredObject& stored, Object& object, MaterialPalette& palette) {
    const Object& from = *stored.object;
    const auto number_of = [&](uint32_t material) {
        return palette.index_of(stored.model->materials.at(material));
    };
    object.build_hash = from.build_hash;
    object.bind_hash = from.bind_hash;
    object.attributes = from.attributes;
    for (const SourceMaterial& source : from.sources)
        object.sources.push_back({number_of(source.material), source.plain});
    object.representations[0].surface = from.representations[0].surface;
    for (size_t lod = 1; lod < from.representations.size(); ++lod) {
        Representation& level = object.representations.emplace_back(from.representations[lod]);
        std::transform(level.materials.begin(), level.materials.end(), level.materials.begin(),
                       number_of);
    }
}

bool StoredStandIns::take(const StoredObject& stored, const ChangedFinishes& changed, Model& model,
                          ObjectIndex index, MaterialPalette& palette) const {
    const Object& from = *stored.object;
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
    object.representations[0].surface = from.representations[0].surface;
    for (Representation& level : levels) {
        const Representation before = level;
        for (size_t slot = 0; slot < level.materials.size(); ++slot)
            level.materials[slot] = palette.index_of(
                changed.changed(before, slot, stored.model->materials.at(before.materials[slot])));
        summarize(level, model);
        object.representations.push_back(std::move(level));
    }
    return true;
}

}  // namespace lodestone::hierarchy
