// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/material.h"

namespace lodestone {

Hash hash_of(const Material& material) {
    Hasher hasher;
    for (int i = 0; i < 3; ++i)
        hasher.value(material.base_color[i]).value(material.emission[i]);
    return hasher.value(material.roughness)
        .value(material.metallic)
        .value(material.specular)
        .result();
}

}  // namespace lodestone
