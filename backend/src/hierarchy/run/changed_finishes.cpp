// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/run/changed_finishes.h"

#include "hierarchy/proposers/collapse_levels.h"

#include <algorithm>
#include <set>
#include <utility>

namespace lodestone::hierarchy {
namespace {

/// Numbers that stand for each other, one for one.
template <typename Number>
class OneForOne {
public:
    /// False where either has another partner already.
    bool add(Number before, Number now) {
        return to_.try_emplace(before, now).first->second == now &&
               from_.try_emplace(now, before).first->second == before;
    }
    const std::map<Number, Number>& pairs() const { return to_; }

private:
    std::map<Number, Number> to_;
    std::map<Number, Number> from_;
};

/// Walks down two groups that place alike things alike, and pairs the materials of all levels.
class MaterialPairs {
public:
    MaterialPairs(const Model& stored, const Model& model) : stored_(stored), model_(model) {}

    bool add_below(const Object& before, const Object& now) {
        const auto& theirs = before.representations[0].assembly().placements;
        const auto& ours = now.representations[0].assembly().placements;
        if (theirs.size() != ours.size())
            return false;
        for (size_t i = 0; i < ours.size(); ++i) {
            if (known_.emplace(theirs[i].object, ours[i].object).second &&
                !add(stored_.objects[theirs[i].object], model_.objects[ours[i].object]))
                return false;
        }
        return true;
    }

    const std::map<uint32_t, uint32_t>& numbers() const { return numbers_.pairs(); }

private:
    bool add(const Object& before, const Object& now) {
        const std::vector<Representation>& theirs = before.representations;
        const std::vector<Representation>& ours = now.representations;
        if (theirs.size() != ours.size() || before.group() != now.group())
            return false;
        for (size_t lod = 0; lod < ours.size(); ++lod) {
            if (theirs[lod].materials.size() != ours[lod].materials.size())
                return false;
            for (size_t slot = 0; slot < ours[lod].materials.size(); ++slot) {
                if (!numbers_.add(theirs[lod].materials[slot], ours[lod].materials[slot]))
                    return false;
            }
        }
        return !now.group() || add_below(before, now);
    }

    const Model& stored_;
    const Model& model_;
    std::set<std::pair<ObjectIndex, ObjectIndex>> known_;
    OneForOne<uint32_t> numbers_;
};

/// Whether it is known of all materials of a stand-in what they are made of.
bool is_known(const Representation& level, size_t sources) {
    const size_t own = level.materials.size() - level.means.size();
    return level.means.size() <= level.materials.size() && (own == 0 || own == sources);
}

}  // namespace

std::optional<ChangedFinishes> ChangedFinishes::between(const Model& stored, const Object& from,
                                                        const Model& model, ObjectIndex index) {
    const Object& object = model.objects[index];
    if (object.group() != from.group())
        return std::nullopt;
    ChangedFinishes out;
    if (object.group()) {
        MaterialPairs pairs(stored, model);
        if (!pairs.add_below(from, object))
            return std::nullopt;
        out.numbers_ = pairs.numbers();
        for (const SourceMaterial& source : from.sources) {
            const auto at = out.numbers_.find(source.material);
            if (at == out.numbers_.end())
                return std::nullopt;
            const Material& now = model.materials.at(at->second);
            out.sources_.push_back(source.plain ? without_textures(now) : now);
        }
    } else {
        const std::vector<Material> before = materials_of(stored, from.representations[0]);
        out.sources_ = materials_of(model, object.representations[0]);
        if (before.size() != out.sources_.size())
            return std::nullopt;
        OneForOne<Hash> contents;
        for (size_t slot = 0; slot < before.size(); ++slot) {
            if (!contents.add(hash_of(before[slot]), hash_of(out.sources_[slot])))
                return std::nullopt;
        }
    }
    for (size_t lod = 1; lod < from.representations.size(); ++lod) {
        if (!is_known(from.representations[lod], out.sources_.size()))
            return std::nullopt;
    }
    return out;
}

Material ChangedFinishes::changed(const Representation& level, size_t slot,
                                  const Material& before) const {
    const size_t own = level.materials.size() - level.means.size();
    if (slot < own)
        return with_finish(before, sources_[slot]);
    Material out = before;
    set_finish(out, mean_finish(level.means[slot - own], [&](uint16_t source) {
                   return source < sources_.size() ? sources_[source] : Material{};
               }));
    return out;
}

void ChangedFinishes::change(Attributes& attributes) const {
    set_finish(attributes, mean_finish(attributes.shares, [&](uint16_t source) {
                   return source < sources_.size() ? sources_[source] : Material{};
               }));
}

}  // namespace lodestone::hierarchy
