// SPDX-License-Identifier: GPL-3.0-or-later
// Picture files of every layout with known numbers, shared by the tests of their readers.
#pragma once

#include "base/files.h"
#include "scratch.h"

#include <jpeglib.h>
#include <png.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace lodestone::pictures {

/// A PNG of any layout; `rows` as libpng packs them.
inline std::string png(int width, int height, int depth, int color, std::vector<unsigned char> rows,
                       bool interlaced = false, const std::vector<png_color>& palette = {},
                       const std::vector<unsigned char>& palette_alpha = {},
                       const png_color_16* transparent = nullptr) {
    std::string out;
    png_structp file = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(file);
    png_set_write_fn(
        file, &out,
        [](png_structp f, png_bytep data, size_t size) {
            static_cast<std::string*>(png_get_io_ptr(f))
                ->append(reinterpret_cast<char*>(data), size);
        },
        nullptr);
    png_set_IHDR(file, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height),
                 depth, color, interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (!palette.empty())
        png_set_PLTE(file, info, palette.data(), static_cast<int>(palette.size()));
    if (!palette_alpha.empty() || transparent != nullptr)
        png_set_tRNS(file, info, palette_alpha.data(), static_cast<int>(palette_alpha.size()),
                     transparent);
    png_write_info(file, info);
    const size_t row = png_get_rowbytes(file, info);
    std::vector<png_bytep> starts;
    for (size_t y = 0; y < static_cast<size_t>(height); ++y)
        starts.push_back(rows.data() + y * row);
    png_write_image(file, starts.data());
    png_write_end(file, info);
    png_destroy_write_struct(&file, &info);
    return out;
}

/// A JPEG of rows of so many channels.
inline std::string jpeg_of(int width, int height, int channels, J_COLOR_SPACE space,
                           std::vector<unsigned char> rows) {
    jpeg_compress_struct file{};
    jpeg_error_mgr errors{};
    file.err = jpeg_std_error(&errors);
    jpeg_create_compress(&file);
    unsigned char* data = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&file, &data, &size);
    file.image_width = static_cast<JDIMENSION>(width);
    file.image_height = static_cast<JDIMENSION>(height);
    file.input_components = channels;
    file.in_color_space = space;
    jpeg_set_defaults(&file);
    jpeg_set_quality(&file, 100, TRUE);
    jpeg_start_compress(&file, TRUE);
    while (file.next_scanline < file.image_height) {
        unsigned char* start =
            rows.data() + size_t{file.next_scanline} * static_cast<size_t>(width * channels);
        jpeg_write_scanlines(&file, &start, 1);
    }
    jpeg_finish_compress(&file);
    jpeg_destroy_compress(&file);
    std::string out(reinterpret_cast<char*>(data), size);
    std::free(data);
    return out;
}

/// A JPEG of one value, of which a color's red is 255.
inline std::string jpeg(int width, int height, int channels, J_COLOR_SPACE space,
                        unsigned char value) {
    std::vector<unsigned char> rows(static_cast<size_t>(width * height * channels), value);
    for (size_t i = 0; channels == 3 && i < rows.size(); i += 3)
        rows[i] = 255;
    return jpeg_of(width, height, channels, space, std::move(rows));
}

/// Channels named by letters; pixel (x, y) of channel i is 100 i + 10 y + x, counted in the window.
inline std::string exr(const std::string& letters, const Imath::Box2i& data,
                       const Imath::Box2i& display) {
    const std::string path = (own_scratch() / "made.exr").string();
    {
        Imf::Header header(display, data);
        header.compression() = Imf::ZIP_COMPRESSION;
        const auto width = static_cast<size_t>(data.max.x - data.min.x) + 1;
        const auto height = static_cast<size_t>(data.max.y - data.min.y) + 1;
        std::vector<std::vector<float>> planes(letters.size());
        Imf::FrameBuffer buffer;
        for (size_t i = 0; i < letters.size(); ++i) {
            const std::string name(1, letters[i]);
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            for (size_t y = 0; y < height; ++y) {
                for (size_t x = 0; x < width; ++x)
                    planes[i].push_back(static_cast<float>(100 * i + 10 * y + x));
            }
            buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, planes[i].data(), data));
        }
        Imf::OutputFile file(path.c_str(), header, 0);
        file.setFrameBuffer(buffer);
        file.writePixels(static_cast<int>(height));
    }
    std::string bytes = read_file(path);
    std::filesystem::remove(path);
    return bytes;
}

}  // namespace lodestone::pictures
