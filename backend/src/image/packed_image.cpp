// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/packed_image.h"

#include "base/color.h"
#include "base/error.h"
#include "base/files.h"
#include "image/codec/image_codecs.h"
#include "image/kept_pixels.h"

#include <algorithm>
#include <array>
#include <bit>

namespace lodestone::image {
namespace {

/// The bytes of the largest file that is read.
/// Taste: larger files are no pictures; a larger value lets one take more than 2 GiB.
constexpr uint64_t kMostBytes = uint64_t{1} << 31u;

/// The bytes of encoded colors by linear ones.
struct SrgbBytes {
    /// The cells of 0...1, so narrow that none holds two of the limits between bytes.
    /// Law: more than 255 times the steepest slope of the transfer function, 12.92.
    static constexpr size_t kCells = 4096;

    std::array<unsigned char, kCells> first{};  // by cell: the byte at its beginning
    std::array<float, 257> begin{};             // by byte: the least number that has it

    SrgbBytes() {
        for (size_t byte = 1; byte < 256; ++byte) {
            // Bits of floats that are not negative have the order of the floats.
            uint32_t low = 0;
            uint32_t high = std::bit_cast<uint32_t>(1.0f);
            while (high - low > 1) {
                const uint32_t middle = low + (high - low) / 2;
                (byte_of(encode_srgb(std::bit_cast<float>(middle))) >= byte ? high : low) = middle;
            }
            begin[byte] = std::bit_cast<float>(high);
        }
        begin[256] = 2;  // none is above the last byte
        size_t byte = 0;
        for (size_t cell = 0; cell < kCells; ++cell) {
            while (begin[byte + 1] <= static_cast<float>(cell) / kCells)
                ++byte;
            first[cell] = static_cast<unsigned char>(byte);
        }
    }
};

}  // namespace

PackedImage blank_packed(int64_t width, int64_t height, int channels, int depth,
                         const std::string& name) {
    // Law: kMostPixels as a signed number, for the comparison.
    constexpr auto kMost = static_cast<int64_t>(kMostPixels);
    if (width < 1 || height < 1 || width > kMost || height > kMost || width * height > kMost)
        fail(Status::BadFile, "'", name, "': a picture of ", width, " x ", height,
             " pixels is empty or has more than ", kMost);
    PackedImage image;
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    image.channels = channels;
    image.depth = depth;
    image.bytes = std::make_unique_for_overwrite<unsigned char[]>(
        image.row_bytes() * static_cast<size_t>(image.height));
    return image;
}

PackedImage read_packed(std::string_view bytes, const std::string& name) {
    using namespace std::string_view_literals;
    if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv))
        return decode_png(bytes, name);
    if (bytes.starts_with("\xff\xd8\xff"sv))
        return decode_jpeg(bytes, name);
    if (bytes.starts_with("\x76\x2f\x31\x01"sv))
        return decode_exr(bytes, name);
    fail(Status::BadFile, "'", name, "' is not a PNG, JPEG or OpenEXR picture");
}

PackedImage read_packed(const std::filesystem::path& path) {
    return read_packed(read_file(path, kMostBytes), path.string());
}

unsigned char srgb_byte_of(float linear) {
    static const SrgbBytes kBytes;
    if (!(linear > 0))
        return 0;
    if (linear >= 1)
        return 255;
    const unsigned char first =
        kBytes.first[static_cast<size_t>(linear * static_cast<float>(SrgbBytes::kCells))];
    return static_cast<unsigned char>(first + (linear >= kBytes.begin[first + size_t{1}] ? 1 : 0));
}

PackedImage packed(const Image& image) {
    if (image.width < 1 || image.height < 1 || image.size() > kMostPixels ||
        image.pixels.size() != 4 * image.size())
        fail(Status::InvalidArgument, "an image of ", image.width, " x ", image.height, " with ",
             image.pixels.size(), " values cannot be a PNG");
    const auto alpha_of = [&](const float* pixel) { return byte_of(pixel[3]); };
    bool opaque = true;
    for (size_t i = 0; i < image.pixels.size() && opaque; i += 4)
        opaque = alpha_of(image.pixels.data() + i) == 255;
    PackedImage out = blank_packed(image.width, image.height, opaque ? 3 : 4, 8, "an image");
    const float* pixel = image.pixels.data();
    unsigned char* to = out.bytes.get();
    for (size_t i = 0; i < image.size(); ++i, pixel += 4, to += out.channels) {
        const float alpha = pixel[3] > 0 ? std::min(pixel[3], 1.0f) : 0.0f;
        for (size_t c = 0; c < 3; ++c) {
            if (!image.linear)
                to[c] = byte_of(pixel[c]);
            else
                to[c] = srgb_byte_of(alpha > 0 ? pixel[c] / alpha : pixel[c]);
        }
        if (!opaque)
            to[3] = alpha_of(pixel);
    }
    return out;
}

std::string png_bytes(const PackedImage& image, PngEffort effort) {
    if (image.width < 1 || image.height < 1 || image.depth != 8 || image.channels < 3)
        fail(Status::InvalidArgument, "a picture of ", image.width, " x ", image.height, " with ",
             image.channels, " channels of ", image.depth, " bits is not written as PNG");
    return encode_png(image, effort);
}

PackedPtr packed(const Picture& picture) {
    return kept_pixels(picture, [&picture] {
        return std::make_shared<const PackedImage>(read_packed(picture.bytes, picture.name));
    });
}

}  // namespace lodestone::image
