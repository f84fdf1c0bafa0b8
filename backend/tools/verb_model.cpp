// SPDX-License-Identifier: GPL-3.0-or-later
// Model verbs: measure, simplify, build, info.
#include "report.h"
#include "session.h"
#include "terminal.h"
#include "verbs.h"

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <cstdio>
#include <malloc.h>
#include <numbers>

namespace lodestone::tools {
namespace {

int32_t threads_of(const CommandArguments& arguments) {
    return static_cast<int32_t>(arguments.number("threads", 0, 0, 4096));
}

/// Numbered like lds_simplify_mode.
constexpr std::array<const char*, 3> kModes{"fast", "best", "cluster"};

int32_t mode_of(const CommandArguments& arguments) {
    const std::string name = arguments.text("mode").value_or(kModes[LDS_SIMPLIFY_FAST]);
    for (size_t i = 0; i < kModes.size(); ++i) {
        if (name == kModes[i])
            return static_cast<int32_t>(i);
    }
    throw UsageError("--mode is '" + name + "'; best, fast or cluster expected");
}

/// Makes groups of meshes of many loose parts, as --loose-parts says.
void split_loose_parts(const CommandArguments& arguments, lds_model* model, int32_t threads) {
    const std::string way = arguments.text("loose-parts").value_or("auto");
    if (way != "auto" && way != "one" && way != "objects")
        throw UsageError("--loose-parts is '" + way + "'; auto, one or objects expected");
    if (way == "one")
        return;
    lds_loose_options options = usual(lds_loose_options_default);
    options.always = way == "objects" ? 1 : 0;
    options.threads = threads;
    lds_loose_report done{};
    done.struct_size = sizeof done;
    ProgressBar progress("splitting");
    check(lds_model_split_loose_parts(model, nullptr, 0, &options, progress.job(), &done));
    if (done.split > 0)
        std::printf("%llu meshes of %llu loose parts: %llu clusters and groups of these\n",
                    static_cast<unsigned long long>(done.split),
                    static_cast<unsigned long long>(done.parts),
                    static_cast<unsigned long long>(done.made));
}

/// Gives flat groups nested ones, as Blender's add-on does, unless the user says otherwise.
void structure_groups(const CommandArguments& arguments, lds_model* model, int32_t threads) {
    const std::string way = arguments.text("groups").value_or("auto");
    if (way != "auto" && way != "given")
        throw UsageError("--groups is '" + way + "'; auto or given expected");
    if (way == "given")
        return;
    lds_structure_options options = usual(lds_structure_options_default);
    options.threads = threads;
    options.seed = arguments.count("seed", options.seed);
    lds_structure_report done{};
    done.struct_size = sizeof done;
    ProgressBar progress("grouping");
    check(lds_model_structure(model, nullptr, 0, &options, progress.job(), &done));
    if (done.made > 0)
        std::printf("%llu flat groups: %llu groups in them\n",
                    static_cast<unsigned long long>(done.structured),
                    static_cast<unsigned long long>(done.made));
}

/// Fills ratio, triangles, error or pixels. Throws UsageError unless exactly one way is given.
void set_target(const CommandArguments& arguments, lds_simplify_options& options) {
    options.ratio = arguments.number("ratio", 0, 0, 1);
    options.triangles = arguments.count("triangles", 0);
    options.error = arguments.number("error", 0, 0, 1e12);
    const double pixels = arguments.number("pixels", 1, 1e-6, 1e9);
    const double height = arguments.number("height", 360, 1e-6, 1e9);
    const double distance = arguments.number("distance", 0, 0, 1e12);
    const double angle_deg = arguments.number("angle-deg", 29.4, 0.01, 175);
    const bool seen =
        arguments.has("pixels") || arguments.has("distance") || arguments.has("height");
    if ((options.ratio > 0) + (options.triangles > 0) + (options.error > 0) + (seen ? 1 : 0) != 1)
        throw UsageError(
            "give one of --ratio R, --triangles N, --error METRES and --pixels P, more than 0");
    if (!seen)
        return;
    if (distance > 0) {
        options.error =
            pixels * distance * 2 * std::tan(angle_deg * std::numbers::pi / 360) / height;
    } else if (arguments.has("height") && !arguments.has("distance")) {
        options.pixels = pixels;
        options.height_px = height;
    } else {
        throw UsageError("--pixels needs --distance METRES or --height PIXELS, more than 0");
    }
}

lds_object object_at(const lds_model* model, size_t position) {
    lds_object object{};
    check(lds_model_object_at(model, position, &object));
    return object;
}

lds_object_summary summary_of(lds_model* model, lds_object object) {
    lds_object_summary summary{};
    summary.struct_size = sizeof summary;
    check(lds_model_object_summary(model, object, &summary));
    return summary;
}

lds_totals totals_of(lds_model* model) {
    lds_totals totals{};
    totals.struct_size = sizeof totals;
    check(lds_model_totals(model, &totals));
    return totals;
}

Fields fields_of(const lds_totals& totals) {
    return {{"objects", totals.objects},
            {"placements", totals.occurrences},
            {"triangles_placed", totals.triangles_placed},
            {"triangles_unique", totals.triangles_unique},
            {"representations", totals.representations}};
}

List list_of(const double* values, size_t count) {
    return List(values, values + count);
}

void finish(const CommandArguments& arguments, const Fields& report) {
    const auto path = arguments.text("json");
    write_report(path ? &*path : nullptr, report);
}

}  // namespace

int run_measure(const CommandArguments& arguments) {
    const std::string& input = arguments.positional()[0];
    lds_measure_options options = usual(lds_measure_options_default);
    options.rays = arguments.count("rays", options.rays);
    const double usual = arguments.text("rays") ? 0 : 0.01;
    options.relative_error = arguments.number("relative-error", usual, 0, 1);
    options.seed = arguments.count("seed", options.seed);
    options.threads = threads_of(arguments);
    const ModelHandle model = read_model(input);
    Fields report = report_of("measure", input);
    List objects;
    std::printf("%-32s %12s %12s  %-26s color\n", "object", "visible m^2", "surface m^2",
                "centroid");
    for (size_t i = 0; i < lds_model_object_count(model.get()); ++i) {
        const lds_object object = object_at(model.get(), i);
        const std::string name = summary_of(model.get(), object).name;
        lds_attributes a{};
        a.struct_size = sizeof a;
        ProgressBar progress("measuring");
        check(lds_model_measure(model.get(), object, &options, progress.job(), &a));
        std::printf("%-32s %12.6g %12.6g  %8.4g %8.4g %8.4g %5.2f %5.2f %5.2f\n",
                    terminal_text(name, 32).c_str(), a.visible_area, a.surface_area, a.centroid[0],
                    a.centroid[1], a.centroid[2], a.color[0], a.color[1], a.color[2]);
        objects.emplace_back(Fields{{"name", name},
                                    {"visible_area", a.visible_area},
                                    {"surface_area", a.surface_area},
                                    {"centroid", list_of(a.centroid, 3)},
                                    {"inertia", list_of(a.inertia, 6)},
                                    {"normal_moment", a.normal_moment},
                                    {"color", list_of(a.color, 3)},
                                    {"roughness", a.roughness},
                                    {"metallic", a.metallic},
                                    {"relative_error", a.relative_error},
                                    {"rays", a.rays}});
    }
    report.push_back({"objects", std::move(objects)});
    report.push_back({"problems", problems_of(model.get())});
    finish(arguments, report);
    return 0;
}

int run_simplify(const CommandArguments& arguments) {
    // Memory that reading the model frees is used again, instead of new pages asked of the system.
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, INT_MAX);
    const std::string& input = arguments.positional()[0];
    const std::string& output = arguments.positional()[1];
    lds_simplify_options options = usual(lds_simplify_options_default);
    set_target(arguments, options);
    options.mode = mode_of(arguments);
    options.measure = arguments.has("measure") ? 1 : 0;
    options.keep_topology = arguments.has("keep-topology") ? 1 : 0;
    options.seed = arguments.count("seed", options.seed);
    options.threads = threads_of(arguments);
    const ModelHandle model = read_model(input);
    lds_simplify_report done{};
    done.struct_size = sizeof done;
    {
        ProgressBar progress("simplifying");
        check(lds_model_simplify(model.get(), &options, progress.job(), &done));
    }
    check(lds_model_write(model.get(), output.c_str()));
    std::printf("%llu -> %llu triangles, %.3f CPU s",
                static_cast<unsigned long long>(done.triangles_before),
                static_cast<unsigned long long>(done.triangles), done.cpu_s);
    if (done.error >= 0)
        std::printf(", error %.6g m (largest %.6g m)", done.error, done.max_error);
    std::printf("\n%s\n", output.c_str());
    Fields report = report_of("simplify", input);
    report.push_back({"picture", {}});
    report.push_back({"output", output});
    Fields simplified{{"mode", kModes[static_cast<size_t>(options.mode)]},
                      {"cpu_s", done.cpu_s},
                      {"triangles_before", done.triangles_before},
                      {"triangles", done.triangles}};
    if (options.error > 0)
        simplified.push_back({"wanted_error", options.error});
    if (done.error >= 0) {
        simplified.push_back({"error", done.error});
        simplified.push_back({"max_error", done.max_error});
    }
    report.push_back({"simplify", std::move(simplified)});
    report.push_back({"problems", problems_of(model.get())});
    finish(arguments, report);
    return 0;
}

