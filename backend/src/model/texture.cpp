// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/texture.h"

namespace lodestone {

glm::dvec2 to_picture(const Texture& texture, glm::dvec2 uv) {
    const std::array<double, 6>& m = texture.to_picture;
    return {m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]};
}

Hash hash_of(const Texture& texture) {
    if (!texture)
        return 0;
    Hasher hasher;
    hasher.value(texture.picture->hash)
        .value(texture.channel)
        .value(texture.extension)
        .value(texture.interpolation)
        .array(std::span<const double>(texture.to_picture));
    for (int i = 0; i < 3; ++i)
        hasher.value(texture.scale[i]).value(texture.offset[i]);
    return hasher.result();
}

}  // namespace lodestone
