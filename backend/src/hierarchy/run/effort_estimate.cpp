// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/run/effort_estimate.h"

#include <algorithm>
#include <set>

namespace lodestone::hierarchy {
namespace {

// These are right within a factor of two, and need not be better.
// Fitted: to builds of the sample scenes; the script was not kept.
constexpr double kBuiltTrianglesPerSecond = 150000;
// The CPU seconds of an object's rays and samples.
// Fitted: as kBuiltTrianglesPerSecond.
constexpr double kSecondsPerObject = 0.02;

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
    return model.costs.start_s + model.costs.triangle_s * static_cast<double>(triangles) +
           model.costs.occurrence_s * static_cast<double>(cut.chosen.size()) +
           model.costs.pixel_s * pixels;
}

}  // namespace lodestone::hierarchy
