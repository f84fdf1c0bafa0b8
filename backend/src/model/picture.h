// SPDX-License-Identifier: GPL-3.0-or-later
// Picture: the bytes of an image file, as materials and worlds use it. Decoding is image/'s.
#pragma once

#include "base/hash.h"

#include <glm/vec4.hpp>

#include <cstdint>
#include <memory>
#include <string>

namespace lodestone {

enum class PictureFormat : uint8_t { Png = 0, Jpeg = 1, Exr = 2 };

/// The meaning of the stored numbers. An EXR's are linear whatever is said here.
enum class ColorSpace : uint8_t {
    Srgb = 0,    // display-encoded color
    Linear = 1,  // linear color, or data such as roughness and normals
};

/// An image. It never changes once made, and is shared by all that show it.
struct Picture {
    std::string name;  // the user's; any bytes
    PictureFormat format = PictureFormat::Png;
    ColorSpace space = ColorSpace::Srgb;
    int width = 0;
    int height = 0;
    std::string bytes;     // those of the file; empty while it is not resident
    Hash hash = 0;         // that of bytes and space
    glm::dvec4 mean{1.0};  // texel: linear color weighted by alpha, and alpha
};

using PicturePtr = std::shared_ptr<const Picture>;

/// The ending of its files' names: "png", "jpg" or "exr".
const char* suffix_of(PictureFormat format);

/// "<16 hex>.png" (or .jpg, .exr): the name of its file wherever it is written, by its hash.
std::string file_name(const Picture& picture);

}  // namespace lodestone
