// SPDX-License-Identifier: GPL-3.0-or-later
// Guards rows of packed pictures: the very bits that formulas on floats give, for every layout.
#include "base/color.h"
#include "base/random.h"
#include "image/image_reduction.h"
#include "image/mask_texels.h"
#include "image/texture_sampler.h"
#include "scenes/picture_files.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>

namespace lodestone::image {
namespace {

constexpr int kWidth = 37;
constexpr int kHeight = 23;

std::vector<unsigned char> noise(size_t count) {
    PcgRandom random(7);
    std::vector<unsigned char> out(count);
    for (unsigned char& byte : out)
        byte = static_cast<unsigned char>(random.uniform() * 255.99);
    return out;
}

/// A PNG of noise.
std::string noisy_png(int depth, int color, bool interlaced = false) {
    const int channels = color == PNG_COLOR_TYPE_RGB          ? 3
                         : color == PNG_COLOR_TYPE_RGB_ALPHA  ? 4
                         : color == PNG_COLOR_TYPE_GRAY_ALPHA ? 2
                                                              : 1;
    const int row = (kWidth * channels * depth + 7) / 8;
    std::vector<png_color> palette;
    std::vector<unsigned char> alpha;
    if (color == PNG_COLOR_TYPE_PALETTE) {
        for (int i = 0; i < 1 << depth; ++i)
            palette.push_back({static_cast<png_byte>(3 * i), static_cast<png_byte>(255 - i),
                               static_cast<png_byte>(7 * i)});
        if (depth < 8)
            alpha = {0, 77, 200};
    }
    return pictures::png(kWidth, kHeight, depth, color, noise(static_cast<size_t>(row) * kHeight),
                         interlaced, palette, alpha);
}

/// The numbers of a PNG as libpng gives them in RGBA.
std::vector<float> png_numbers(const std::string& bytes) {
    png_structp file = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(file);
    std::string_view left = bytes;
    png_set_read_fn(file, &left, [](png_structp f, png_bytep out, size_t size) {
        auto& from = *static_cast<std::string_view*>(png_get_io_ptr(f));
        std::memcpy(out, from.data(), size);
        from.remove_prefix(size);
    });
    png_read_info(file, info);
    png_set_expand(file);
    png_set_gray_to_rgb(file);
    png_set_add_alpha(file, 0xffff, PNG_FILLER_AFTER);
    png_set_interlace_handling(file);
    png_read_update_info(file, info);
    const bool wide = png_get_bit_depth(file, info) == 16;
    const size_t row = png_get_rowbytes(file, info);
    const size_t height = png_get_image_height(file, info);
    std::vector<unsigned char> data(row * height);
    std::vector<png_bytep> rows;
    for (size_t y = 0; y < height; ++y)
        rows.push_back(data.data() + y * row);
    png_read_image(file, rows.data());
    png_destroy_read_struct(&file, &info, nullptr);
    std::vector<float> out;
    for (size_t i = 0; i < data.size(); i += wide ? 2 : 1)
        out.push_back(wide ? static_cast<float>(data[i] << 8 | data[i + 1]) / 65535.0f
                           : static_cast<float>(data[i]) / 255.0f);
    return out;
}

/// The numbers of a JPEG as libjpeg gives them in RGB.
std::vector<float> jpeg_numbers(const std::string& bytes) {
    jpeg_decompress_struct file{};
    jpeg_error_mgr errors{};
    file.err = jpeg_std_error(&errors);
    jpeg_create_decompress(&file);
    jpeg_mem_src(&file, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&file, TRUE);
    file.out_color_space = JCS_RGB;
    jpeg_start_decompress(&file);
    std::vector<unsigned char> row(size_t{3} * file.output_width);
    std::vector<float> out;
    while (file.output_scanline < file.output_height) {
        unsigned char* start = row.data();
        jpeg_read_scanlines(&file, &start, 1);
        for (size_t i = 0; i < row.size(); i += 3) {
            for (size_t c = 0; c < 3; ++c)
                out.push_back(static_cast<float>(row[i + c]) / 255.0f);
            out.push_back(1);
        }
    }
    jpeg_destroy_decompress(&file);
    return out;
}

/// The numbers of an EXR: colors straight, what is not finite 0.
std::vector<float> exr_numbers(std::vector<float> stored) {
    for (size_t i = 0; i < stored.size(); i += 4) {
        for (size_t c = 0; c < 3; ++c) {
            if (stored[i + 3] > 0)
                stored[i + c] /= stored[i + 3];
        }
    }
    for (float& value : stored)
        value = std::isfinite(value) ? value : 0.0f;
    return stored;
}

struct PictureCase {
    std::string name;
    std::string bytes;
    std::vector<float> numbers;
    bool is_floats = false;
};

std::vector<PictureCase> all_pictures() {
    std::vector<PictureCase> out;
    for (const bool interlaced : {false, true}) {
        for (const auto& [depth, color] :
             std::initializer_list<std::pair<int, int>>{{1, PNG_COLOR_TYPE_GRAY},
                                                        {2, PNG_COLOR_TYPE_GRAY},
                                                        {4, PNG_COLOR_TYPE_GRAY},
                                                        {8, PNG_COLOR_TYPE_GRAY},
                                                        {16, PNG_COLOR_TYPE_GRAY},
                                                        {8, PNG_COLOR_TYPE_GRAY_ALPHA},
                                                        {16, PNG_COLOR_TYPE_GRAY_ALPHA},
                                                        {8, PNG_COLOR_TYPE_RGB},
                                                        {16, PNG_COLOR_TYPE_RGB},
                                                        {8, PNG_COLOR_TYPE_RGB_ALPHA},
                                                        {16, PNG_COLOR_TYPE_RGB_ALPHA},
                                                        {2, PNG_COLOR_TYPE_PALETTE},
                                                        {4, PNG_COLOR_TYPE_PALETTE},
                                                        {8, PNG_COLOR_TYPE_PALETTE}}) {
            PictureCase& made = out.emplace_back();
            made.name = "PNG of color type " + std::to_string(color) + ", " +
                        std::to_string(depth) + " bits" + (interlaced ? ", interlaced" : "");
            made.bytes = noisy_png(depth, color, interlaced);
            made.numbers = png_numbers(made.bytes);
        }
    }
    const png_color_16 transparent{0, 0, 0, 0, 51};
    const std::vector<unsigned char> some{51, 52, 51, 0, 51, 255};
    out.push_back({"gray PNG with a transparent color",
                   pictures::png(3, 2, 8, PNG_COLOR_TYPE_GRAY, some, false, {}, {}, &transparent),
                   {}});
    out.back().numbers = png_numbers(out.back().bytes);
    for (const int channels : {1, 3}) {
        PictureCase& made = out.emplace_back();
        made.name = "JPEG of " + std::to_string(channels) + " channels";
        made.bytes =
            pictures::jpeg_of(kWidth, kHeight, channels, channels == 1 ? JCS_GRAYSCALE : JCS_RGB,
                              noise(static_cast<size_t>(channels) * kWidth * kHeight));
        made.numbers = jpeg_numbers(made.bytes);
    }
    const Imath::Box2i window({0, 0}, {3, 2});
    for (const char* channels : {"RGBA", "RGB", "Y"}) {
        std::vector<float> stored;
        const std::string letters(channels);
        for (int i = 0; i < 12; ++i) {
            const int place = 10 * (i / 4) + i % 4;
            for (int c = 0; c < 4; ++c) {  // as exr() numbers them
                const bool missing = c == 3 && letters.size() < 4;
                const int plane = letters.size() == 1 ? 0 : c;
                stored.push_back(missing ? 1.0f : static_cast<float>(100 * plane + place));
            }
        }
        out.push_back({std::string("EXR of ") + channels, pictures::exr(letters, window, window),
                       exr_numbers(stored), true});
    }
    return out;
}

PicturePtr picture_of(const PictureCase& from, ColorSpace space) {
    return make_picture(from.bytes, space, from.name);
}

/// The linear texels by the formula.
std::vector<float> linear_texels(const PictureCase& from, ColorSpace space) {
    std::vector<float> out = from.numbers;
    for (size_t i = 0; i < out.size() && !from.is_floats && space == ColorSpace::Srgb; ++i) {
        if (i % 4 != 3)
            out[i] = decode_srgb(out[i]);
    }
    return out;
}

/// The mean of a block of texels: color weighted by alpha, but where all is clear.
glm::dvec4 block_mean(const std::vector<float>& texels, int width, const ImageRegion& block) {
    glm::dvec4 sum(0.0);
    glm::dvec3 plain(0.0);
    for (int y = block.top; y < block.top + block.height; ++y) {
        for (int x = block.left; x < block.left + block.width; ++x) {
            const float* at = texels.data() + ptrdiff_t{4} * (ptrdiff_t{y} * width + x);
            const glm::dvec3 color(at[0], at[1], at[2]);
            const auto alpha = static_cast<double>(at[3]);
            sum += glm::dvec4(alpha * color, alpha);
            plain += color;
        }
    }
    const double count = static_cast<double>(block.width) * block.height;
    return {sum.w > 0 ? glm::dvec3(sum) / sum.w : plain / count, sum.w / count};
}

std::vector<float> block_means(const std::vector<float>& texels, int width, int height, int columns,
                               int rows) {
    std::vector<float> out;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            ImageRegion block{x * width / columns, y * height / rows, 0, 0};
            block.width = (x + 1) * width / columns - block.left;
            block.height = (y + 1) * height / rows - block.top;
            const glm::dvec4 mean = block_mean(texels, width, block);
            for (int c = 0; c < 4; ++c)
                out.push_back(static_cast<float>(mean[c]));
        }
    }
    return out;
}

