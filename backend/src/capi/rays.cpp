// SPDX-License-Identifier: GPL-3.0-or-later
#include "capi/rays.h"

#include "capi/chosen.h"
#include "capi/guard.h"

#include <algorithm>
#include <bit>

namespace lodestone::capi {
namespace {

/// The class a caller names, which must be one.
RayMask class_of(uint32_t rays) {
    if (!std::has_single_bit(rays) || rays > kIndirectRays >> 1u)
        fail(Status::InvalidArgument, "rays is ", rays, "; one bit of ", kIndirectRays >> 1u,
             " expected");
    return static_cast<RayMask>(rays << 1u);
}

const choose::RayCut* cut_of(const lds_cut& cut, RayMask rays) {
    const auto at = std::find_if(cut.rays.begin(), cut.rays.end(),
                                 [&](const choose::RayCut& own) { return own.rays == rays; });
    return at == cut.rays.end() ? nullptr : &*at;
}

uint64_t count_of(const choose::RayCut& rays, choose::RayState state) {
    return static_cast<uint64_t>(std::count(rays.states.begin(), rays.states.end(), state));
}

/// The own choice in whose place this node, or one above it, is met.
const choose::RayChoice* own_of(const choose::Cut& cut, const choose::RayCut& rays, uint32_t node) {
    for (uint32_t at = node; at != choose::kNoParent; at = cut.nodes[at].parent) {
        const auto found = std::lower_bound(
            rays.own.begin(), rays.own.end(), at,
            [](const choose::RayChoice& own, uint32_t wanted) { return own.node < wanted; });
        if (found != rays.own.end() && found->node == at)
            return &*found;
    }
    return nullptr;
}

}  // namespace

std::vector<choose::RayCut> choose_rays(lds_model& model, const View& view, const choose::Cut& cut,
                                        const Job& job) {
    if (view.modifiers.ray_classes == 0)
        return {};
    const auto shape = [&](const Representation& mesh, const Representation* solid) {
        const Hash beside = solid == nullptr ? 0 : solid->summary.hash;
        const auto key = std::make_pair(mesh.summary.hash, beside);
        const auto known = model.shapes.find(key);
        if (known != model.shapes.end())
            return known->second;
        Representation read = mesh;
        model.load(read);
        return model.shapes.emplace(key, choose::shape_of(read, solid)).first->second;
    };
    return choose::choose_rays(model.model, view, cut, shape, job);
}

void load_own(lds_model& model, const lds_cut& cut, const Job& job) {
    for (const choose::RayCut& rays : cut.rays) {
        for (const choose::RayChoice& own : rays.own) {
            job.check();
            model.load(levels_with(model, cut.cut.nodes[own.node], own.lod)[own.lod]);
        }
    }
}

}  // namespace lodestone::capi

using namespace lodestone;
using namespace lodestone::capi;

lds_status lds_cut_get_rays(const lds_cut* cut, uint32_t rays, lds_ray_summary* out_summary) {
    return guard([&] {
        require(cut, "cut");
        const RayMask wanted = class_of(rays);
        const choose::RayCut* own = cut_of(*cut, wanted);
        lds_ray_summary out{};
        out.rays = rays;
        out.occurrences = own != nullptr ? own->met : cut->cut.chosen.size();
        out.triangles = own != nullptr ? own->triangles : cut->cut.triangles;
        out.bytes = own != nullptr ? own->bytes : cut->cut.bytes;
        if (own != nullptr) {
            out.own = own->own.size();
            out.largest_error_px = own->largest_error_px;
            out.kept_need = count_of(*own, choose::RayState::Need);
            out.kept_shape = count_of(*own, choose::RayState::Shape);
            out.kept_contact = count_of(*own, choose::RayState::Contact);
        }
        out.all_triangles = cut->resident.triangles;
        out.all_bytes = cut->resident.bytes;
        hand_out(out_summary, out, "out_summary");
    });
}

lds_status lds_cut_choice_rays(lds_model* model, const lds_cut* cut, size_t position, uint32_t rays,
                               lds_ray_choice* out_choice) {
    return guard([&] {
        require(model, "model");
        require(cut, "cut");
        const uint32_t node = node_at(*model, *cut, position);
        const choose::CutNode& chosen = cut->cut.nodes[node];
        lds_ray_choice out{};
        out.object = model->id_of(chosen.object);
        out.lod = chosen.lod;
        out.kind = static_cast<int32_t>(chosen.kind);
        out.scale = 1;
        const choose::RayCut* own = cut_of(*cut, class_of(rays));
        if (own != nullptr) {
            out.met = static_cast<int32_t>(own->states.at(position));
            if (const choose::RayChoice* choice = own_of(cut->cut, *own, node)) {
                const choose::CutNode& met = cut->cut.nodes[choice->node];
                const Representation& level = levels_with(*model, met, choice->lod)[choice->lod];
                out.object = model->id_of(met.object);
                out.lod = choice->lod;
                out.kind = static_cast<int32_t>(level.summary.kind);
                out.scale = choice->scale;
                out.error = choice->error;
                out.error_px = choice->error_px;
            }
        }
        hand_out(out_choice, out, "out_choice");
    });
}
