// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/earlier_levels.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace lodestone::segment {
namespace {

/// The objects that are kept in any case, as far as their bytes allow.
/// Taste: an edit of a part of a large scene; a larger number makes the list slow to read.
constexpr size_t kFewObjects = 1000;

using StandInsKey = std::pair<Hash, Hash>;

StandInsKey key_of(const Object& object) {
    return {object.build_hash, object.source_hash};
}

/// Copies objects with their materials.
class ObjectCopies {
public:
    void add(const Model& from, const Object& object) {
        Object copy = object;
        for (Representation& level : copy.representations) {
            for (uint32_t& material : level.materials)
                material = number_of(from, material);
        }
        for (SourceMaterial& source : copy.sources)
            source.material = number_of(from, source.material);
        if (copy.group())
            copy.representations[0].payload = std::make_shared<const Assembly>();
        out.objects.push_back(std::move(copy));
    }

    Model out;

private:
    uint32_t number_of(const Model& from, uint32_t material) {
        const auto [at, fresh] =
            numbers_.try_emplace(hash_of(from.materials.at(material)), out.materials.size());
        if (fresh)
            out.materials.push_back(from.materials[material]);
        return static_cast<uint32_t>(at->second);
    }

    std::map<Hash, size_t> numbers_;
};

}  // namespace

Model earlier_levels(const Model& now, const Model& before, const Model& earlier, uint64_t most,
                     const std::function<uint64_t(const Representation&)>& bytes_of) {
    std::set<StandInsKey> known;
    for (const Object& object : now.objects)
        known.insert(key_of(object));
    ObjectCopies copies;
    uint64_t bytes = 0;
    for (const Model* model : {&before, &earlier}) {
        for (const Object& object : model->objects) {
            if (object.build_hash == 0 || object.bind_hash != 0 ||
                object.representations.size() < 2 || !known.insert(key_of(object)).second)
                continue;
            for (const Representation& level : object.representations)
                bytes += level.summary.kind == Kind::Assembly ? 0 : bytes_of(level);
            if (bytes > most ||
                copies.out.objects.size() >= std::max(kFewObjects, now.objects.size()))
                return std::move(copies.out);
            copies.add(*model, object);
        }
    }
    return std::move(copies.out);
}

}  // namespace lodestone::segment
