// SPDX-License-Identifier: GPL-3.0-or-later
// POV-Ray's part of the C interface.
#include "base/parallel.h"
#include "capi/chosen.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/rays.h"
#include "image/pixel_filter.h"
#include "povray_export/run/empty_scene.h"
#include "povray_export/run/live_picture.h"
#include "povray_export/run/povray_runner.h"
#include "povray_export/scene/scene_writer.h"
#include "povray_export/texture/surface_finish.h"

#include <algorithm>
#include <cmath>
#include <memory>

using namespace lodestone;
using namespace lodestone::capi;

struct lds_live_picture {
    explicit lds_live_picture(const povray::PixelRectangle& part) : picture(part) {}
    povray::LivePicture picture;
};

namespace {

double error_of(double value, const char* what) {
    if (!(value >= 0) || !std::isfinite(value))
        fail(Status::InvalidArgument, "options.", what, " is ", value, "; it must be 0 or more");
    return value;
}

povray::Shading shading_of(const lds_povray_options& options) {
    povray::Shading out;
    out.threshold = error_of(options.antialias_threshold, "antialias_threshold");
    out.depth = options.antialias_depth;
    out.trace_depth = options.trace_depth;
    out.area_samples = options.area_samples;
    out.sky_lights = options.sky_lights;
    out.shadow_error = error_of(options.shadow_error, "shadow_error");
    out.reflection_error = error_of(options.reflection_error, "reflection_error");
    out.texture_error = error_of(options.texture_error, "texture_error");
    out.bounces = options.bounces;
    out.bounce_rays = options.bounce_rays;
    out.bounce_error = error_of(options.bounce_error, "bounce_error");
    out.sky_rays = options.sky_rays;
    return out;
}

povray::Antialiasing antialiasing_of(const lds_povray_options& options) {
    switch (options.antialias) {
        case LDS_ANTIALIAS_OFF:
            return povray::Antialiasing::Off;
        case LDS_ANTIALIAS_FINAL:
            return povray::Antialiasing::Final;
        case LDS_ANTIALIAS_REFERENCE:
            return povray::Antialiasing::Reference;
        default:
            fail(Status::InvalidArgument, "options.antialias is ", options.antialias,
                 "; 0 to 2 expected");
    }
}

/// The variance by which pictures are blurred.
double spread_of(const lds_povray_options& options) {
    const double size = error_of(options.filter_size, "filter_size");
    if (options.false_color != 0 || options.covered_only != 0)
        return 0;
    const povray::Antialiasing antialiasing = antialiasing_of(options);
    const povray::Shading shading = povray::filled_up(shading_of(options), antialiasing, 0);
    return image::missing_spread(size, povray::samples_along_side(shading, antialiasing));
}

povray::RunOptions run_options(const char* folder, const char* picture,
                               const lds_povray_options& options) {
    povray::RunOptions out;
    out.folder = folder;
    out.program = options.program == nullptr ? "" : options.program;
    out.threads = options.threads;
    out.output_name = picture;
    const std::string ending = std::filesystem::path(picture).extension().string();
    if (ending != ".exr" && ending != ".png")
        fail(Status::InvalidArgument, "the picture '", picture, "' must end in .exr or .png");
    out.spread = spread_of(options);
    out.output = ending == ".exr" ? povray::OutputFormat::Exr : povray::OutputFormat::Png;
    return out;
}

void run(const povray::RunOptions& options, lds_job* job, lds_povray_report* out_report) {
    const povray::RunReport report = povray::render_scene(options, job_of(job));
    lds_povray_report out{};
    out.exit_code = report.exit_code;
    out.parse_cpu_s = report.parse_cpu_s;
    out.trace_cpu_s = report.trace_cpu_s;
    out.wall_s = report.wall_s;
    out.peak_bytes = report.peak_bytes;
    hand_out(out_report, out, "out_report");
}

/// Makes the finest level of everything resident.
void load_finest(lds_model& model) {
    for (const ObjectIndex index : bottom_up(model.model)) {
        if (!model.model.objects[index].representations.empty())
            model.load(model.model.objects[index].representations[0]);
    }
}

}  // namespace

lds_status lds_povray_options_default(lds_povray_options* options) {
    return guard([&] {
        lds_povray_options out{};
        out.antialias = LDS_ANTIALIAS_FINAL;
        out.light_error = -1;
        hand_out(options, out, "options");
    });
}

