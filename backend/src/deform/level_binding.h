// SPDX-License-Identifier: GPL-3.0-or-later
// Binding: ties simplified levels to the surface they were made from.
#pragma once

#include "deform/level_following.h"
#include "ray/mesh_scene.h"

#include <optional>

namespace lodestone::deform {

/// For each vertex of a mesh the lowest point of a pose that is at its position, and the number of
/// points where there is none.
std::vector<uint32_t> points_of(const Mesh& mesh, const PosedSurface& pose);

/// Binds levels of one mesh. Every place of a level is tied to the nearest triangle of those that
/// were collapsed into it, so that it follows its own sheet and not another one that happens to lie
/// near; likewise its error samples.
class LevelBinder {
public:
    /// `finest` is the mesh that levels are made from, its positions those of `surface`'s points.
    /// Keeps a reference to the surface. Throws Error(RaysUnavailable).
    LevelBinder(const Mesh& finest, const PoseSurface& surface);

    /// Nothing when the mesh has positions that the pose lacks.
    std::optional<BoundLevel> bind(simplify::TracedLevel&& level) const;

private:
    struct BindingTrace;
    void add_source_samples(const BindingTrace& trace, BoundLevel& level) const;
    void add_level_samples(const BindingTrace& trace, BoundLevel& level) const;

    const PoseSurface& surface_;
    std::vector<uint32_t> welded_;  // of each point: the lowest at its position
    std::vector<uint32_t> points_;  // of each of the mesh's vertices
    geometry::VertexRings rings_;   // of the pose, by lowest point
    ray::MeshScene scene_;          // of the pose
};

}  // namespace lodestone::deform
