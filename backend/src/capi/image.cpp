// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/image.h"

#include "base/files.h"
#include "capi/guard.h"
#include "image/compare_images.h"
#include "image/compare_shown.h"
#include "image/png_text.h"
#include "image/texel_rows.h"

#include <algorithm>
#include <optional>

using namespace lodestone;
using namespace lodestone::capi;

namespace {

lds_difference difference_of(const image::ImageDifference& difference) {
    lds_difference out{};
    out.mean = difference.mean;
    out.p999 = difference.p999;
    out.max = difference.max;
    out.ssim = difference.ssim;
    out.pixels = difference.pixels;
    return out;
}

/// Linear, top row first -> the caller's floats.
void copy_rows(const image::Image& picture, bool bottom_up, float* out_pixels, size_t capacity) {
    if (capacity < picture.pixels.size())
        fail(Status::InvalidArgument, "the picture has ", picture.pixels.size(),
             " numbers, the buffer room for ", capacity);
    const size_t row = static_cast<size_t>(picture.width) * 4;
    for (int y = 0; y < picture.height; ++y) {
        const int to = bottom_up ? picture.height - 1 - y : y;
        std::copy_n(picture.pixels.begin() + static_cast<std::ptrdiff_t>(row) * y, row,
                    out_pixels + row * static_cast<size_t>(to));
    }
}

}  // namespace

lds_status lds_image_size(const char* path, int32_t* out_width, int32_t* out_height) {
    return guard([&] {
        require(path, "path");
        require(out_width, "out_width");
        require(out_height, "out_height");
        const image::PackedImage picture = image::read_packed(path);
        *out_width = picture.width;
        *out_height = picture.height;
    });
}

lds_status lds_image_read(const char* path, int32_t bottom_up, float* out_pixels, size_t capacity) {
    return guard([&] {
        require(path, "path");
        require(out_pixels, "out_pixels");
        copy_rows(image::linear_picture(path), bottom_up != 0, out_pixels, capacity);
    });
}

lds_status lds_image_read_part(const char* path, const int32_t part[4], int32_t bottom_up,
                               float* out_pixels, size_t capacity) {
    return guard([&] {
        require(path, "path");
        require(part, "part");
        require(out_pixels, "out_pixels");
        const image::ImageRegion wanted{part[0], part[1], part[2], part[3]};
        copy_rows(image::read_region(path, wanted), bottom_up != 0, out_pixels, capacity);
    });
}

lds_status lds_image_write_png(const char* path, int32_t width, int32_t height,
                               const float* pixels) {
    return guard([&] {
        require(path, "path");
        require(pixels, "pixels");
        if (width < 1 || height < 1 || width > 65536 || height > 65536)
            fail(Status::InvalidArgument, "a picture of ", width, " x ", height, " pixels");
        image::Image picture;
        picture.width = width;
        picture.height = height;
        picture.linear = true;
        picture.pixels.assign(
            pixels, pixels + static_cast<size_t>(width) * static_cast<size_t>(height) * 4);
        image::write_png(path, picture);
    });
}

lds_status lds_image_add_text(const char* path, const char* const* keywords,
                              const char* const* texts, size_t count) {
    return guard([&] {
        require(path, "path");
        image::TextLines lines;
        for (size_t i = 0; i < count; ++i) {
            require(keywords, "keywords");
            require(texts, "texts");
            require(keywords[i], "a keyword");
            lines.emplace_back(keywords[i], texts[i] == nullptr ? "" : texts[i]);
        }
        write_file(path, image::with_png_text(read_file(path), lines, path));
    });
}

lds_status lds_image_compare(const char* path_a, const char* path_b, const char* mask,
                             lds_difference* out_difference) {
    return guard([&] {
        require(path_a, "path_a");
        require(path_b, "path_b");
        known_bytes(out_difference, "out_difference");
        const image::Image a = image::read(path_a);
        const image::Image b = image::read(path_b);
        std::optional<image::Image> covered;
        if (mask != nullptr)
            covered = image::read(mask);
        const image::ImageDifference difference =
            image::compare(a, b, covered ? &*covered : nullptr);
        hand_out(out_difference, difference_of(difference), "out_difference");
    });
}

lds_status lds_image_compare_shown(const char* path_a, const char* path_b, const char* shown_a,
                                   const char* shown_b, double* out_a, size_t count_a,
                                   double* out_b, size_t count_b, int32_t bottom_up,
                                   float* out_picture, size_t capacity,
                                   lds_difference* out_difference) {
    return guard([&] {
        require(path_a, "path_a");
        require(path_b, "path_b");
        require(shown_a, "shown_a");
        require(shown_b, "shown_b");
        if (count_a > 0)
            require(out_a, "out_a");
        if (count_b > 0)
            require(out_b, "out_b");
        known_bytes(out_difference, "out_difference");
        const image::Image a = image::read(path_a);
        const image::Image b = image::read(path_b);
        image::Image covered = image::read(shown_a);
        std::vector<uint32_t> first = image::identities(covered);
        std::vector<uint32_t> second = image::identities(image::read(shown_b));
        if (first.size() != second.size() || first.size() != a.size())
            fail(Status::InvalidArgument, "the pictures of what is shown have other sizes");
        for (size_t i = 0; i < first.size(); ++i) {
            covered.pixels[4 * i + 3] = first[i] + second[i] == image::kNothing ? 0.0f : 1.0f;
            if (first[i] != image::kNothing)
                second[i] = image::kNothing;
        }
        std::vector<double> sums_a(count_a, 0.0);
        std::vector<double> sums_b(count_b, 0.0);
        image::add_differences(a, b, first, sums_a);
        image::add_differences(a, b, second, sums_b);
        const image::ImageDifference difference = image::compare(a, b, &covered);
        if (out_picture != nullptr)
            copy_rows(image::difference_picture(a, b), bottom_up != 0, out_picture, capacity);
        std::copy(sums_a.begin(), sums_a.end(), out_a);
        std::copy(sums_b.begin(), sums_b.end(), out_b);
        hand_out(out_difference, difference_of(difference), "out_difference");
    });
}

lds_status lds_image_difference_color(double difference, double out_color[3]) {
    return guard([&] {
        require(out_color, "out_color");
        const std::array<float, 3> color = image::difference_color(static_cast<float>(difference));
        std::copy(color.begin(), color.end(), out_color);
    });
}
