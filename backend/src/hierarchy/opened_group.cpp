// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/opened_group.h"

namespace lodestone::hierarchy {
namespace {

/// A view in which a representation is good enough when its error is at most `error`.
View view_within(double error) {
    View view;
    view.camera.orthographic = true;
    view.camera.right = {1, 0, 0};
    view.camera.up = {0, 1, 0};
    view.width = view.height = 1;
    view.pixel_error = error;
    return view;
}

uint64_t triangles_of(const Model& model, const choose::Cut& cut) {
    uint64_t triangles = cut.triangles;
    for (const uint32_t index : cut.chosen) {
        const choose::CutNode& node = cut.nodes[index];
        const Representation& drawn = model.objects[node.object].representations[node.lod];
        if (drawn.summary.kind != Kind::Mesh)
            triangles += solid_triangles(drawn.summary.kind, drawn.payload);
    }
    return triangles;
}

}  // namespace

OpenedGroup::OpenedGroup(const Model& model, ObjectIndex group, const std::vector<uint64_t>& uses)
    : table_(model, View{}.kinds), group_(group), uses_(uses) {}

choose::Cut OpenedGroup::cut(double error, const Job& job) {
    return choose::choose_below(table_, group_, view_within(error), job);
}

DrawnCosts OpenedGroup::drawn_within(double error, const Job& job) {
    if (const auto known = drawn_.find(error); known != drawn_.end())
        return known->second;
    const uint64_t placed = model().costs.occurrence_bytes;
    DrawnCosts drawn;
    const choose::Cut cut = this->cut(error, job);
    drawn.triangles = triangles_of(model(), cut);
    for (const uint32_t index : cut.chosen) {
        const choose::CutNode& node = cut.nodes[index];
        const RepresentationSummary& summary =
            model().objects[node.object].representations[node.lod].summary;
        drawn.bytes += static_cast<double>(placed) +
                       bytes_per_occurrence(summary.kind, summary.cost.bytes, uses_[node.object]);
        drawn.alone += static_cast<double>(placed + summary.cost.bytes);
    }
    drawn_.emplace(error, drawn);
    return drawn;
}

}  // namespace lodestone::hierarchy
