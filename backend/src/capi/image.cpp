// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/image.h"

#include "base/files.h"
#include "capi/guard.h"
#include "image/compare.h"
#include "image/png_text.h"

#include <algorithm>
#include <optional>

using namespace lodestone;
using namespace lodestone::capi;

namespace {

/// Linear light, associated alpha.
image::Image linearized(image::Image picture) {
    if (picture.linear)
        return picture;
    for (size_t i = 0; i < picture.pixels.size(); i += 4) {
        for (size_t c = 0; c < 3; ++c)
            picture.pixels[i + c] =
                image::decode_srgb(picture.pixels[i + c]) * picture.pixels[i + 3];
    }
    picture.linear = true;
    return picture;
}

}  // namespace

lds_status lds_image_size(const char* path, int32_t* out_width, int32_t* out_height) {
    return guard([&] {
        require(path, "path");
        require(out_width, "out_width");
        require(out_height, "out_height");
        const image::Image picture = image::read(path);
        *out_width = picture.width;
        *out_height = picture.height;
    });
}

lds_status lds_image_read(const char* path, int32_t bottom_up, float* out_pixels, size_t capacity) {
    return guard([&] {
        require(path, "path");
        require(out_pixels, "out_pixels");
        const image::Image picture = linearized(image::read(path));
        if (capacity < picture.pixels.size())
            fail(Status::InvalidArgument, "the picture has ", picture.pixels.size(),
                 " numbers, the buffer room for ", capacity);
        const size_t row = static_cast<size_t>(picture.width) * 4;
        for (int y = 0; y < picture.height; ++y) {
            const int to = bottom_up != 0 ? picture.height - 1 - y : y;
            std::copy_n(picture.pixels.begin() + static_cast<std::ptrdiff_t>(row) * y, row,
                        out_pixels + row * static_cast<size_t>(to));
        }
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
        write_file(path, image::with_text(read_file(path), lines, path));
    });
}

lds_status lds_image_compare(const char* path_a, const char* path_b, const char* mask,
                             lds_difference* out_difference) {
    return guard([&] {
        require(path_a, "path_a");
        require(path_b, "path_b");
        checked(out_difference, "out_difference");
        const image::Image a = image::read(path_a);
        const image::Image b = image::read(path_b);
        std::optional<image::Image> covered;
        if (mask != nullptr)
            covered = image::read(mask);
        const image::Difference difference = image::compare(a, b, covered ? &*covered : nullptr);
        lds_difference out{};
        out.mean = difference.mean;
        out.p999 = difference.p999;
        out.max = difference.max;
        out.ssim = difference.ssim;
        out.pixels = difference.pixels;
        hand_out(out_difference, out, "out_difference");
    });
}
