// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/image.h"

#include "base/color.h"
#include "base/files.h"
#include "image/codec/image_codecs.h"
#include "image/texel_rows.h"

#include <algorithm>

namespace lodestone::image {

Image read(std::string_view bytes, const std::string& name) {
    return unpacked(read_packed(bytes, name));
}

Image read(const std::filesystem::path& path) {
    return unpacked(read_packed(path));
}

Image read_region(const std::filesystem::path& path, const ImageRegion& part) {
    return unpacked(decode_exr(read_file(path), path.string(), part));
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
    return encode_png(packed(image), effort);
}

void write_png(const std::filesystem::path& path, const Image& image) {
    write_file(path, png_bytes(image));
}

}  // namespace lodestone::image
