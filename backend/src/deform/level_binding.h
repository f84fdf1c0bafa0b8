// SPDX-License-Identifier: GPL-3.0-or-later
// Level binding: ties simplified levels to the surface they were made from.
#pragma once

#include "deform/level_following.h"
#include "ray/mesh_scene.h"

#include <optional>

namespace lodestone::deform {

/// For each vertex of a mesh the lowest point of a pose at its position, or the number of points
/// where there is none.
std::vector<uint32_t> points_of(const Mesh& mesh, const PosedSurface& pose);

/// Binds levels of one mesh. Every place of a level is tied to the nearest of the triangles that
/// were collapsed into it, so that it follows its own sheet and not another one that happens to lie
/// near; so are its error samples.
class LevelBinder {
public:
    /// `finest`: the mesh that levels are made from, its positions being those of `surface`'s
    /// points. Keeps a reference to the surface. Throws Error(RaysUnavailable).
    LevelBinder(const Mesh& finest, const PoseSurface& surface);

    /// The bound level; none when the mesh has positions that the pose lacks.
    std::optional<BoundLevel> bind(simplify::TracedLevel&& level) const;

private:
    struct BindingTrace;
    void add_source_samples(const BindingTrace& trace, BoundLevel& level) const;
    void add_level_samples(const BindingTrace& trace, BoundLevel& level) const;

    const PoseSurface& surface_;
    std::vector<uint32_t> welded_;  // for each point the lowest one at its position
    std::vector<uint32_t> points_;  // for each of the mesh's vertices
    geometry::VertexRings rings_;   // those of the pose, by lowest point
    ray::MeshScene scene_;          // the triangles of the pose
};

}  // namespace lodestone::deform