TEST(TexelRows, EveryLayoutGivesTheBitsOfTheFormula) {
    for (const PictureCase& from : all_pictures()) {
        const Image plain = read(from.bytes, from.name);
        ASSERT_EQ(plain.pixels.size(), from.numbers.size()) << from.name;
        if (!from.is_floats) {
            EXPECT_EQ(plain.pixels, from.numbers) << from.name;
        }
        EXPECT_EQ(plain.linear, from.is_floats) << from.name;
        for (const ColorSpace space : {ColorSpace::Srgb, ColorSpace::Linear})
            EXPECT_EQ(decoded(*picture_of(from, space)).pixels, linear_texels(from, space))
                << from.name;
    }
}

TEST(TexelRows, FewerBitsAndChannelsTakeLessMemory) {
    EXPECT_EQ(read_packed(noisy_png(8, PNG_COLOR_TYPE_GRAY), "gray").row_bytes(), size_t{kWidth});
    EXPECT_EQ(read_packed(noisy_png(8, PNG_COLOR_TYPE_RGB), "rgb").row_bytes(), size_t{3} * kWidth);
    EXPECT_EQ(read_packed(noisy_png(16, PNG_COLOR_TYPE_GRAY_ALPHA), "wide").row_bytes(),
              size_t{4} * kWidth);
}