int run_build(const CommandArguments& arguments) {
    const std::string& input = arguments.positional()[0];
    const std::string& store = arguments.positional()[1];
    lds_build_options options = usual(lds_build_options_default);
    options.level_ratio = arguments.number("level-ratio", options.level_ratio, 0.02, 0.95);
    options.rays = arguments.count("rays", options.rays);
    options.samples = static_cast<uint32_t>(
        std::min<uint64_t>(arguments.count("samples", options.samples), 1u << 24u));
    options.seed = arguments.count("seed", options.seed);
    options.threads = threads_of(arguments);
    options.rebuild = arguments.has("rebuild") ? 1 : 0;
    const ModelHandle model = read_model(input);
    split_loose_parts(arguments, model.get(), options.threads);
    structure_groups(arguments, model.get(), options.threads);
    lds_build_report done{};
    done.struct_size = sizeof done;
    {
        ProgressBar progress("building");
        check(lds_model_build(model.get(), store.c_str(), &options, progress.job(), &done));
    }
    std::printf(
        "%llu objects, %llu built, %llu levels, %.1f MB written, %.1f s (%.1f CPU s)\n%s\n",
        static_cast<unsigned long long>(done.objects), static_cast<unsigned long long>(done.built),
        static_cast<unsigned long long>(done.representations),
        static_cast<double>(done.bytes_written) * 1e-6, done.wall_s, done.cpu_s, store.c_str());
    Fields report = report_of("build", input);
    report.push_back({"store", store});
    report.push_back({"model", fields_of(totals_of(model.get()))});
    report.push_back({"build", Fields{{"objects", done.objects},
                                      {"built", done.built},
                                      {"representations", done.representations},
                                      {"bytes_written", done.bytes_written},
                                      {"wall_s", done.wall_s},
                                      {"cpu_s", done.cpu_s}}});
    report.push_back({"problems", problems_of(model.get())});
    finish(arguments, report);
    return 0;
}

