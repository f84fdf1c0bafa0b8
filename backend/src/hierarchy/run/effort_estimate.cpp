// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/run/effort_estimate.h"

#include <algorithm>
#include <set>

namespace lodestone::hierarchy {
namespace {

// Measured on the sample scenes; they need not be right by more than a factor of two.
constexpr double kBuiltTrianglesPerSecond = 150000;
constexpr double kSecondsPerObject = 0.02;  // its rays and samples
constexpr double kSecondsPerPixel = 1e-5;   // of a picture with a few lights
constexpr double kSecondsToStart = 0.2;     // POV-Ray, and the empty scene

}  // namespace

double seconds_to_build(const Object& object, const BuildSettings& settings) {
    const uint64_t own = object.representations.at(0).summary.cost.triangles;
    // Groups are flattened to about a third of what they may be.
    const uint64_t read = object.group() ? std::min(own, settings.group_triangles) / 3 : own;
    return static_cast<double>(read) / kBuiltTrianglesPerSecond + kSecondsPerObject;
}

double seconds_to_draw(const Model& model, const choose::Cut& cut, const View& view) {
    std::set<Hash> distinct;
    uint64_t triangles = 0;
    for (const uint32_t index : cut.chosen) {
        const choose::CutNode& node = cut.nodes[index];
        const RepresentationSummary& summary =
            model.objects[node.object].representations[node.lod].summary;
        if (distinct.insert(summary.hash).second)
            triangles += summary.cost.triangles;
    }
    const double pixels = view.border ? double(view.border->width) * view.border->height
                                      : double(view.width) * view.height;
    return kSecondsToStart + kSecondsPerTriangle * static_cast<double>(triangles) +
           kSecondsPerOccurrence * static_cast<double>(cut.chosen.size()) +
           kSecondsPerPixel * pixels;
}

}  // namespace lodestone::hierarchy
