// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/cut.h"

#include "choose/cut_chooser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

namespace lodestone::choose {
namespace {

ObjectIndex root_of(const Model& model) {
    if (model.root >= model.objects.size())
        fail(Status::InvalidArgument, "the model has no root object");
    return model.root;
}

}  // namespace

Cut choose_cut(const Model& model, const View& view, const Job& job) {
    return choose_below(model, root_of(model), view, job);
}

Cut choose_below(const Model& model, ObjectIndex root, const View& view, const Job& job) {
    ChoiceTable table(model, view.kinds);
    return choose_below(table, root, view, job);
}

Cut choose_below(ChoiceTable& table, ObjectIndex root, const View& view, const Job& job) {
    refuse_nonsense(view);
    if (table.kinds() != view.kinds)
        fail(Status::Internal, "the table was made for other kinds");
    const uint32_t top = table.row_of(root);
    FactorField field(table.model(), view);
    Cut cut;
    CutChooser(table, &table, view, field, job).run(top, {}, cut);
    return cut;
}

std::optional<Cut> choose_cut_if_within(const ChoiceTable& table, const View& view,
                                        const CutBudget& budget, const Job& job) {
    refuse_nonsense(view);
    if (table.kinds() != view.kinds)
        fail(Status::Internal, "the table was made for other kinds");
    FactorField field(table.model(), view);
    CutChooser chooser(table, nullptr, view, field, job);
    Cut cut;
    if (!chooser.run(table.find(root_of(table.model())), budget, cut))
        return std::nullopt;
    return cut;
}

Cut choose_cut(const ChoiceTable& table, const View& view, const Job& job) {
    return choose_cut_if_within(table, view, {}, job).value();
}

std::vector<LevelUse> level_uses(const Cut& cut) {
    // Law: LOD numbers have 32 bits.
    constexpr unsigned kLodBits = 32;
    std::unordered_map<uint64_t, uint64_t> uses;
    std::pair<const uint64_t, uint64_t>* last = nullptr;  // neighbors are often drawn alike
    for (const uint32_t index : cut.chosen) {
        const CutNode& node = cut.nodes[index];
        const uint64_t key = uint64_t{node.object} << kLodBits | node.lod;
        if (last == nullptr || last->first != key)
            last = &*uses.try_emplace(key, 0).first;
        ++last->second;
    }
    std::vector<LevelUse> found;
    found.reserve(uses.size());
    for (const auto& [key, occurrences] : uses)
        found.push_back(
            {static_cast<ObjectIndex>(key >> kLodBits), static_cast<uint32_t>(key), occurrences});
    std::sort(found.begin(), found.end(), [](const LevelUse& a, const LevelUse& b) {
        return std::pair(a.object, a.lod) < std::pair(b.object, b.lod);
    });
    return found;
}

double error_on_screen(const ChoiceTable& table, const View& view, const Cut& cut,
                       const CutNode& node) {
    if (node.opened)
        return 0;
    const uint32_t index = table.find(node.object);
    const TableRow& row = table.row(index);
    const Affine& world = cut.world(node);
    const double enlarge = stretch(world);
    for (uint32_t i = 0; i < row.level_count; ++i) {
        const TableLevel& level = table.level(row.first_level + i);
        if (level.lod == node.lod)
            return error_on_screen(
                view, level.error, enlarge,
                distance_of(table.bound(index), world, enlarge, view.camera.position));
    }
    fail(Status::InvalidArgument, "the cut was made from another table");
}

FactorField::FactorPath path_to(const FactorField& field, const FactorField::FactorPath& group,
                                const Model& model, const Cut& cut, const CutNode& node) {
    if (node.parent == kNoParent)
        return group;
    const CutNode& above = cut.nodes.at(node.parent);
    return field.below(group, cut.world(above),
                       model.objects.at(above.object)
                           .representations.at(0)
                           .assembly()
                           .placements.at(node.placement));
}

ChoiceReason explain_choice(const Model& model, const View& view, const Cut& cut, uint32_t index) {
    // The path from the root, so that the lenses that touch it are found as when it was chosen.
    std::vector<uint32_t> way;
    for (uint32_t at = index; at != kNoParent; at = cut.nodes.at(at).parent)
        way.push_back(at);
    FactorField field(model, view);
    FactorField::FactorPath path = field.root();
    ChoiceReason reason;
    for (size_t i = way.size(); i-- > 0;) {
        const CutNode& node = cut.nodes[way[i]];
        path = path_to(field, path, model, cut, node);
        DetailFactors factors;
        OccurrenceSight seen;
        const OccurrenceSight* sight = &seen;
        const Object& object = model.objects.at(node.object);
        const Affine& world = cut.world(node);
        if (!find_sight(view, field, {node, world}, object.group(), object.bound(), object.demand,
                        stretch(world), path, seen, factors))
            fail(Status::InvalidArgument, "the cut was made for another view");
        const size_t first = i == 0 ? node.lod + size_t{1} : size_t{1};
        for (size_t lod = first; lod < object.representations.size(); ++lod) {
            const RepresentationSummary& summary = object.representations[lod].summary;
            if ((view.kinds & mask_of(summary.kind)) == 0)
                continue;
            reason.coarser = ChoiceReason::ReasonLevel{
                node.object,
                static_cast<uint32_t>(lod),
                summary.kind,
                summary.error,
                error_on_screen(view, summary.error, sight->stretch, sight->z),
                sight->total};
            reason.pinned = lod > node.coarsest;
            break;
        }
        if (i > 0)
            continue;
        const RepresentationSummary& summary = object.representations.at(node.lod).summary;
        reason.z = std::max(sight->z, view.camera.near_clip);
        reason.pixel = pixel_size(view, sight->z);
        reason.stretch = sight->stretch;
        reason.factors = factors;
        reason.chosen = {node.object,
                         node.lod,
                         node.kind,
                         summary.error,
                         error_on_screen(view, summary.error, sight->stretch, sight->z),
                         sight->total};
    }
    return reason;
}

namespace {

/// `name`: a function that gives the name of a node's placement.
template <typename Name>
std::string joined_names(const Cut& cut, uint32_t node, const Name& name) {
    std::vector<const std::string*> names;
    size_t length = 0;
    for (uint32_t at = node; at != kNoParent && cut.nodes.at(at).parent != kNoParent;
         at = cut.nodes[at].parent) {
        names.push_back(&name(cut.nodes[cut.nodes[at].parent], cut.nodes[at].placement));
        length += names.back()->size() + 1;
    }
    std::string path;
    path.reserve(length);
    for (size_t i = names.size(); i-- > 0;) {
        path += *names[i];
        if (i > 0)
            path += '/';
    }
    return path;
}

}  // namespace

std::string path_of(const Model& model, const Cut& cut, uint32_t node) {
    return joined_names(
        cut, node, [&](const CutNode& group, uint32_t position) -> const std::string& {
            const Representation& finest = model.objects[group.object].representations[0];
            return finest.assembly().placements[position].name;
        });
}

std::string path_of(const ChoiceTable& table, const Cut& cut, uint32_t node) {
    return joined_names(
        cut, node, [&](const CutNode& group, uint32_t position) -> const std::string& {
            return table.assembly(table.find(group.object)).placements[position].name;
        });
}

}  // namespace lodestone::choose
