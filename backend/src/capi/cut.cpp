// SPDX-License-Identifier: GPL-3.0-or-later
#include "capi/guard.h"
#include "capi/handles.h"

#include <algorithm>

using namespace lodestone;
using namespace lodestone::capi;

lds_status lds_cut_create(lds_model* model, const lds_view* view, lds_job* job, lds_cut** out_cut) {
    return guard([&] {
        require(model, "model");
        require(out_cut, "out_cut");
        model->summarize();
        auto made = std::make_unique<lds_cut>();
        const Job progress = job_of(job);
        progress.stage(Stage::Choose);
        made->cut = quality::choose(model->model, view_of(view), progress);
        made->generation = model->generation;
        for (const uint32_t index : made->cut.chosen) {
            made->paths.push_back(quality::path_of(model->model, made->cut, index));
            made->originals += made->cut.nodes[index].lod == 0 ? 1 : 0;
        }
        if (made->cut.largest_error_node != quality::kNoParent)
            made->largest_error_name =
                quality::path_of(model->model, made->cut, made->cut.largest_error_node);
        *out_cut = made.release();
    });
}

void lds_cut_destroy(lds_cut* cut) {
    delete cut;
}

lds_status lds_cut_get_summary(const lds_cut* cut, lds_cut_summary* out_summary) {
    return guard([&] {
        require(cut, "cut");
        const auto kind = [&](Kind word) -> uint64_t {
            const auto at = cut->cut.kinds.find(name_of(word));
            return at == cut->cut.kinds.end() ? 0 : at->second;
        };
        lds_cut_summary out{};
        out.occurrences = cut->cut.chosen.size();
        out.opened = cut->cut.nodes.size() - cut->cut.chosen.size();
        out.mesh = kind(Kind::Mesh);
        out.box = kind(Kind::Box);
        out.ellipsoid = kind(Kind::Ellipsoid);
        out.originals = cut->originals;
        out.triangles = cut->cut.triangles;
        out.bytes = cut->cut.bytes;
        out.largest_error_px = cut->cut.largest_error_px;
        out.largest_error_name = cut->largest_error_name.c_str();
        out.composite = kind(Kind::Composite);
        hand_out(out_summary, out, "out_summary");
    });
}

size_t lds_cut_choice_count(const lds_cut* cut) {
    return cut == nullptr ? 0 : cut->cut.chosen.size();
}

lds_status lds_cut_choice_copy(const lds_cut* cut, lds_choice* out_choices, size_t capacity) {
    return guard([&] {
        require(cut, "cut");
        if (capacity > 0)
            require(out_choices, "out_choices");
        const size_t count = std::min(capacity, cut->cut.chosen.size());
        for (size_t i = 0; i < count; ++i) {
            const quality::Node& node = cut->cut.nodes[cut->cut.chosen[i]];
            lds_choice& out = out_choices[i];
            out.object = {node.object, cut->generation};
            out.lod = node.lod;
            out.kind = static_cast<int32_t>(node.kind);
            out.error_px = node.error_px;
            node.world.to_rows(out.world);
        }
    });
}

const char* lds_cut_choice_path(lds_cut* cut, size_t position) {
    return cut == nullptr || position >= cut->paths.size() ? "" : cut->paths[position].c_str();
}