lds_status lds_povray_export(lds_model* model, const lds_cut* cut, const lds_view* view,
                             const char* folder, const lds_povray_options* options, lds_job* job,
                             lds_export_report* out_report) {
    return guard([&] {
        require(model, "model");
        require(cut, "cut");
        require(folder, "folder");
        known_bytes(out_report, "out_report");
        const lds_povray_options given = checked(options, "options");
        require_current(*model, *cut);
        const ThreadLimit limit(given.threads);
        const Job progress = job_of(job);
        progress.stage(JobStage::Export);
        std::vector<uint32_t> levels;
        for (const uint32_t index : cut->cut.chosen)
            levels.push_back(cut->cut.nodes[index].lod);
        for (const choose::SurfaceDetail& detail : cut->surfaces) {
            const auto& chosen = cut->cut.chosen;
            const auto at = std::lower_bound(chosen.begin(), chosen.end(), detail.node);
            levels[static_cast<size_t>(at - chosen.begin())] = view::kBoxOnly;
        }
        load_levels(*model, cut->cut, levels, progress);
        load_surfaces(*model, *cut, progress);
        load_own(*model, *cut, progress);
        if (given.false_color == 0)
            model->load_pictures();
        povray::ExportOptions wanted;
        wanted.folder = folder;
        wanted.antialiasing = antialiasing_of(given);
        wanted.shading = shading_of(given);
        wanted.false_color = given.false_color != 0;
        wanted.colors = cut->colors;
        wanted.covered_only = given.covered_only != 0;
        wanted.still = given.still != 0;
        wanted.margin = image::spread_reach(spread_of(given));
        if (std::isnan(given.light_error))
            fail(Status::InvalidArgument, "options.light_error is not a number");
        wanted.rays = cut->rays;
        wanted.budget = cut->budget;
        if (given.bake_folder != nullptr)
            wanted.bakes = given.bake_folder;
        wanted.load_finest = [model] { load_finest(*model); };
        if (given.light_error >= 0)
            wanted.light_error = given.light_error;
        const choose::DetailedCut detailed =
            cut->surfaces.empty() ? choose::DetailedCut()
                                  : choose::draw_surfaces(model->model, cut->cut, cut->surfaces);
        const bool whole = cut->surfaces.empty();
        const povray::ExportReport report = povray::export_scene(
            whole ? model->model : detailed.model, whole ? cut->cut : detailed.cut,
            view_of(view, model), wanted, model->problems, progress);
        lds_export_report out{};
        out.bytes = report.bytes;
        out.files = report.files;
        out.written = report.written;
        out.cpu_s = report.cpu_s;
        out.lamps = report.lamps;
        out.lights_each = report.lights_each;
        out.unseen = report.unseen;
        out.left_out = report.left_out;
        out.left_out_bytes = report.left_out_bytes;
        out.sky_copies = report.sky_copies;
        out.shadow_rays = report.shadow_rays;
        out.lamp_rays = report.lamp_rays;
        out.sky_lights = report.sky_lights;
        out.soft_lamps = report.soft_lamps;
        out.text_bytes = report.text_bytes;
        out.texels = report.texels;
        out.covered = report.covered;
        out.cut_triangles = report.cut_triangles;
        hand_out(out_report, out, "out_report");
    });
}

lds_status lds_povray_run(const char* folder, const char* picture,
                          const lds_povray_options* options, lds_job* job,
                          lds_povray_report* out_report) {
    return guard([&] {
        require(folder, "folder");
        require(picture, "picture");
        known_bytes(out_report, "out_report");
        run(run_options(folder, picture, checked(options, "options")), job, out_report);
    });
}

lds_status lds_povray_run_live(const char* folder, const char* picture,
                               const lds_povray_options* options, lds_live_picture* live,
                               lds_job* job, lds_povray_report* out_report) {
    return guard([&] {
        require(folder, "folder");
        require(picture, "picture");
        require(live, "live");
        known_bytes(out_report, "out_report");
        const lds_povray_options given = checked(options, "options");
        povray::RunOptions wanted = run_options(folder, picture, given);
        wanted.live = &live->picture;
        wanted.mosaic = given.bounces == 0;
        run(wanted, job, out_report);
    });
}

lds_status lds_live_picture_create(const int32_t part[4], lds_live_picture** out_picture) {
    return guard([&] {
        require(part, "part");
        require(out_picture, "out_picture");
        *out_picture = std::make_unique<lds_live_picture>(
                           povray::PixelRectangle{part[0], part[1], part[2], part[3]})
                           .release();
    });
}

void lds_live_picture_destroy(lds_live_picture* picture) {
    delete picture;
}

lds_status lds_live_picture_take(lds_live_picture* picture, int32_t bottom_up, int32_t out_part[4],
                                 float* out_pixels, size_t capacity) {
    return guard([&] {
        require(picture, "picture");
        require(out_part, "out_part");
        require(out_pixels, "out_pixels");
        static_assert(sizeof(povray::LivePixel) == 4 * sizeof(float));
        auto* pixels = reinterpret_cast<povray::LivePixel*>(out_pixels);
        const auto taken = picture->picture.take(bottom_up != 0, {pixels, capacity / 4});
        const povray::PixelRectangle part = taken.value_or(povray::PixelRectangle{});
        out_part[0] = part.left;
        out_part[1] = part.top;
        if (bottom_up != 0 && taken)
            out_part[1] = picture->picture.part().height - part.top - part.height;
        out_part[2] = part.width;
        out_part[3] = part.height;
    });
}

lds_status lds_live_picture_finished(lds_live_picture* picture, uint64_t* out_pixels) {
    return guard([&] {
        require(picture, "picture");
        require(out_pixels, "out_pixels");
        *out_pixels = picture->picture.finished();
    });
}

lds_status lds_povray_empty_bytes(int32_t width, int32_t height, const char* program,
                                  uint64_t* out_bytes) {
    return guard([&] {
        require(out_bytes, "out_bytes");
        View view;
        view.width = width;
        view.height = height;
        povray::RunOptions like;
        like.program = program == nullptr ? "" : program;
        *out_bytes = povray::empty_scene_bytes(view, povray::Antialiasing::Final, like);
    });
}

lds_status lds_povray_find(const char* program, const char** out_path) {
    return guard([&] {
        require(out_path, "out_path");
        thread_local std::string path;
        path = povray::find_program(program == nullptr ? "" : program);
        *out_path = path.c_str();
    });
}

lds_status lds_povray_false_color(int32_t kind, uint32_t lod, double out_color[3]) {
    return guard([&] {
        require(out_color, "out_color");
        if (!is_kind(kind) || !row_of(static_cast<Kind>(kind)).drawn)
            fail(Status::InvalidArgument, "kind ", kind, " is not drawn");
        copy(povray::color_of(static_cast<Kind>(kind), lod), out_color);
    });
}
