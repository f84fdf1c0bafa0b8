// SPDX-License-Identifier: GPL-3.0-or-later
// SurfaceSample: points of a mesh that distances are measured from.
#pragma once

#include "base/job.h"
#include "measure/deviation/distinct_looks.h"
#include "measure/deviation/look_scenes.h"
#include "measure/visible/visible_sampler.h"
#include "model/primitive.h"

#include <limits>

namespace lodestone::measure {

/// The look of a sample of which only the place counts (vertices lie on borders of looks).
/// Law: the largest number of 16 bits; LookPalette numbers fewer looks than that.
inline constexpr uint16_t kAnyLook = 0xffff;

/// A point, its share of a direction's weight, and what it looks like.
struct SurfaceSample {
    glm::dvec3 point;
    double weight;
    uint16_t look = kAnyLook;
    uint16_t slot = 0;         // the material slot it shows
    bool varies = false;       // its triangle shows other things elsewhere
    glm::dvec3 side{0.0};      // unit normal towards the viewer; 0: not known
    glm::dvec3 color{0.0};     // the shown color, display-encoded
    glm::dvec2 uv{0.0};        // texture coordinates, where the mesh has any
    double metres_per_uv = 0;  // points whose uv differ by 1 are at least so far apart
};

/// The look of a mesh: one number a triangle, its skin, and the palette that numbers the looks.
/// Empty looks: all triangles look alike. Without a skin everything is opaque and of its slot's
/// mean color.
struct SurfaceLooks {
    std::span<const uint16_t> looks;
    const LookPalette* palette = nullptr;
    ray::SkinPtr skin;
};

/// A vertex that draws something, and its share of the mesh's area: a third of its triangles'.
struct WeightedVertex {
    uint32_t vertex;
    double weight;
};

/// At most `most` vertices with weight, chosen evenly over the list; the weights of those left out
/// go to the others, so that the sum is the mesh's area in m^2.
std::vector<WeightedVertex> weighted_vertices(const Mesh& mesh, uint32_t most, uint64_t seed);

/// Adds points uniform in area, one in each of `count` equal steps along the list of triangles;
/// only their places count. No point is added where the scene shows nothing.
void add_area_samples(const Mesh& mesh, const ray::MeshScene& scene, uint32_t count, uint64_t seed,
                      std::vector<SurfaceSample>& out);
/// The same along some of the mesh's triangles.
void add_area_samples(const Mesh& mesh, const ray::MeshScene& scene,
                      std::span<const uint32_t> triangles, uint32_t count, uint64_t seed,
                      std::vector<SurfaceSample>& out);

/// Adds 25 points of each side of a box, its middle among them; each has its share of the side's
/// area in m^2. A few points all over would miss the ends of a long one.
void add_box_samples(const Primitive& box, std::vector<SurfaceSample>& out);

/// Adds the vertices themselves, where the scene shows anything at them.
void add_vertex_samples(const Mesh& mesh, const ray::MeshScene& scene,
                        const std::vector<WeightedVertex>& vertices,
                        std::vector<SurfaceSample>& out);

/// Adds points that rays from outside hit; they share the visible area of one side equally. On a
/// mesh with glass all points are added: rays end at glass, but eyes do not. Returns the points of
/// the sampler's first rays, up to twice as many as points were wanted; with glass none.
std::vector<CastPoints> add_visible_points(const Mesh& mesh, const VisibleSampler& sampler,
                                           const SurfaceLooks& surface, uint32_t count,
                                           const Job& job, std::vector<SurfaceSample>& out);

/// Adds vertices from beside which some ray sees infinity. `seen` marks the triangles that can be
/// seen, if that is known (else empty); a vertex of none of them is not asked for. `lift` is in
/// metres.
void add_visible_vertices(const Mesh& mesh, const ray::MeshScene& scene, const OutsideSides& sides,
                          std::span<const uint8_t> seen,
                          const std::vector<WeightedVertex>& vertices, double lift, uint64_t seed,
                          const Job& job, std::vector<SurfaceSample>& out);

}  // namespace lodestone::measure
