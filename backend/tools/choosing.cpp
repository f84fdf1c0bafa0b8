// SPDX-License-Identifier: GPL-3.0-or-later
#include "choosing.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace lodestone::tools {

const OptionHelp kMaxTriangles{"max-triangles", "N",
                               "at most N triangles: the Pixel Error that fits is found"};
const OptionHelp kMaxMemory{"max-memory", "MB", "at most so many megabytes in POV-Ray: the same"};
const OptionHelp kCriterion{
    "criterion", "NAME",
    "what --pixel-error is: resolution (default, pixels), feature or area (shares of the picture), "
    "distance (metres; larger is finer)"};
const OptionHelp kOffScreen{"off-screen", "HOW",
                            "what the picture does not show: full (default), reflected (as its "
                            "shadows and images in mirrors "
                            "need) or shadows (images may be coarse)"};

const OptionHelp kRayClasses{
    "ray-classes", "LIST",
    "which rays may meet coarser levels than the camera's, where the picture cannot tell: any of "
    "shadow, reflection, radiosity, with commas between"};

namespace {

constexpr std::array kClasses{std::pair{"shadow", LDS_RAYS_SHADOW},
                              std::pair{"reflection", LDS_RAYS_REFLECTION},
                              std::pair{"radiosity", LDS_RAYS_RADIOSITY}};

/// "shadow, reflection or radiosity"
std::string known_classes() {
    std::string all;
    for (size_t i = 0; i < kClasses.size(); ++i) {
        all += i == 0 ? "" : i + 1 < kClasses.size() ? ", " : " or ";
        all += kClasses[i].first;
    }
    return all;
}

/// A mask of lds_rays. Throws UsageError.
uint32_t classes_of(const std::optional<std::string>& list) {
    uint32_t mask = 0;
    for (size_t at = 0; list && at <= list->size();) {
        const size_t end = std::min(list->find(',', at), list->size());
        const std::string word = list->substr(at, end - at);
        const auto* found = std::find_if(kClasses.begin(), kClasses.end(),
                                         [&](const auto& name) { return word == name.first; });
        if (found == kClasses.end())
            throw UsageError("--ray-classes has '" + word + "'; " + known_classes() + " expected");
        mask |= found->second;
        at = end + 1;
    }
    return mask;
}

/// The place of an option's value among its words, the first by default. Throws UsageError.
template <size_t Count>
int32_t word_of(const CommandArguments& arguments, const char* option,
                const std::array<const char*, Count>& words) {
    const std::string wanted = arguments.text(option).value_or(words[0]);
    std::string all;
    for (size_t i = 0; i < Count; ++i) {
        if (wanted == words[i])
            return static_cast<int32_t>(i);
        all += i == 0 ? "" : i + 1 < Count ? ", " : " or ";
        all += words[i];
    }
    throw UsageError(std::string("--") + option + " is '" + wanted + "'; " + all + " expected");
}

}  // namespace

CutOptions::CutOptions(const CommandArguments& arguments, lds_view& view)
    : view_(view),
      modifiers_(usual(lds_modifiers_default)),
      criterion_(arguments.text("criterion").value_or("resolution")) {
    modifiers_.criterion =
        word_of<4>(arguments, "criterion", {"resolution", "feature", "area", "distance"});
    modifiers_.off_screen = word_of<3>(arguments, "off-screen", {"full", "reflected", "shadows"});
    modifiers_.ray_classes = classes_of(arguments.text("ray-classes"));
    view_.modifiers = &modifiers_;
    budget_.struct_size = sizeof budget_;
    found_.struct_size = sizeof found_;
    budget_.triangles = static_cast<uint64_t>(arguments.number("max-triangles", 0, 0, 1e15));
    budget_.bytes = static_cast<uint64_t>(1e6 * arguments.number("max-memory", 0, 0, 1e9));
    if (budget_.triangles == 0 && arguments.has("max-triangles"))
        throw UsageError("--max-triangles is 0; 1 or more expected");
    if (budget_.bytes == 0 && arguments.has("max-memory"))
        throw UsageError("--max-memory is 0; more expected");
    // A budget alone asks for the finest cut that fits.
    if ((budget_.triangles != 0 || budget_.bytes != 0) && !arguments.has("pixel-error"))
        view_.pixel_error = 0;
}

CutHandle CutOptions::cut(lds_model* model, lds_job* job) {
    lds_cut* made = nullptr;
    if (budget_.triangles == 0 && budget_.bytes == 0) {
        check(lds_cut_create(model, &view_, job, &made));
        return CutHandle(made);
    }
    check(lds_cut_create_within(model, &view_, &budget_, job, &found_, &made));
    view_.pixel_error = found_.pixel_error;
    if (found_.fits == 0)
        std::fprintf(stderr, "warning: even the coarsest levels cost more than the budget\n");
    return CutHandle(made);
}

Fields CutOptions::rays(const lds_cut* cut) const {
    Fields out;
    for (const auto& [name, rays] : kClasses) {
        if ((modifiers_.ray_classes & rays) == 0)
            continue;
        lds_ray_summary summary{};
        summary.struct_size = sizeof summary;
        check(lds_cut_get_rays(cut, rays, &summary));
        std::printf(
            "%s: %llu occurrences, %llu triangles; %llu of its own, off by at most %.3f px\n", name,
            static_cast<unsigned long long>(summary.occurrences),
            static_cast<unsigned long long>(summary.triangles),
            static_cast<unsigned long long>(summary.own), summary.largest_error_px);
        out.push_back({name, Fields{{"own", summary.own},
                                    {"occurrences", summary.occurrences},
                                    {"triangles", summary.triangles},
                                    {"bytes", summary.bytes},
                                    {"largest_error_px", summary.largest_error_px},
                                    {"kept_need", summary.kept_need},
                                    {"kept_shape", summary.kept_shape},
                                    {"kept_contact", summary.kept_contact},
                                    {"all_triangles", summary.all_triangles},
                                    {"all_bytes", summary.all_bytes}}});
    }
    return out;
}

void CutOptions::report(Fields& fields) const {
    fields.push_back({"criterion", criterion_});
    if (found_.cuts > 0)
        fields.push_back({"budget", Fields{{"triangles", budget_.triangles},
                                           {"bytes", budget_.bytes},
                                           {"fits", found_.fits != 0}}});
}

}  // namespace lodestone::tools
