// SPDX-License-Identifier: GPL-3.0-or-later
// cut, compare, version.
#include "report.h"
#include "session.h"
#include "verbs.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace lodestone::tools {
namespace {

using Vector = std::array<double, 3>;

Vector vector_of(const std::string& option, const std::string& text) {
    Vector v{};
    char rest = 0;
    if (std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &v[0], &v[1], &v[2], &rest) != 3 ||
        !std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2]))
        throw UsageError("--" + option + " is '" + text + "'; X,Y,Z expected");
    return v;
}

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector scaled(const Vector& v, double factor) {
    return {v[0] * factor, v[1] * factor, v[2] * factor};
}

double length(const Vector& v) {
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// A perspective camera at `eye`, Z up.
lds_camera camera_at(const Vector& eye, const Vector& target, double angle_deg, double aspect) {
    Vector direction{target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]};
    if (length(direction) == 0)
        throw UsageError("--eye and --look-at are the same point");
    direction = scaled(direction, 1 / length(direction));
    const Vector world_up = std::abs(direction[2]) > 0.999 ? Vector{0, 1, 0} : Vector{0, 0, 1};
    Vector right = cross(direction, world_up);
    right = scaled(right, 1 / length(right));
    const Vector up = cross(right, direction);
    const double width = 2 * std::tan(angle_deg * 3.14159265358979323846 / 360);
    lds_camera camera{};
    camera.struct_size = sizeof camera;
    camera.near_clip = 0.1;
    for (size_t i = 0; i < 3; ++i) {
        camera.position[i] = eye[i];
        camera.direction[i] = direction[i];
        camera.right[i] = right[i] * width;
        camera.up[i] = up[i] * width / aspect;
    }
    return camera;
}

lds_camera camera_named(const lds_model* model, const std::string* name) {
    const size_t count = lds_model_camera_count(model);
    for (size_t i = 0; i < count; ++i) {
        lds_camera camera{};
        camera.struct_size = sizeof camera;
        check(lds_model_camera(model, i, &camera));
        if (name == nullptr || *name == camera.name)
            return camera;
    }
    if (name != nullptr)
        throw UsageError("there is no camera '" + *name + "' here");
    throw UsageError("the model has no camera: give --eye X,Y,Z");
}

}  // namespace

int run_cut(const Arguments& arguments) {
    const std::string& input = arguments.positional()[0];
    lds_view view{};
    view.struct_size = sizeof view;
    view.pixel_error = arguments.number("pixel-error", 1, 0, 1e9);
    const std::string size = arguments.text("size").value_or("640x360");
    char rest = 0;
    if (std::sscanf(size.c_str(), "%dx%d%c", &view.width, &view.height, &rest) != 2 ||
        view.width < 1 || view.height < 1)
        throw UsageError("--size is '" + size + "'; WxH expected, e.g. 640x360");
    const ModelHandle model = read_model(input);
    const auto eye = arguments.text("eye");
    const auto name = arguments.text("camera");
    if (eye)
        view.camera = camera_at(vector_of("eye", *eye),
                                vector_of("look-at", arguments.text("look-at").value_or("0,0,0")),
                                arguments.number("angle-deg", 50, 0.01, 175),
                                static_cast<double>(view.width) / view.height);
    else
        view.camera = camera_named(model.get(), name ? &*name : nullptr);

    lds_cut* made = nullptr;
    check(lds_cut_create(model.get(), &view, nullptr, &made));
    const CutHandle cut(made);
    lds_cut_summary summary{};
    summary.struct_size = sizeof summary;
    check(lds_cut_get_summary(cut.get(), &summary));
    std::printf(
        "%llu occurrences (%llu originals): %llu meshes, %llu boxes, %llu ellipsoids; "
        "%llu triangles, %.1f MB in POV-Ray\nlargest error %.3f px (%s)\n",
        static_cast<unsigned long long>(summary.occurrences),
        static_cast<unsigned long long>(summary.originals),
        static_cast<unsigned long long>(summary.mesh), static_cast<unsigned long long>(summary.box),
        static_cast<unsigned long long>(summary.ellipsoid),
        static_cast<unsigned long long>(summary.triangles),
        static_cast<double>(summary.bytes) * 1e-6, summary.largest_error_px,
        summary.largest_error_name);
    Fields report = report_of("cut", input);
    report.push_back({"pixel_error", view.pixel_error});
    report.push_back({"cut", Fields{{"kinds", Fields{{"mesh", summary.mesh},
                                                     {"box", summary.box},
                                                     {"ellipsoid", summary.ellipsoid}}},
                                    {"occurrences", summary.occurrences},
                                    {"originals", summary.originals},
                                    {"triangles", summary.triangles},
                                    {"bytes", summary.bytes},
                                    {"largest_error_px", summary.largest_error_px}}});
    if (arguments.has("list")) {
        std::vector<lds_choice> choices(lds_cut_choice_count(cut.get()));
        check(lds_cut_choice_copy(cut.get(), choices.data(), choices.size()));
        for (size_t i = 0; i < choices.size(); ++i)
            std::printf("LOD %-2u %8.3f px  %s\n", choices[i].lod, choices[i].error_px,
                        lds_cut_choice_path(cut.get(), i));
    }
    report.push_back({"problems", problems_of(model.get())});
    const auto path = arguments.text("json");
    write_report(path ? &*path : nullptr, report);
    return 0;
}

int run_compare(const Arguments& arguments) {
    const std::string& a = arguments.positional()[0];
    const std::string& b = arguments.positional()[1];
    const auto mask = arguments.text("mask");
    lds_difference difference{};
    difference.struct_size = sizeof difference;
    check(lds_image_compare(a.c_str(), b.c_str(), mask ? mask->c_str() : nullptr, &difference));
    std::printf("mean %.6f  99.9 %% %.6f  max %.6f  SSIM %.6f  over %llu pixels\n", difference.mean,
                difference.p999, difference.max, difference.ssim,
                static_cast<unsigned long long>(difference.pixels));
    Fields report = report_of("compare", a);
    report.push_back({"picture", b});
    report.push_back({"compare", Fields{{"mean", difference.mean},
                                        {"p999", difference.p999},
                                        {"max", difference.max},
                                        {"ssim", difference.ssim},
                                        {"pixels", difference.pixels}}});
    const auto path = arguments.text("json");
    write_report(path ? &*path : nullptr, report);
    return 0;
}

int run_version(const Arguments& arguments) {
    const bool rays = lds_rays_check() == LDS_OK;
    const std::string rays_reason = rays ? "Embree 3" : lds_last_error_text();
    const char* found = nullptr;
    const bool povray = lds_povray_find(nullptr, &found) == LDS_OK;
    const std::string povray_path = povray ? found : lds_last_error_text();
    std::printf("lodestone %s (interface %u)\nrays: %s\nPOV-Ray: %s\n", lds_version(),
                lds_abi_version(), rays_reason.c_str(), povray_path.c_str());
    Fields report = report_of("version", "");
    report.push_back({"version", lds_version()});
    report.push_back({"abi", lds_abi_version()});
    report.push_back({"rays", rays});
    report.push_back({"povray_path", povray ? Value(povray_path) : Value()});
    const auto path = arguments.text("json");
    write_report(path ? &*path : nullptr, report);
    return 0;
}

}  // namespace lodestone::tools
