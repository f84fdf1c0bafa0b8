// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/picture_size.h"

#include "base/error.h"
#include "base/files.h"
#include "image/codec/image_codecs.h"

#include <string>
#include <string_view>

namespace lodestone::image {

std::optional<PictureSize> picture_size(const std::filesystem::path& path) {
    using namespace std::string_view_literals;
    // The largest file that is looked at.
    // Law: POV-Ray keeps more bytes of a picture, and files of one are no larger than 1 GiB.
    constexpr uint64_t kMostBytes = uint64_t{1} << 30u;
    PictureSize size;
    try {
        const std::string bytes = read_file(path, kMostBytes);
        if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv))
            size = png_size(bytes, path.string());
        else if (bytes.starts_with("\xff\xd8\xff"sv))
            size = jpeg_size(bytes, path.string());
    } catch (const Error&) {
        return {};
    }
    if (size.texels() == 0 || size.texels() > kMostPixels)
        return {};
    return size;
}

}  // namespace lodestone::image
