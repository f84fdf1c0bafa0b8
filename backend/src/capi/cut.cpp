// SPDX-License-Identifier: GPL-3.0-or-later
#include "capi/chosen.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/rays.h"

#include <algorithm>

using namespace lodestone;
using namespace lodestone::capi;

namespace {

/// Names the node of a cut that is farthest off.
void set_largest(lds_cut& made, double error_px, uint32_t node) {
    made.largest_error_px = error_px;
    made.largest_error_node = node;
    made.largest_error_name =
        node == choose::kNoParent ? "" : choose::path_of(*made.table, made.cut, node);
}

/// Fills in the facts about a cut: its view, its largest error and the cuts that its classes of
/// rays meet.
void finish(lds_model& model, lds_cut& made, View view, const Job& job) {
    made.view = std::move(view);
    made.structured = model.structured;
    made.paths.clear();
    made.colors.clear();
    made.surface = {};
    made.batches.clear();
    made.surfaces.clear();
    made.rays.clear();
    made.resident = {};
    set_largest(made, made.cut.largest_error_px, made.cut.largest_error_node);
    made.rays = choose_rays(model, made.view, made.cut, job);
    made.resident = choose::resident_size(model.model, made.cut, made.rays);
}

/// Chooses the chunks of the cut's large surfaces.
void choose_chunks(const lds_model& model, lds_cut& made) {
    made.surfaces = choose::surface_details(model.model, made.view, made.cut);
    for (const choose::SurfaceDetail& detail : made.surfaces) {
        if (detail.largest_error_px > made.largest_error_px)
            set_largest(made, detail.largest_error_px, detail.node);
    }
}

/// Counts surfaces as they are drawn, of which the cut has counted whole levels.
void add_surfaces(const lds_cut& cut, lds_cut_summary& out) {
    for (const choose::SurfaceDetail& detail : cut.surfaces) {
        out.triangles += detail.triangles;
        out.triangles -= std::min(out.triangles, detail.whole.triangles);
        out.bytes += detail.bytes;
        out.bytes -= std::min(out.bytes, detail.whole.bytes);
        if (cut.cut.nodes[detail.node].lod == 0)
            --out.originals;
    }
}

}  // namespace

lds_status lds_cut_create(lds_model* model, const lds_view* view, lds_job* job, lds_cut** out_cut) {
    return guard([&] {
        require(model, "model");
        require(out_cut, "out_cut");
        const Job progress = job_of(job);
        progress.stage(JobStage::Choose);
        View given = view_of(view, model);
        auto made = std::make_unique<lds_cut>();
        made->generation = model->generation;
        made->table = model->table_for(given.kinds);
        made->cut = choose::choose_cut(*made->table, given, progress);
        finish(*model, *made, std::move(given), progress);
        choose_chunks(*model, *made);
        *out_cut = made.release();
    });
}

lds_status lds_cut_step(lds_model* model, lds_cut* cut, const lds_view* view, lds_job* job) {
    return guard([&] {
        require(model, "model");
        require(cut, "cut");
        require_made_from(*model, *cut);
        const Job progress = job_of(job);
        progress.stage(JobStage::Choose);
        View given = view_of(view, model);
        auto table = model->table_for(given.kinds);
        if (cut->stepper == nullptr || cut->stepper->table() != table)
            cut->stepper = std::make_unique<choose::CutStepper>(table);
        cut->stepper->step(given, cut->cut, progress);
        cut->table = std::move(table);
        finish(*model, *cut, std::move(given), progress);
    });
}

lds_status lds_cut_create_within(lds_model* model, const lds_view* view, const lds_budget* budget,
                                 lds_job* job, lds_budget_report* out_report, lds_cut** out_cut) {
    return guard([&] {
        require(model, "model");
        require(out_cut, "out_cut");
        known_bytes(out_report, "out_report");
        const lds_budget given = checked(budget, "budget");
        const Job progress = job_of(job);
        progress.stage(JobStage::Choose);
        View made_for = view_of(view, model);
        auto made = std::make_unique<lds_cut>();
        made->generation = model->generation;
        made->budget = given.bytes;
        made->table = model->table_for(made_for.kinds);
        choose::BudgetedCut found = choose::fit_cut_to_budget(
            *made->table, made_for, {given.triangles, given.bytes}, progress);
        lds_budget_report report{};
        report.fits = found.fits ? 1 : 0;
        report.pixel_error = found.pixel_error;
        report.cuts = found.cuts;
        made_for.pixel_error = found.pixel_error;
        made->cut = std::move(found.cut);
        finish(*model, *made, std::move(made_for), progress);
        // The representations that classes meet besides the camera's are small. Where even they are
        // too much for the budget, the classes meet those of the camera.
        if (found.fits && given.bytes > 0 && made->resident.bytes > given.bytes) {
            View plain = made->view;
            plain.modifiers.ray_classes = 0;
            finish(*model, *made, std::move(plain), progress);
        }
        choose_chunks(*model, *made);
        hand_out(out_report, report, "out_report");
        *out_cut = made.release();
    });
}

