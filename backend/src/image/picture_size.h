// SPDX-License-Identifier: GPL-3.0-or-later
// PictureSize: how large the picture of a file is, told by the file's header alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace lodestone::image {

struct PictureSize {
    uint32_t width = 0;
    uint32_t height = 0;

    uint64_t texels() const { return uint64_t{width} * height; }
};

/// The size that the header of a PNG or JPEG file tells; none of what is neither, or is broken
/// there. Whether the rest can be decoded is not looked at.
std::optional<PictureSize> picture_size(const std::filesystem::path& path);

}  // namespace lodestone::image
