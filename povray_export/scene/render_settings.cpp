// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene/render_settings.h"

#include "povray_export/scene/camera_writer.h"
#include "povray_export/scene/povray_number.h"

#include <algorithm>
#include <utility>

namespace lodestone::povray {
namespace {

/// A border that is larger on all sides, as far as the picture goes.
RenderBorder with_margin(const View& view, int margin) {
    const auto [left, top, width, height] = *view.border;
    const int right = std::min(left + width + margin, view.width);
    const int bottom = std::min(top + height + margin, view.height);
    const int first_column = std::max(0, left - margin);
    const int first_row = std::max(0, top - margin);
    return {first_column, first_row, right - first_column, bottom - first_row};
}

std::string adaptive(const Shading& shading) {
    std::string out = "Antialias=On\nSampling_Method=1\nAntialias_Threshold=";
    append_number(out, shading.threshold, 6);
    out += "\nAntialias_Depth=";
    append_count(out, static_cast<uint64_t>(shading.depth));
    return out + "\nJitter=Off\n";
}

}  // namespace

std::string render_settings(const View& view, int margin, const Shading& shading,
                            Antialiasing antialiasing, bool transparent) {
    std::string out =
        "; Lodestone " LODESTONE_VERSION
        "\nInput_File_Name=scene.pov\nOutput_File_Name=scene.png\n"
        "Output_File_Type=N\nBits_Per_Color=8\nDisplay=Off\nPause_When_Done=Off\nWidth=";
    append_count(out, static_cast<uint64_t>(view.width));
    out += "\nHeight=";
    append_count(out, static_cast<uint64_t>(view.height));
    if (view.border) {
        const auto [left, top, width, height] = with_margin(view, margin);
        const std::pair<const char*, int> ends[] = {{"Start_Column", left + 1},
                                                    {"End_Column", left + width},
                                                    {"Start_Row", top + 1},
                                                    {"End_Row", top + height}};
        for (const auto& [name, pixel] : ends) {
            out += '\n';
            out += name;
            out += '=';
            append_count(out, static_cast<uint64_t>(pixel));
        }
    }
    out += transparent ? "\nOutput_Alpha=On\n" : "\nOutput_Alpha=Off\n";
    // Gathered light would otherwise depend on which thread comes first.
    if (shading.bounces > 0)
        out += "High_Reproducibility=On\n";
    if (has_depth_blur(view.camera))
        return out + "Antialias=Off\n";
    switch (antialiasing) {
        case Antialiasing::Off:
            return out + "Antialias=Off\n";
        case Antialiasing::Final:
            return out + adaptive(shading);
        case Antialiasing::Reference:
            break;
    }
    return out +
           "Antialias=On\nSampling_Method=1\nAntialias_Threshold=0.0\n"
           "Antialias_Depth=4\nJitter=Off\n";
}

}  // namespace lodestone::povray