void lds_cut_destroy(lds_cut* cut) {
    delete cut;
}

lds_status lds_cut_get_summary(const lds_cut* cut, lds_cut_summary* out_summary) {
    return guard([&] {
        require(cut, "cut");
        lds_cut_summary out{};
        out.occurrences = cut->cut.chosen.size();
        out.opened = cut->cut.nodes.size() - cut->cut.chosen.size();
        out.originals = cut->cut.originals;
        out.triangles = cut->cut.triangles;
        out.bytes = cut->cut.bytes;
        out.largest_error_px = cut->largest_error_px;
        out.largest_error_name = cut->largest_error_name.c_str();
        const auto& chosen = cut->cut.chosen;
        const auto at = std::lower_bound(chosen.begin(), chosen.end(), cut->largest_error_node);
        if (cut->largest_error_node != choose::kNoParent && at != chosen.end())
            out.largest_error_choice = static_cast<uint64_t>(at - chosen.begin());
        add_surfaces(*cut, out);
        for (const auto& [name, occurrences] : cut->cut.kinds)
            out.occurrences_of_kind[static_cast<size_t>(kind_named(name))] = occurrences;
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
            const choose::CutNode& node = cut->cut.nodes[cut->cut.chosen[i]];
            lds_choice& out = out_choices[i];
            out.object = {node.object, cut->generation};
            out.lod = node.lod;
            out.kind = static_cast<int32_t>(node.kind);
            out.error_px = choose::error_on_screen(*cut->table, cut->view, cut->cut, node);
            cut->cut.world(node).to_rows(out.world);
        }
    });
}

lds_status lds_cut_level_uses(const lds_cut* cut, lds_level_use* out_uses, size_t capacity,
                              size_t* out_count) {
    return guard([&] {
        require(cut, "cut");
        require(out_count, "out_count");
        if (capacity > 0)
            require(out_uses, "out_uses");
        const std::vector<choose::LevelUse> uses = choose::level_uses(cut->cut);
        for (size_t i = 0; i < std::min(capacity, uses.size()); ++i)
            out_uses[i] = {{uses[i].object, cut->generation}, uses[i].lod, 0, uses[i].occurrences};
        *out_count = uses.size();
    });
}

const char* lds_cut_choice_path(lds_cut* cut, size_t position) {
    if (cut == nullptr || position >= cut->cut.chosen.size())
        return "";
    const char* path = "";
    guard([&] {
        cut->paths.resize(cut->cut.chosen.size());
        std::string& known = cut->paths[position];
        if (known.empty())
            known = choose::path_of(*cut->table, cut->cut, cut->cut.chosen[position]);
        path = known.c_str();
    });
    return path;
}

lds_status lds_cut_choice_reason(lds_model* model, const lds_cut* cut, size_t position,
                                 lds_reason* out_reason) {
    return guard([&] {
        require(model, "model");
        require(cut, "cut");
        const uint32_t node = node_at(*model, *cut, position);
        levels_with(*model, cut->cut.nodes[node], cut->cut.nodes[node].lod);
        model->summarize();
        const choose::ChoiceReason reason =
            choose::explain_choice(model->model, cut->view, cut->cut, node);
        // A new factor breaks this line, so that its author fills the field of lds_reason.
        const auto& [importance, demand, lenses, screen_lenses, depth, motion, darkness,
                     off_screen] = reason.factors;
        lds_reason out{};
        out.lod = reason.chosen.lod;
        out.z = reason.z;
        out.pixel = reason.pixel;
        out.error = reason.chosen.error;
        out.stretch = reason.stretch;
        out.error_px = reason.chosen.error_px;
        out.factor = reason.chosen.total;
        out.importance = importance;
        out.demand = demand;
        out.lenses = lenses;
        out.screen_lenses = screen_lenses;
        out.depth = depth;
        out.motion = motion;
        out.darkness = darkness;
        out.off_screen = off_screen;
        if (reason.coarser) {
            out.coarser_object = model->id_of(reason.coarser->object);
            out.coarser_lod = reason.coarser->lod;
            out.coarser_kind = static_cast<int32_t>(reason.coarser->kind);
            out.coarser_error = reason.coarser->error;
            out.coarser_error_px = reason.coarser->error_px;
            out.coarser_factor = reason.coarser->total;
        }
        out.pinned = reason.pinned ? 1 : 0;
        hand_out(out_reason, out, "out_reason");
    });
}
