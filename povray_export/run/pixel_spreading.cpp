// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/run/pixel_spreading.h"

#include "base/error.h"
#include "base/files.h"
#include "image/pixel_filter.h"
#include "image/texel_rows.h"

#include <algorithm>
#include <charconv>

namespace lodestone::povray {
namespace {

/// The value of a line `name=value` of the settings, or `otherwise`.
int setting(const std::string& settings, const std::string& name, int otherwise) {
    const size_t at = settings.find('\n' + name + '=');
    if (at == std::string::npos)
        return otherwise;
    int value = otherwise;
    const char* const from = settings.data() + at + name.size() + 2;
    std::from_chars(from, settings.data() + settings.size(), value);
    return value;
}

/// The part of a picture that the settings draw; all of it where they say nothing else.
image::ImageRegion drawn_part(const std::string& settings, const image::Image& image) {
    const auto inside = [](int value, int most) { return std::clamp(value, 1, most); };
    const int left = inside(setting(settings, "Start_Column", 1), image.width);
    const int right = inside(setting(settings, "End_Column", image.width), image.width);
    const int top = inside(setting(settings, "Start_Row", 1), image.height);
    const int bottom = inside(setting(settings, "End_Row", image.height), image.height);
    return {left - 1, top - 1, std::max(1, right - left + 1), std::max(1, bottom - top + 1)};
}

}  // namespace

void spread_picture(const std::filesystem::path& picture, OutputFormat format, double variance,
                    const std::filesystem::path& settings) {
    // Taste: a hundred times what is written; a larger value lets a broken file take more memory.
    constexpr uint64_t kMostSettings = 1u << 20u;
    if (!(variance > 0) || format == OutputFormat::Ppm)
        return;
    const std::string drawn = read_file(settings, kMostSettings);
    const auto pixels =
        static_cast<double>(setting(drawn, "Width", 1)) * setting(drawn, "Height", 1);
    if (pixels > static_cast<double>(image::kMostPixels))
        return;
    image::Image image;
    try {
        image = image::linear_picture(picture);
    } catch (const Error& error) {
        fail(Status::PovrayFailed, "POV-Ray's picture cannot be read: ", error.what());
    }
    image::spread_pixels(image, variance, drawn_part(drawn, image));
    write_file(picture, format == OutputFormat::Exr
                            ? image::exr_bytes(image)
                            : image::png_bytes(image, image::PngEffort::Small));
}

}  // namespace lodestone::povray
