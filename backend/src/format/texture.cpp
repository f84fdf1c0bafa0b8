// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/texture.h"

namespace lodestone::format {

glm::dvec3 mean_of(const image::Image& picture, bool color) {
    glm::dvec3 sum(0.0);
    glm::dvec3 plain(0.0);
    double total = 0;
    for (size_t i = 0; i < picture.pixels.size(); i += 4) {
        const double alpha = static_cast<double>(picture.pixels[i + 3]);
        glm::dvec3 value;
        for (int channel = 0; channel < 3; ++channel) {
            const float at = picture.pixels[i + static_cast<size_t>(channel)];
            value[channel] =
                static_cast<double>(color && !picture.linear ? image::decode_srgb(at) : at);
        }
        plain += value;
        sum += picture.linear ? value : alpha * value;  // linear pictures hold color times alpha
        total += alpha;
    }
    if (total > 0)
        return sum / total;
    return picture.size() > 0 ? plain / static_cast<double>(picture.size()) : plain;
}

}  // namespace lodestone::format
