// SPDX-License-Identifier: GPL-3.0-or-later
// Sky shares: the share of the sky's light at each corner of a mesh, and as bytes that are kept.
#pragma once

#include "geometry/edge_split_mesh.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone::light {

/// Rounds of splits that follow the shares.
/// Taste: each halves an edge, so a larger value follows finer shade with more triangles.
inline constexpr int kSplitRounds = 4;

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

/// Whether the shares are those of the mesh as it is, without splits.
bool whole(const Mesh& mesh, const SkyShares& shares);
/// The mesh with its splits; the same one for equal arguments. None where the shares are those of
/// another mesh.
std::optional<Mesh> split_for_sky(const Mesh& mesh, const SkyShares& shares);

}  // namespace lodestone::light
