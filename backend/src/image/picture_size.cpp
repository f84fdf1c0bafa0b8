// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/picture_size.h"

#include "base/error.h"
#include "image/codec/image_codecs.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>

namespace lodestone::image {
namespace {

/// The size that these first bytes of a file tell. Throws Error(BadFile).
PictureSize size_of(const std::string& bytes, const std::string& name) {
    using namespace std::string_view_literals;
    if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv))
        return png_size(bytes, name);
    if (bytes.starts_with("\xff\xd8\xff"sv))
        return jpeg_size(bytes, name);
    return {};
}

}  // namespace

std::optional<PictureSize> picture_size(const std::filesystem::path& path) {
    // The first bytes of a file, beyond which its size is not looked for.
    // Taste: profiles and previews before it are smaller; a larger value reads more of each file.
    constexpr size_t kBeginning = size_t{1} << 18u;
    std::string bytes(kBeginning, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<size_t>(std::max<std::streamsize>(file.gcount(), 0)));
    PictureSize size;
    try {
        size = size_of(bytes, path.string());
    } catch (const Error&) {
        return {};
    }
    if (size.texels() == 0 || size.texels() > kMostPixels)
        return {};
    return size;
}

}  // namespace lodestone::image
