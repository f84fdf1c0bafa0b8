// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/penumbra.h"

#include "quality/criterion.h"

#include <algorithm>
#include <cmath>

namespace lodestone::povray {

double widest_penumbra(const Light& sun, const View& view, std::span<const Bound> occluders) {
    constexpr double kFlattest = 0.1;  // sine of the elevation; below it shadows cross the scene
    if (!(sun.angle > 0) || occluders.empty())
        return 0;
    Bound all;
    for (const Bound& bound : occluders)
        all = merged(all, bound);
    const double floor = all.box.low.z;
    const double down = -glm::normalize(sun.direction).z;
    const double across = 2 * std::tan(std::min(sun.angle / 2, 1.5));
    double widest = 0;
    for (const Bound& bound : occluders) {
        const double way = down > kFlattest ? (bound.box.high.z - floor) / down : 2 * all.radius;
        const double z = std::max(0.0, distance(bound, view.camera.position) - way);
        widest = std::max(widest, way * across / quality::pixel_size(view, z));
    }
    return widest;
}

}  // namespace lodestone::povray
