// SPDX-License-Identifier: GPL-3.0-or-later
// Visible triangles: which triangles of a mesh can be seen from outside at all.
#pragma once

#include "base/job.h"
#include "measure/visible/outside_sides.h"
#include "ray/mesh_scene.h"

namespace lodestone::measure {

/// The triangles of the mesh that can be seen: 1 for each from which a ray reaches infinity, else
/// 0. Hidden triangles may be dropped before simplifying. Rays leave even points in even directions
/// (cosine), on both sides of parts that are not closed and opaque. A triangle larger than the mean
/// gets in proportion more rays, up to 64 times `rays_per_triangle`: a large one that was dropped
/// would leave a hole that is seen. Each triangle gets half of its rays first. One that shares a
/// corner with a triangle that is seen by then, or later in the same way, gets all of them and at
/// least 32 a side: what lies in an opening sees little of the sky, and an eye in the opening sees
/// nothing else. Triangles without area count as seen.
/// The bits are the same on any number of threads. Throws Error: InvalidArgument, RaysUnavailable,
/// Cancelled.
std::vector<uint8_t> seen_from_outside(const Mesh& mesh, const ray::MeshScene& scene,
                                       int rays_per_triangle, uint64_t seed, const Job& job = {});
/// Takes the sides of the mesh where they are known.
std::vector<uint8_t> seen_from_outside(const Mesh& mesh, const ray::MeshScene& scene,
                                       const OutsideSides& sides, int rays_per_triangle,
                                       uint64_t seed, const Job& job = {});

}  // namespace lodestone::measure