int run_info(const CommandArguments& arguments) {
    const std::string& input = arguments.positional()[0];
    const uint64_t most = arguments.count("objects", 40);
    const ModelHandle model = read_model(input);
    Fields report = report_of("info", input);
    const lds_totals totals = totals_of(model.get());
    report.push_back({"model", fields_of(totals)});
    std::printf(
        "%llu objects and groups, %llu occurrences, %llu triangles placed, %llu unique, "
        "%llu levels\n",
        static_cast<unsigned long long>(totals.objects),
        static_cast<unsigned long long>(totals.occurrences),
        static_cast<unsigned long long>(totals.triangles_placed),
        static_cast<unsigned long long>(totals.triangles_unique),
        static_cast<unsigned long long>(totals.representations));
    List objects;
    const size_t count = lds_model_object_count(model.get());
    for (size_t i = 0; i < count; ++i) {
        const lds_object object = object_at(model.get(), i);
        const lds_object_summary summary = summary_of(model.get(), object);
        List levels;
        if (i < most)
            std::printf("%s%s\n", terminal_text(summary.name).c_str(),
                        summary.role == LDS_ROLE_ENVIRONMENT ? "  (environment)" : "");
        for (uint32_t lod = 0; lod < summary.representation_count; ++lod) {
            lds_representation level{};
            level.struct_size = sizeof level;
            check(lds_model_representation(model.get(), object, lod, &level));
            if (i < most)
                std::printf("  LOD %-2u %-9s %10llu triangles  %12.6g mm\n", lod,
                            lds_kind_name(level.kind),
                            static_cast<unsigned long long>(level.triangles), 1000 * level.error);
            levels.emplace_back(Fields{{"lod", lod},
                                       {"kind", lds_kind_name(level.kind)},
                                       {"triangles", level.triangles},
                                       {"error", level.error},
                                       {"max_error", level.max_error}});
        }
        objects.emplace_back(Fields{{"uid", summary.uid},
                                    {"name", summary.name},
                                    {"group", summary.group != 0},
                                    {"levels", std::move(levels)}});
    }
    if (count > most)
        std::printf("... and %zu more (--objects N)\n", static_cast<size_t>(count - most));
    report.push_back({"objects", std::move(objects)});
    report.push_back({"problems", problems_of(model.get())});
    finish(arguments, report);
    return 0;
}

}  // namespace lodestone::tools
