// SPDX-License-Identifier: GPL-3.0-or-later
// Sky visibility: the share of a uniform sky that the corners of a mesh see, weighted by cosine.
#pragma once

#include "geometry/edge_split_mesh.h"
#include "light/sky_scene.h"

#include <optional>

namespace lodestone::light {

/// The steps of a share in SkyShares::corners: a share is (byte / kShareSteps)^2, for the eye sees
/// steps of dark surfaces better.
/// Law: the largest byte.
inline constexpr int kShareSteps = 255;
uint8_t share_byte(double share);
double share_of_byte(uint8_t byte);

/// The sky that a surface sees, 0...1 of that of an open plane.
struct SkyShares {
    /// The edges at which triangles are split, round by round: large ones, where the share varies.
    std::vector<std::vector<geometry::WeldedEdge>> splits;
    std::vector<uint8_t> corners;  // 3 a triangle of the split mesh
    double mean = 1;               // of the whole surface

    /// The bytes as which the shares are kept, and the shares of such bytes for a mesh of so many
    /// triangles: none where they are damaged.
    std::string bytes() const;
    static std::optional<SkyShares> of_bytes(std::string_view bytes, size_t triangles);
};

/// The mesh with its splits; the same one for equal arguments. None where the shares are those of
/// another mesh.
std::optional<Mesh> split_for_sky(const Mesh& mesh, const SkyShares& shares);

/// A placed surface, and what is around it.
struct SkyRequest {
    const SkySurface& surface;
    Affine world;
    /// All that hides the sky, the finest level of this surface too; null: the surface alone hides
    /// the sky from itself.
    const SkyScene* around = nullptr;
    double error = 0;   // metres, own frame: how far the surface may lie from its finest level
    int rays = 128;     // about so many tell the share of a corner
    size_t splits = 0;  // about how many triangles splits may add
};

/// The shares of all corners. Each triangle's rays begin all over it. What they tell goes to the
/// corners as far as these are near, so that the mean of the surface is kept, and corners at one
/// place that face the same way share one number. An opaque triangle's share is that of its front,
/// with half of its back's where that is dark and the mesh is open; one with masks or clear
/// materials (leaves) has the mean of both sides. Triangles that lie inside
/// of something opaque tell nothing to corners that others share. The result does not depend on the
/// number of threads. cost: `rays` rays a vertex, and a quarter more for splits
SkyShares sky_shares(const SkyRequest& request, const Job& job);

/// The means, over the surface, of the shares of the whole request and of the surface alone, by so
/// many rays.
struct SkyMeans {
    double placed = 1;
    double alone = 1;
};
SkyMeans mean_sky_shares(const SkyRequest& request, int rays);

}  // namespace lodestone::light
