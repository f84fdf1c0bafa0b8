// SPDX-License-Identifier: GPL-3.0-or-later
// VisibleAttributes: attributes of the visible surface of a mesh, by rays (dissertation 4.2.4).
#pragma once

#include "base/job.h"
#include "measure/visible/visible_sampler.h"
#include "model/attributes.h"
#include "model/material.h"
#include "ray/mesh_scene.h"

#include <span>

namespace lodestone::measure {

/// The number of rays of a measurement, and when they end.
struct VisibleOptions {
    uint64_t rays = 4096;  // the number of rays, when relative_error is 0
    /// Rays end earlier, once the last half of them moved the centroid by less than this share of
    /// the radius of gyration, and the area by less than five times this share of it; 0: never.
    double settled = 0;
    /// Not 0: rays are cast until visible_area is known to this relative error (95 % confidence).
    double relative_error = 0;
    /// The number of rays is never larger than this; at most 2^32 - 1.
    uint64_t most_rays = uint64_t{1} << 20u;
    uint64_t seed = 1;
    CastMethod casting = CastMethod::Best;
};

/// The result of a measurement.
struct VisibleAttributes {
    Attributes attributes;
    std::vector<uint64_t> hits_by_tag;  // visible points found on each tag; empty without tags
    /// Shares of the visible area; empty also where nothing is visible.
    std::vector<double> share_by_tag;
    uint64_t pilot_rays = 0;  // rays that were cast besides Attributes::rays
};

/// Attributes of the visible surface in the mesh's frame. `materials` are by slot (a slot without
/// one looks like Material{}). Their textures count: transparent points are left out, and surface
/// properties are means over the visible area of what each point shows. `tags` is empty or has one
/// number < 2^24 for each triangle, for instance which child it came from. A mesh without area, or
/// one that no ray hits, has empty attributes. A mesh that hides nothing of itself (one convex
/// body, one flat sheet) is measured exactly by traversal, after a pilot of rays has agreed. The
/// bits are the same on any number of threads. Throws Error: InvalidArgument, RaysUnavailable,
/// Cancelled, BadFile (a picture).
VisibleAttributes measure_visible(const Mesh& mesh, std::span<const Material> materials,
                                  const VisibleOptions& options,
                                  std::span<const uint32_t> tags = {}, const Job& job = {});

/// Measures with a scene made from this mesh and this skin before; a null skin: all looks like
/// Material{}.
VisibleAttributes measure_visible(const Mesh& mesh, const ray::MeshScene& scene,
                                  const ray::SkinPtr& skin, const VisibleOptions& options,
                                  std::span<const uint32_t> tags = {}, const Job& job = {});

/// Measures with a sampler made before for this mesh, seed, casting and relative error. `known`
/// holds the points that its first rays found, if they have been cast already.
VisibleAttributes measure_visible(const Mesh& mesh, const VisibleSampler& sampler,
                                  const ray::SkinPtr& skin, const VisibleOptions& options,
                                  std::span<const uint32_t> tags = {},
                                  std::span<const CastPoints> known = {}, const Job& job = {});

/// The visible area alone (m^2), by a fixed number of rays: that of measure_visible(), in less
/// time.
double visible_area(const VisibleSampler& sampler, uint64_t rays, const Job& job = {});

}  // namespace lodestone::measure
