// SPDX-License-Identifier: GPL-3.0-or-later
// JPEG reader: pictures by libjpeg. It reports errors through a function that must not return: ours
// jumps out. Between setjmp and the last libjpeg call there are only plain values; memory is owned
// by the caller's frame.
#include "base/error.h"
#include "image/codec/image_codecs.h"

#include <jpeglib.h>

#include <csetjmp>
#include <cstdio>
#include <jerror.h>

namespace lodestone::image {
namespace {

/// Scans of a picture.
/// Taste: real pictures have some ten; a scan of a few bytes makes libjpeg go through the whole
/// picture, so a larger value lets small files take longer.
constexpr int kMostScans = 500;

struct JpegReader {
    jpeg_decompress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg_progress_mgr progress{};
    std::jmp_buf out{};
    char complaint[JMSG_LENGTH_MAX] = "";

    JpegReader() = default;
    ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;
};

void on_error(j_common_ptr jpeg) {
    auto* reader = static_cast<JpegReader*>(jpeg->client_data);
    jpeg->err->format_message(jpeg, reader->complaint);
    std::longjmp(reader->out, 1);  // NOLINT(cert-err52-cpp)
}

void on_message(j_common_ptr jpeg, int level) {
    // libjpeg would fill the rest of a torn picture with gray.
    if (level < 0 &&
        (jpeg->err->msg_code == JWRN_JPEG_EOF || jpeg->err->msg_code == JWRN_HIT_MARKER))
        on_error(jpeg);
}

void on_progress(j_common_ptr jpeg) {
    if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number <= kMostScans)
        return;
    auto* reader = static_cast<JpegReader*>(jpeg->client_data);
    std::snprintf(reader->complaint, sizeof reader->complaint, "more than %d scans", kMostScans);
    std::longjmp(reader->out, 1);  // NOLINT(cert-err52-cpp)
}

bool start(JpegReader& reader, std::string_view bytes) {
    if (setjmp(reader.out) != 0)  // NOLINT(cert-err52-cpp)
        return false;
    reader.jpeg.err = jpeg_std_error(&reader.errors);
    reader.errors.error_exit = on_error;
    reader.errors.emit_message = on_message;
    reader.jpeg.client_data = &reader;
    jpeg_create_decompress(&reader.jpeg);
    reader.jpeg.client_data = &reader;
    reader.progress.progress_monitor = on_progress;
    reader.jpeg.progress = &reader.progress;
    reader.jpeg.mem->max_memory_to_use = 1l << 30;
    jpeg_mem_src(&reader.jpeg, reinterpret_cast<const unsigned char*>(bytes.data()),
                 static_cast<unsigned long>(bytes.size()));
    jpeg_read_header(&reader.jpeg, TRUE);
    return true;
}

bool begin_rows(JpegReader& reader) {
    if (setjmp(reader.out) != 0)  // NOLINT(cert-err52-cpp)
        return false;
    jpeg_start_decompress(&reader.jpeg);
    return true;
}

bool next_row(JpegReader& reader, unsigned char* row) {
    if (setjmp(reader.out) != 0)  // NOLINT(cert-err52-cpp)
        return false;
    return jpeg_read_scanlines(&reader.jpeg, &row, 1) == 1;
}

}  // namespace

PictureSize jpeg_size(std::string_view bytes, const std::string& name) {
    JpegReader reader;
    if (!start(reader, bytes))
        fail(Status::BadFile, "'", name, "' is a broken JPEG: ", reader.complaint);
    return {reader.jpeg.image_width, reader.jpeg.image_height};
}

PackedImage decode_jpeg(std::string_view bytes, const std::string& name) {
    JpegReader reader;
    if (!start(reader, bytes))
        fail(Status::BadFile, "'", name, "' is a broken JPEG: ", reader.complaint);
    const J_COLOR_SPACE space = reader.jpeg.jpeg_color_space;
    if (space == JCS_CMYK || space == JCS_YCCK)
        fail(Status::BadFile, "'", name, "' is a CMYK JPEG; save it as RGB");
    if (space != JCS_GRAYSCALE && space != JCS_RGB && space != JCS_YCbCr)
        fail(Status::BadFile, "'", name, "' is a JPEG of an unknown color space");
    const int channels = space == JCS_GRAYSCALE ? 1 : 3;
    PackedImage image =
        blank_packed(reader.jpeg.image_width, reader.jpeg.image_height, channels, 8, name);
    reader.jpeg.out_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    if (!begin_rows(reader))
        fail(Status::BadFile, "'", name, "' is a broken JPEG: ", reader.complaint);
    for (int y = 0; y < image.height; ++y) {
        if (!next_row(reader, image.row(y)))
            fail(Status::BadFile, "'", name, "' is a broken JPEG: ", reader.complaint);
    }
    return image;
}

}  // namespace lodestone::image
