// SPDX-License-Identifier: GPL-3.0-or-later
// The pose of an object that a caller hands over: what its source keeps from frame to frame.
#pragma once

#include "lodestone/lodestone.h"

#include "geometry/polygon_mesh.h"
#include "model/posed_surface.h"

#include <memory>

namespace lodestone::capi {

/// Null for an object that does not deform. `mesh` is what was made of the views, before repair.
std::shared_ptr<const PosedSurface> pose_of(const lds_mesh_view& view, const lds_object_info& info,
                                            const Mesh& mesh, size_t material_count);
std::shared_ptr<const PosedSurface> pose_of(const PolygonMesh& faces, const lds_object_info& info,
                                            const Mesh& mesh, size_t material_count);
/// Of strands, by their tubes.
std::shared_ptr<const PosedSurface> pose_of(const Mesh& tubes, const lds_object_info& info,
                                            size_t material_count);

}  // namespace lodestone::capi
