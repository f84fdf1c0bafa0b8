// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/image.h"

#include "base/color.h"
#include "base/error.h"
#include "base/files.h"
#include "image/image_codecs.h"

#include <algorithm>
#include <cmath>

namespace lodestone::image {
namespace {

/// The bytes of the largest file that is read.
/// Taste: larger files are no pictures; a larger value lets one take more than 2 GiB.
constexpr uint64_t kMostBytes = uint64_t{1} << 31u;

unsigned char byte_of(float value) {
    return static_cast<unsigned char>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

}  // namespace

Image blank_image(int64_t width, int64_t height, bool linear, const std::string& name) {
    // Law: kMostPixels as a signed number, for the comparison.
    constexpr auto kMost = static_cast<int64_t>(kMostPixels);
    if (width < 1 || height < 1 || width > kMost || height > kMost || width * height > kMost)
        fail(Status::BadFile, "'", name, "': a picture of ", width, " x ", height,
             " pixels is empty or has more than ", kMost);
    Image image;
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    image.linear = linear;
    image.pixels.resize(4 * image.size(), 0.0f);
    return image;
}

Image read(std::string_view bytes, const std::string& name) {
    using namespace std::string_view_literals;
    if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv))
        return decode_png(bytes, name);
    if (bytes.starts_with("\xff\xd8\xff"sv))
        return decode_jpeg(bytes, name);
    if (bytes.starts_with("\x76\x2f\x31\x01"sv))
        return decode_exr(bytes, name);
    fail(Status::BadFile, "'", name, "' is not a PNG, JPEG or OpenEXR picture");
}

Image read(const std::filesystem::path& path) {
    return read(read_file(path, kMostBytes), path.string());
}

Image read_region(const std::filesystem::path& path, const ImageRegion& part) {
    return decode_exr(read_file(path), path.string(), part);
}

Image encoded(const Image& image) {
    if (!image.linear)
        return image;
    Image out = image;
    out.linear = false;
    for (size_t i = 0; i < out.pixels.size(); i += 4) {
        float* pixel = out.pixels.data() + i;
        const float alpha = pixel[3] > 0 ? std::min(pixel[3], 1.0f) : 0.0f;
        for (int channel = 0; channel < 3; ++channel) {
            const float straight = alpha > 0 ? pixel[channel] / alpha : pixel[channel];
            // The comparison is false for a value that is not a number.
            pixel[channel] = straight >= 1 ? 1.0f : straight > 0 ? encode_srgb(straight) : 0.0f;
        }
        pixel[3] = alpha;
    }
    return out;
}

std::string png_bytes(const Image& image, PngEffort effort) {
    if (image.width < 1 || image.height < 1 || image.size() > kMostPixels ||
        image.pixels.size() != 4 * image.size())
        fail(Status::InvalidArgument, "an image of ", image.width, " x ", image.height, " with ",
             image.pixels.size(), " values cannot be a PNG");
    const Image display = encoded(image);
    bool opaque = true;
    for (size_t i = 3; i < display.pixels.size(); i += 4)
        opaque = opaque && byte_of(display.pixels[i]) == 255;
    const int channels = opaque ? 3 : 4;
    std::vector<unsigned char> rows;
    rows.reserve(display.size() * static_cast<size_t>(channels));
    for (size_t i = 0; i < display.pixels.size(); i += 4) {
        for (int channel = 0; channel < channels; ++channel)
            rows.push_back(byte_of(display.pixels[i + static_cast<size_t>(channel)]));
    }
    return encode_png(rows, image.width, image.height, channels, effort);
}

void write_png(const std::filesystem::path& path, const Image& image) {
    write_file(path, png_bytes(image));
}

}  // namespace lodestone::image
