// SPDX-License-Identifier: GPL-3.0-or-later
// The pose of an object that a caller hands over: the surface that its source keeps from frame to
// frame.
#pragma once

#include "lodestone/lodestone.h"

#include "geometry/polygon_mesh.h"
#include "model/posed_surface.h"

#include <memory>

namespace lodestone::capi {

/// The pose of an object; null if it does not deform. `mesh` is the one made of the views, before
/// repair.
std::shared_ptr<const PosedSurface> pose_of(const lds_mesh_view& view, const lds_object_info& info,
                                            const Mesh& mesh, size_t material_count);
std::shared_ptr<const PosedSurface> pose_of(const PolygonMesh& faces, const lds_object_info& info,
                                            const Mesh& mesh, size_t material_count);
/// The pose of strands, by their tubes.
std::shared_ptr<const PosedSurface> pose_of(const Mesh& tubes, const lds_object_info& info,
                                            size_t material_count);

}  // namespace lodestone::capi
