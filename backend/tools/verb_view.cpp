// SPDX-License-Identifier: GPL-3.0-or-later
// View verbs: cut, compare, version.
#include "cameras.h"
#include "choosing.h"
#include "report.h"
#include "session.h"
#include "terminal.h"
#include "verbs.h"

#include <cstdio>

namespace lodestone::tools {
int run_cut(const CommandArguments& arguments) {
    const std::string& input = arguments.positional()[0];
    size_of(arguments);  // before anything is read
    const ModelHandle model = read_model(input);
    lds_camera camera{};
    lds_view view = view_of(arguments, model.get(), false, camera);
    CutOptions choosing(arguments, view);
    const CutHandle cut = choosing.cut(model.get(), nullptr);
    lds_cut_summary summary{};
    summary.struct_size = sizeof summary;
    check(lds_cut_get_summary(cut.get(), &summary));
    std::printf(
        "%llu occurrences (%llu originals): %s; %llu triangles, %.1f MB in POV-Ray\n"
        "largest error %.3f px%s; threshold %g\n",
        static_cast<unsigned long long>(summary.occurrences),
        static_cast<unsigned long long>(summary.originals), kinds_line(summary).c_str(),
        static_cast<unsigned long long>(summary.triangles),
        static_cast<double>(summary.bytes) * 1e-6, summary.largest_error_px,
        in_brackets(summary.largest_error_name).c_str(), view.pixel_error);
    Fields report = report_of("cut", input);
    report.push_back({"pixel_error", view.pixel_error});
    choosing.report(report);
    report.push_back({"cut", fields_of(summary)});
    Fields rays = choosing.rays(cut.get());
    if (!rays.empty())
        report.push_back({"rays", std::move(rays)});
    if (arguments.has("list")) {
        std::vector<lds_choice> choices(lds_cut_choice_count(cut.get()));
        check(lds_cut_choice_copy(cut.get(), choices.data(), choices.size()));
        for (size_t i = 0; i < choices.size(); ++i)
            std::printf("LOD %-2u %8.3f px  %s\n", choices[i].lod, choices[i].error_px,
                        terminal_text(lds_cut_choice_path(cut.get(), i)).c_str());
    }
    report.push_back({"problems", problems_of(model.get())});
    const auto path = arguments.text("json");
    write_report(path ? &*path : nullptr, report);
    return 0;
}

int run_compare(const CommandArguments& arguments) {
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

int run_version(const CommandArguments& arguments) {
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
    report.push_back({"povray_path", povray ? ReportValue(povray_path) : ReportValue()});
    const auto path = arguments.text("json");
    write_report(path ? &*path : nullptr, report);
    return 0;
}

}  // namespace lodestone::tools
