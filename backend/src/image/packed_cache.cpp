// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/packed_cache.h"

namespace lodestone::image {

PackedPtr packed(const Picture& picture) {
    return std::make_shared<const PackedImage>(read_packed(picture.bytes, picture.name));
}

}  // namespace lodestone::image
