// SPDX-License-Identifier: GPL-3.0-or-later
#include "capi/chosen.h"

#include "base/parallel.h"

#include <map>
#include <set>
#include <vector>

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

namespace {

/// The representations that have no mesh yet, by their hashes.
using MissingMeshes = std::map<Hash, std::set<Representation*>>;

void want(MissingMeshes& missing, Representation& level) {
    if (!level.resident())
        missing[level.summary.hash].insert(&level);
}

void load(const lds_model& model, const MissingMeshes& missing, const Job& job) {
    if (missing.empty())
        return;
    if (!model.store)
        fail(Status::Internal, "chosen meshes are neither in memory nor in a store");
    const std::vector<MissingMeshes::value_type> list(missing.begin(), missing.end());
    parallel_for(list.size(), [&](size_t i) {
        job.check();
        const std::shared_ptr<const Mesh> mesh = model.store->load_mesh(list[i].first);
        for (Representation* representation : list[i].second)
            representation->payload = mesh;
    });
}

}  // namespace

void load_levels(lds_model& model, const choose::Cut& cut, const std::vector<uint32_t>& levels,
                 const Job& job) {
    MissingMeshes missing;
    for (size_t i = 0; i < levels.size(); ++i) {
        if (levels[i] == view::kBoxOnly)
            continue;
        const choose::CutNode& node = cut.nodes.at(cut.chosen.at(i));
        want(missing, levels_with(model, node, levels[i])[levels[i]]);
    }
    load(model, missing, job);
}

void load_surfaces(lds_model& model, const lds_cut& cut, const Job& job) {
    MissingMeshes missing;
    for (const choose::SurfaceDetail& detail : cut.surfaces) {
        const choose::CutNode& node = cut.cut.nodes.at(detail.node);
        for (const uint32_t lod : detail.lods)
            want(missing, levels_with(model, node, lod)[lod]);
    }
    load(model, missing, job);
}

}  // namespace lodestone::capi