TEST(TexelRows, MeansAndSmallerPicturesHaveTheBitsOfAllTexelsAtOnce) {
    for (const PictureCase& from : all_pictures()) {
        const PicturePtr picture = picture_of(from, ColorSpace::Srgb);
        const std::vector<float> texels = linear_texels(from, ColorSpace::Srgb);
        const int width = picture->width;
        const int height = picture->height;
        EXPECT_EQ(picture->mean, block_mean(texels, width, {0, 0, width, height})) << from.name;
        const PackedPtr image = packed(*picture);
        const TexelRows rows(*image, ColorSpace::Srgb);
        for (const auto& [columns, lines] :
             {std::pair{1, 1}, std::pair{2, 2}, std::pair{3, 1}, std::pair{width, height}}) {
            const std::vector<float> wanted = block_means(texels, width, height, columns, lines);
            EXPECT_EQ(reduced(rows, columns, lines).pixels, wanted) << from.name;
            EXPECT_EQ(reduced(all_texels(rows), columns, lines).pixels, wanted) << from.name;
        }
        const TexelsPtr small = texels_of(*picture, 2);
        EXPECT_EQ(small->rgba, block_means(texels, width, height, small->width, small->height))
            << from.name;
    }
}

TEST(TexelRows, BlocksThatAreClearInTheirLastRowsAreWeightedByAlpha) {
    Image image;
    image.width = 4;
    image.height = 6;
    for (int i = 0; i < 24; ++i)
        image.pixels.insert(image.pixels.end(),
                            {static_cast<float>(i) / 24, 0.5f, 0.1f, i < 9 ? 1.0f : 0.0f});
    const Image small = reduced(image, 2, 2);
    EXPECT_EQ(small.pixels, block_means(image.pixels, 4, 6, 2, 2));
}

TEST(TexelRows, MapsGiveTheBitsOfTheTexturesValues) {
    for (const PictureCase& from : all_pictures()) {
        Texture texture;
        texture.picture = picture_of(from, ColorSpace::Srgb);
        texture.scale = {0.8, -0.3, 1.7};
        texture.offset = {0.05, 0.6, -0.2};
        const std::vector<float> texels = linear_texels(from, ColorSpace::Srgb);
        const PackedPtr image = packed(*texture.picture);
        const auto square = [](double value) { return static_cast<float>(value * value); };
        for (const TextureChannel channel :
             {TextureChannel::Color, TextureChannel::Red, TextureChannel::Green,
              TextureChannel::Blue, TextureChannel::Alpha, TextureChannel::Luma}) {
            texture.channel = channel;
            std::vector<float> colors;
            std::vector<float> numbers;
            std::vector<uint8_t> steps;
            for (size_t i = 0; i < texels.size(); i += 4) {
                const glm::dvec4 texel(texels[i], texels[i + 1], texels[i + 2], texels[i + 3]);
                const glm::dvec3 color = color_of(texture, texel);
                const double number = number_of(texture, texel);
                for (int c = 0; c < 3; ++c) {
                    colors.push_back(square(color[c]));
                    numbers.push_back(square(number));
                }
                colors.push_back(texels[i + 3]);
                numbers.push_back(1);
                steps.push_back(
                    static_cast<uint8_t>(std::lround(255 * std::clamp(number, 0.0, 1.0))));
            }
            const auto all = [&](const TexelMap& map) {
                return all_texels(TexelRows(*image, ColorSpace::Srgb, map)).pixels;
            };
            const std::string place =
                from.name + ", channel " + std::to_string(static_cast<int>(channel));
            EXPECT_EQ(all(color_map(texture, square)), colors) << place;
            EXPECT_EQ(all(number_map(texture, square)), numbers) << place;
            EXPECT_EQ(mask_texels(texture).alpha, steps) << place;
        }
    }
}

}  // namespace
}  // namespace lodestone::image
