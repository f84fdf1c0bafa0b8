// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/counted_error.h"

#include <algorithm>

namespace lodestone::hierarchy {
namespace {

// An error below this fraction of the size is float noise; the finest alone has error 0.
// Law: positions are floats, which have 24 bits.
constexpr double kLeastRelativeError = 1e-7;
// Roads, pavements and lawns lie on the ground in thin layers. A level that sinks by a little more
// than the layer is thick hides it, which shows from as far as the layer is wide: environment
// counts as this many times wider than it is off.
// Taste: a larger value keeps the ground finer from afar and costs more triangles.
constexpr double kLayerWidth = 16;
// A thing is flat where it is, in the standard deviations of its surface, this much thinner than
// wide.
// Taste: a larger value takes thicker things for layers.
constexpr double kFlat = 0.05;

}  // namespace

double counted_error(double error, bool environment, double size) {
    return std::max((environment ? kLayerWidth : 1) * error, kLeastRelativeError * size);
}

bool is_flat(double across, double through) {
    return through < kFlat * kFlat * across;
}

bool is_flat(const Attributes& attributes) {
    const auto variance = [&](int axis) {
        const glm::dvec3& along = attributes.axes[axis];
        return glm::dot(along, attributes.moments * along);
    };
    return !attributes.empty() && is_flat(variance(1), variance(2));
}

}  // namespace lodestone::hierarchy
