// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/picture.h"

namespace lodestone {

const char* suffix_of(PictureFormat format) {
    switch (format) {
        case PictureFormat::Jpeg:
            return "jpg";
        case PictureFormat::Exr:
            return "exr";
        case PictureFormat::Png:
            break;
    }
    return "png";
}

std::string file_name(const Picture& picture) {
    std::string name = hex16(picture.hash);
    name += '.';
    return name += suffix_of(picture.format);
}

}  // namespace lodestone
