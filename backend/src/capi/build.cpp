// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "hierarchy/hierarchy_build.h"
#include "povray_export/scene/povray_costs.h"

#include <cmath>

using namespace lodestone;
using namespace lodestone::capi;

namespace {

hierarchy::BuildSettings settings_of(const lds_model& model, const lds_build_options& options) {
    hierarchy::BuildSettings settings;
    settings.level_ratio = options.level_ratio;
    settings.rays = options.rays;
    settings.samples = options.samples;
    settings.group_triangles = options.group_triangles;
    settings.seed = options.seed;
    settings.rebuild = options.rebuild != 0;
    settings.of_one_frame = options.of_one_frame != 0;
    if (!(settings.level_ratio > 0.01 && settings.level_ratio < 0.96))
        fail(Status::InvalidArgument, "level_ratio is ", options.level_ratio,
             "; 0.01 to 0.96 expected");
    if (settings.rays < 64 || settings.samples < 64)
        fail(Status::InvalidArgument, "at least 64 rays and samples are needed");
    if (options.scope_count > 0)
        require(options.scope, "options.scope");
    for (size_t i = 0; i < options.scope_count; ++i)
        settings.scope.push_back(model.index_of(options.scope[i]));
    if (options.pose_count > 0)
        require(options.poses, "options.poses");
    for (size_t i = 0; i < options.pose_count; ++i) {
        require(options.poses[i], "a pose");
        settings.poses.push_back(&options.poses[i]->model);
    }
    if (options.view != nullptr) {
        if (!(options.share >= 0) || !std::isfinite(options.share))
            fail(Status::InvalidArgument, "share is ", options.share, "; it must be 0 or more");
        settings.demand = hierarchy::BuildDemand{view_of(options.view, &model), options.share};
    }
    return settings;
}

lds_build_report report_of(const hierarchy::BuildReport& report) {
    lds_build_report out{};
    out.objects = report.objects;
    out.built = report.built;
    out.representations = report.representations;
    out.triangles = report.triangles;
    out.bytes_written = report.bytes_written;
    out.wall_s = report.wall_s;
    out.cpu_s = report.cpu_s;
    out.left = report.left;
    return out;
}

}  // namespace

lds_status lds_build_options_default(lds_build_options* options) {
    return guard([&] {
        const hierarchy::BuildSettings settings;
        lds_build_options out{};
        out.level_ratio = settings.level_ratio;
        out.rays = settings.rays;
        out.samples = settings.samples;
        out.group_triangles = settings.group_triangles;
        out.seed = settings.seed;
        out.share = hierarchy::BuildDemand().share;
        hand_out(options, out, "options");
    });
}

lds_status lds_cost_model_default(lds_cost_model* costs) {
    return guard([&] {
        const CostModel known = povray::povray_costs();
        lds_cost_model out{};
        out.triangle_bytes = known.triangle_bytes;
        out.primitive_bytes = known.primitive_bytes;
        out.occurrence_bytes = known.occurrence_bytes;
        hand_out(costs, out, "costs");
    });
}

lds_status lds_model_build_estimate(lds_model* model, const char* store,
                                    const lds_build_options* options,
                                    lds_build_report* out_report) {
    return guard([&] {
        require(model, "model");
        require(store, "store");
        const lds_build_options given = checked(options, "options");
        const ThreadLimit limit(given.threads);
        hand_out(out_report,
                 report_of(hierarchy::estimate_build(model->model, segment::Store(store),
                                                     settings_of(*model, given))),
                 "out_report");
    });
}

lds_status lds_model_build(lds_model* model, const char* store, const lds_build_options* options,
                           lds_job* job, lds_build_report* out_report) {
    return guard([&] {
        require(model, "model");
        require(store, "store");
        known_bytes(out_report, "out_report");
        const lds_build_options given = checked(options, "options");
        const hierarchy::BuildSettings settings = settings_of(*model, given);
        const ThreadLimit limit(given.threads);
        model->load_finest();
        const segment::Store target(store);
        model->table.reset();
        const size_t before = model->model.objects.size();
        const hierarchy::BuildReport report = hierarchy::build_hierarchy(
            model->model, target, settings, model->problems, job_of(job));
        model->store.emplace(target);
        model->summarized = true;
        model->structured += model->model.objects.size() == before ? 0 : 1;
        hand_out(out_report, report_of(report), "out_report");
    });
}
