// SPDX-License-Identifier: GPL-3.0-or-later
// PNG reader and writer: pictures by libpng. It leaves its functions by longjmp: between setjmp and
// the last libpng call there are only plain values; everything that owns memory lives in the
// caller's frame.
#include "base/error.h"
#include "image/codec/image_codecs.h"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>

namespace lodestone::image {
namespace {

struct PngSource {
    const char* at;
    size_t left;
};

struct PngMessage {
    char text[160] = "";
};

void on_error(png_structp png, png_const_charp message) {
    auto* complaint = static_cast<PngMessage*>(png_get_error_ptr(png));
    std::strncpy(complaint->text, message, sizeof complaint->text - 1);
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep out, size_t size) {
    auto* source = static_cast<PngSource*>(png_get_io_ptr(png));
    if (size > source->left)
        png_error(png, "the file ends too early");
    std::memcpy(out, source->at, size);
    source->at += size;
    source->left -= size;
}

void on_write(png_structp png, png_bytep data, size_t size) {
    auto* out = static_cast<std::string*>(png_get_io_ptr(png));
    bool written = true;
    try {
        out->append(reinterpret_cast<const char*>(data), size);
    } catch (const std::bad_alloc&) {
        written = false;
    }
    if (!written)
        png_error(png, "out of memory");
}

void on_flush(png_structp) {}

struct PngReader {
    PngMessage complaint;
    PngSource source;
    png_structp png = nullptr;
    png_infop info = nullptr;
    size_t packed_row = 0;  // bytes of a row as the file packs it

    explicit PngReader(std::string_view bytes) : source{bytes.data(), bytes.size()} {
        png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &complaint, on_error, on_warning);
        if (png != nullptr)
            info = png_create_info_struct(png);
        if (info == nullptr) {
            png_destroy_read_struct(&png, nullptr, nullptr);
            throw std::bad_alloc();
        }
    }
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;
};

/// Reads up to the first row; afterwards rows have 8 or 16 bits a channel, with the file's gray, RGB
/// and alpha, a palette's color and alpha. False: see the complaint.
bool start(PngReader& reader) {
    if (setjmp(png_jmpbuf(reader.png)) != 0)  // NOLINT(cert-err52-cpp)
        return false;
    png_set_read_fn(reader.png, &reader.source, on_read);
    png_set_user_limits(reader.png, 1u << 26u, 1u << 26u);
    png_set_keep_unknown_chunks(reader.png, PNG_HANDLE_CHUNK_NEVER, nullptr, 0);
    png_read_info(reader.png, reader.info);
    reader.packed_row = png_get_rowbytes(reader.png, reader.info);
    png_set_expand(reader.png);  // palettes, 1...4 bits and transparent colors
    png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
    return true;
}

bool read_rows(PngReader& reader, png_bytepp rows) {
    if (setjmp(png_jmpbuf(reader.png)) != 0)  // NOLINT(cert-err52-cpp)
        return false;
    png_read_image(reader.png, rows);
    return true;
}

struct PngWriter {
    PngMessage complaint;
    std::string bytes;
    png_structp png = nullptr;
    png_infop info = nullptr;

    PngWriter() {
        png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &complaint, on_error, on_warning);
        if (png != nullptr)
            info = png_create_info_struct(png);
        if (info == nullptr) {
            png_destroy_write_struct(&png, nullptr);
            throw std::bad_alloc();
        }
    }
    ~PngWriter() { png_destroy_write_struct(&png, &info); }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;
};

bool write_rows(PngWriter& writer, const PackedImage& image, PngEffort effort) {
    if (setjmp(png_jmpbuf(writer.png)) != 0)  // NOLINT(cert-err52-cpp)
        return false;
    png_set_write_fn(writer.png, &writer.bytes, on_write, on_flush);
    png_set_user_limits(writer.png, 1u << 26u, 1u << 26u);
    png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(image.width),
                 static_cast<png_uint_32>(image.height), 8,
                 image.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (effort == PngEffort::Quick) {
        png_set_compression_level(writer.png, 0);
        png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    }
    png_write_info(writer.png, writer.info);
    for (int y = 0; y < image.height; ++y)
        png_write_row(writer.png, image.row(y));
    png_write_end(writer.png, writer.info);
    return true;
}

}  // namespace

PictureSize png_size(std::string_view bytes, const std::string& name) {
    PngReader reader(bytes);
    if (!start(reader))
        fail(Status::BadFile, "'", name, "' is a broken PNG: ", reader.complaint.text);
    return {png_get_image_width(reader.png, reader.info),
            png_get_image_height(reader.png, reader.info)};
}

PackedImage decode_png(std::string_view bytes, const std::string& name) {
    PngReader reader(bytes);
    if (!start(reader))
        fail(Status::BadFile, "'", name, "' is a broken PNG: ", reader.complaint.text);
    const size_t width = png_get_image_width(reader.png, reader.info);
    const size_t height = png_get_image_height(reader.png, reader.info);
    const int channels = png_get_channels(reader.png, reader.info);
    const int depth = png_get_bit_depth(reader.png, reader.info);
    if ((depth != 8 && depth != 16) || channels < 1 || channels > 4 ||
        png_get_rowbytes(reader.png, reader.info) !=
            width * static_cast<size_t>(channels) * static_cast<size_t>(depth / 8))
        fail(Status::BadFile, "'", name, "' is a PNG of an unknown layout");
    // Deflate shrinks at most 1032 times: a header that promises more lies, and is caught before
    // memory is spent on it.
    if (reader.packed_row * height / 1032 > bytes.size())
        fail(Status::BadFile, "'", name, "' is too short for ", width, " x ", height, " pixels");
    PackedImage image = blank_packed(static_cast<int64_t>(width), static_cast<int64_t>(height),
                                     channels, depth, name);
    std::vector<png_bytep> rows(height);
    for (size_t y = 0; y < height; ++y)
        rows[y] = image.row(static_cast<int>(y));
    if (!read_rows(reader, rows.data()))
        fail(Status::BadFile, "'", name, "' is a broken PNG: ", reader.complaint.text);
    return image;
}

std::string encode_png(const PackedImage& image, PngEffort effort) {
    PngWriter writer;
    if (!write_rows(writer, image, effort))
        fail(Status::Internal, "a PNG could not be made: ", writer.complaint.text);
    return std::move(writer.bytes);
}

}  // namespace lodestone::image
