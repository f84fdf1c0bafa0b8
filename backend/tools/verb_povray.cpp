// SPDX-License-Identifier: GPL-3.0-or-later
// POV-Ray verb: povray, a picture of a store or model, without Blender.
#include "cameras.h"
#include "choosing.h"
#include "report.h"
#include "session.h"
#include "terminal.h"
#include "verbs.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace lodestone::tools {
namespace {

namespace fs = std::filesystem;

/// The scene's folder: --scene, which stays, or a temporary one, which goes.
class SceneFolder {
public:
    explicit SceneFolder(const std::optional<std::string>& kept) : temporary_(!kept) {
        std::error_code error;
        if (kept) {
            path_ = *kept;
            fs::create_directories(path_, error);
            if (error)
                throw CallFailure(LDS_ERROR_IO,
                                  "cannot make the folder '" + *kept + "': " + error.message());
            return;
        }
        std::string name = (fs::temp_directory_path() / "lodestone-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr)
            throw CallFailure(LDS_ERROR_IO, "cannot make a temporary folder: " +
                                                std::generic_category().message(errno));
        path_ = name;
    }
    ~SceneFolder() {
        std::error_code ignored;
        if (temporary_)
            fs::remove_all(path_, ignored);
    }
    SceneFolder(const SceneFolder&) = delete;
    SceneFolder& operator=(const SceneFolder&) = delete;
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
    bool temporary_;
};

/// The size of the pixel filter, in pixels.
/// Law: Blender's own default.
constexpr double kFilterSize = 1.5;

int32_t antialias_of(const CommandArguments& arguments) {
    static constexpr std::array<const char*, 3> kNames{"off", "final", "reference"};
    const std::string wanted = arguments.text("antialias").value_or("final");
    for (size_t i = 0; i < kNames.size(); ++i) {
        if (wanted == kNames[i])
            return static_cast<int32_t>(i);
    }
    throw UsageError("--antialias is '" + wanted + "'; off, final or reference expected");
}

/// Adds a sun over the right shoulder and a grey sky, so that a scanned statue can be seen.
void light_up(lds_model* model) {
    lds_light sun{};
    sun.struct_size = sizeof sun;
    sun.name = "(sun)";
    sun.kind = LDS_LIGHT_SUN;
    sun.power = 3;
    sun.shadow = 1;
    const double way[3] = {-0.35, 0.55, -0.76};
    for (size_t i = 0; i < 3; ++i) {
        sun.color[i] = 1;
        sun.direction[i] = way[i];
    }
    check(lds_model_add_light(model, &sun));
    lds_world sky{};
    sky.struct_size = sizeof sky;
    sky.color[0] = sky.color[1] = sky.color[2] = 0.25;
    check(lds_model_set_world(model, &sky));
}

/// Writes into the picture what pictures made in Blender say about themselves.
void stamp(const std::string& picture, const lds_view& view) {
    char error[40];
    std::snprintf(error, sizeof error, "%g", view.pixel_error);
    const char* keywords[] = {"Lodestone", "Lodestone Pixel Error"};
    const char* texts[] = {lds_version(), error};
    check(lds_image_add_text(picture.c_str(), keywords, texts, 2));
}

/// Puts the finished picture under its name; the old one stays until then.
void deliver(const fs::path& picture, const std::string& out) {
    std::error_code error;
    fs::rename(picture, out, error);
    if (!error)
        return;
    const std::string beside = temporary_beside(out);  // the folder is on another disk
    fs::copy_file(picture, beside, fs::copy_options::overwrite_existing, error);
    if (!error)
        fs::rename(beside, out, error);
    if (error) {
        const std::string reason = error.message();
        fs::remove(beside, error);
        throw CallFailure(LDS_ERROR_IO, "cannot write '" + out + "': " + reason);
    }
}

}  // namespace

int run_povray(const CommandArguments& arguments) {
    const std::string& input = arguments.positional()[0];
    const auto out = arguments.text("out");
    if (!out || fs::path(*out).extension() != ".png")
        throw UsageError("--out X.png is needed: the picture");
    size_of(arguments);  // before anything is read
    const auto program = arguments.text("program");
    lds_povray_options options = usual(lds_povray_options_default);
    options.antialias = antialias_of(arguments);
    options.false_color = arguments.has("false-color") ? 1 : 0;
    options.threads = static_cast<int32_t>(arguments.number("threads", 0, 0, 4096));
    options.program = program ? program->c_str() : nullptr;
    options.filter_size = arguments.number("filter-size", kFilterSize, 0, 1e6);
    if (arguments.has("light-error"))
        options.light_error = arguments.number("light-error", 0, 0, 1e6);
    options.bounces = static_cast<int32_t>(arguments.number("bounces", 0, 0, 8));
    if (arguments.has("sky-occlusion")) {
        const auto rays = static_cast<int32_t>(arguments.number("sky-occlusion", 0, 0, 1024));
        options.sky_rays = rays > 0 ? rays : -1;
    }
    if (fs::is_directory(input))
        options.bake_folder = input.c_str();
    const char* found = nullptr;
    check(lds_povray_find(options.program, &found));

    const ModelHandle model = read_model(input);
    if (lds_model_light_count(model.get()) == 0)
        light_up(model.get());
    lds_camera eye{};
    lds_view view = view_of(arguments, model.get(), true, eye);
    CutOptions choosing(arguments, view);
    const SceneFolder folder(arguments.text("scene"));
    lds_cut_summary summary{};
    summary.struct_size = sizeof summary;
    lds_export_report exported{};
    exported.struct_size = sizeof exported;
    lds_povray_report rendered{};
    rendered.struct_size = sizeof rendered;
    const std::string camera = eye.name == nullptr ? "--eye" : eye.name;
    std::string largest;
    Fields rays;
    {
        ProgressBar progress("exporting");
        const CutHandle cut = choosing.cut(model.get(), progress.job());
        check(lds_cut_get_summary(cut.get(), &summary));
        largest = summary.largest_error_name;
        rays = choosing.rays(cut.get());
        check(lds_povray_export(model.get(), cut.get(), &view, folder.path().c_str(), &options,
                                progress.job(), &exported));
    }
    {
        ProgressBar progress("rendering");
        check(lds_povray_run(folder.path().c_str(), "picture.png", &options, progress.job(),
                             &rendered));
    }
    const fs::path picture = folder.path() / "picture.png";
    stamp(picture.string(), view);
    deliver(picture, *out);

    std::printf("%s: %d x %d, camera %s; %llu triangles, largest error %.3f px%s\n%.1f s\n",
                out->c_str(), view.width, view.height, terminal_text(camera).c_str(),
                static_cast<unsigned long long>(summary.triangles), summary.largest_error_px,
                in_brackets(largest).c_str(), rendered.wall_s);
    Fields report = report_of("povray", input);
    report.push_back({"picture", *out});
    report.push_back({"pixel_error", view.pixel_error});
    choosing.report(report);
    report.push_back({"camera", camera});
    summary.largest_error_name = largest.c_str();
    report.push_back({"cut", fields_of(summary)});
    if (!rays.empty())
        report.push_back({"rays", std::move(rays)});
    report.push_back({"export", Fields{{"bytes", exported.bytes},
                                       {"files", exported.files},
                                       {"written", exported.written},
                                       {"cpu_s", exported.cpu_s},
                                       {"lamps", exported.lamps},
                                       {"lights_each", exported.lights_each},
                                       {"unseen", exported.unseen},
                                       {"left_out", exported.left_out},
                                       {"left_out_bytes", exported.left_out_bytes},
                                       {"sky_copies", exported.sky_copies},
                                       {"shadow_rays", exported.shadow_rays},
                                       {"lamp_rays", exported.lamp_rays},
                                       {"sky_lights", exported.sky_lights},
                                       {"soft_lamps", exported.soft_lamps},
                                       {"text_bytes", exported.text_bytes},
                                       {"texels", exported.texels},
                                       {"covered", exported.covered},
                                       {"cut_triangles", exported.cut_triangles}}});
    report.push_back({"povray", Fields{{"parse_cpu_s", rendered.parse_cpu_s},
                                       {"trace_cpu_s", rendered.trace_cpu_s},
                                       {"wall_s", rendered.wall_s},
                                       {"peak_bytes", rendered.peak_bytes},
                                       {"exit_code", static_cast<double>(rendered.exit_code)}}});
    report.push_back({"problems", problems_of(model.get())});
    const auto path = arguments.text("json");
    write_report(path ? &*path : nullptr, report);
    return 0;
}

}  // namespace lodestone::tools
