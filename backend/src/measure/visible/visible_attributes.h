// SPDX-License-Identifier: GPL-3.0-or-later
// VisibleAttributes: attributes of what can be seen of a mesh, by rays (dissertation 4.2.4).
#pragma once

#include "base/job.h"
#include "measure/visible/visible_sampler.h"
#include "model/attributes.h"
#include "model/material.h"
#include "ray/mesh_scene.h"

#include <span>

namespace lodestone::measure {

struct VisibleOptions {
    uint64_t rays = 4096;  // the number of rays, when relative_error is 0
    double settled = 0;    // ... or fewer, once the last half of them moved the centroid by less
                           // than this share of the radius of gyration, and the area by less
                           // than five times this share of it
    double relative_error = 0;  // else: rays until visible_area is known this well, 95 % confidence
    uint64_t most_rays = uint64_t{1} << 20u;  // ... but never more than these; at most 2^32 - 1
    uint64_t seed = 1;
    CastMethod casting = CastMethod::Best;
};

struct VisibleAttributes {
    Attributes attributes;
    std::vector<uint64_t> hits_by_tag;  // visible points found on each tag; empty without tags
    std::vector<double> share_by_tag;   // of the visible area; empty also where nothing is visible
    uint64_t pilot_rays = 0;            // that were cast besides Attributes::rays
};

/// Attributes of the visible surface in the mesh's frame. `materials` are by slot (a slot without
/// one looks like Material{}). Their textures count: transparent points are left out, and surface
/// properties are means over the visible area of what each point shows. `tags` is empty or has one
/// number < 2^24 for each triangle, for instance which child it came from. A mesh without area, or
/// one that no ray hits, has empty attributes. A mesh that hides nothing of itself (one convex
/// body, one flat sheet) is measured exactly by traversal, after a pilot of rays has agreed. Same
/// bits on any number of threads. Throws Error: InvalidArgument, RaysUnavailable, Cancelled,
/// BadFile (a picture).
VisibleAttributes measure_visible(const Mesh& mesh, std::span<const Material> materials,
                                  const VisibleOptions& options,
                                  std::span<const uint32_t> tags = {}, const Job& job = {});

/// The same with a scene made from this mesh, and this skin, before; null: all like Material{}.
VisibleAttributes measure_visible(const Mesh& mesh, const ray::MeshScene& scene,
                                  const ray::SkinPtr& skin, const VisibleOptions& options,
                                  std::span<const uint32_t> tags = {}, const Job& job = {});

/// The same with a sampler made before for this mesh, seed, casting and relative error. `known`:
/// what its first rays found, if they have been cast already.
VisibleAttributes measure_visible(const Mesh& mesh, const VisibleSampler& sampler,
                                  const ray::SkinPtr& skin, const VisibleOptions& options,
                                  std::span<const uint32_t> tags = {},
                                  std::span<const CastPoints> known = {}, const Job& job = {});

/// The visible area alone, by a fixed number of rays: that of measure_visible(), in less time.
double visible_area(const VisibleSampler& sampler, uint64_t rays, const Job& job = {});

}  // namespace lodestone::measure
