// SPDX-License-Identifier: GPL-3.0-or-later
#include "capi/chosen.h"

#include "base/parallel.h"

#include <map>

namespace lodestone::capi {

void require_made_from(const lds_model& model, const lds_cut& cut) {
    if (cut.generation != model.generation)
        fail(Status::StaleId, "the cut belongs to another model");
}

void require_current(const lds_model& model, const lds_cut& cut) {
    require_made_from(model, cut);
    if (cut.structured != model.structured)
        fail(Status::StaleId, "the cut was made before the model's groups changed");
}

std::vector<Representation>& levels_with(lds_model& model, const choose::CutNode& node,
                                         uint32_t lod) {
    std::vector<Object>& objects = model.model.objects;
    if (node.object >= objects.size() || lod >= objects[node.object].representations.size())
        fail(Status::StaleId, "the cut was made before the model's levels changed");
    return objects[node.object].representations;
}

uint32_t node_at(const lds_model& model, const lds_cut& cut, size_t position) {
    require_current(model, cut);
    if (position >= cut.cut.chosen.size())
        fail(Status::InvalidArgument, "choice ", position, " of ", cut.cut.chosen.size());
    return cut.cut.chosen[position];
}

void load_levels(lds_model& model, const choose::Cut& cut, const std::vector<uint32_t>& levels,
                 const Job& job) {
    std::map<Hash, std::vector<Representation*>> wanted;
    for (size_t i = 0; i < levels.size(); ++i) {
        if (levels[i] == view::kBoxOnly)
            continue;
        const choose::CutNode& node = cut.nodes.at(cut.chosen.at(i));
        Representation& chosen = levels_with(model, node, levels[i])[levels[i]];
        if (!chosen.resident())
            wanted[chosen.summary.hash].push_back(&chosen);
    }
    if (wanted.empty())
        return;
    if (!model.store)
        fail(Status::Internal, "chosen meshes are neither in memory nor in a store");
    std::vector<std::pair<Hash, std::vector<Representation*>>> list(wanted.begin(), wanted.end());
    parallel_for(list.size(), [&](size_t i) {
        job.check();
        const std::shared_ptr<const Mesh> mesh = model.store->load_mesh(list[i].first);
        for (Representation* representation : list[i].second)
            representation->payload = mesh;
    });
}

}  // namespace lodestone::capi
