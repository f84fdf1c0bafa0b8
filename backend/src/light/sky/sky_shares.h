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
/// The rounds of splits of one surface at most: of long edges, and two times by the shares.
/// Law: three times kSplitRounds.
inline constexpr int kMostSplitRounds = 3 * kSplitRounds;

/// The steps of a share in SkyShares::corners: a share is (byte / kShareSteps)^2, for the eye sees
/// steps of dark surfaces better.
/// Law: the largest byte.
inline constexpr int kShareSteps = 255;
uint8_t share_byte(double share);
double share_of_byte(uint8_t byte);
/// The steps of a tint's octave in SkyShares::tints.
/// Taste: 4 % each; a larger value has no room for deeper colors.
inline constexpr double kTintSteps = 16;
/// The byte of a part of a color beside its luminance, and the octaves of such a byte.
uint8_t tint_byte(double part, double luminance);
double octaves_of_tint(uint8_t byte);

/// How much a picture shows of a triangle, as a byte: 0: nothing; else its size, if that is known.
/// Law: the lowest byte but for nothing; sizes lie above it.
inline constexpr uint8_t kSeenOfAnySize = 1;
/// The byte of something that is seen and covers so many pixels, and back.
uint8_t size_byte(double pixels);
double pixels_of_size(uint8_t byte);

/// The sky that a surface sees, 0...1 of that of an open plane.
struct SkyShares {
    /// The edges at which triangles are split, round by round: large ones, where the share varies.
    std::vector<std::vector<geometry::WeldedEdge>> splits;
    uint32_t long_rounds = 0;      // of the splits, the first: those of long edges
    std::vector<uint8_t> corners;  // 3 a triangle of the split mesh
    /// The hue of an uneven sky's light, 2 a corner: how much more red and blue of the sky's
    /// color arrives than luminance. Empty: it is one hue.
    std::vector<uint8_t> tints;
    double mean = 1;    // of the whole surface
    uint32_t rays = 0;  // that told the share of a corner of any size, about
    /// By triangle of the mesh that was split: 0: its corners have few rays; kSeenOfAnySize: all;
    /// else those of something so large in a picture. Empty: all have all.
    std::vector<uint8_t> seen;
    /// By triangle as `seen`, 1: the shares are those of its back. Empty: none are.
    std::vector<uint8_t> behind;

    /// The bytes as which the shares are kept, and the shares of such bytes for a mesh of so many
    /// triangles: none where they are damaged.
    std::string bytes() const;
    static std::optional<SkyShares> of_bytes(std::string_view bytes, size_t triangles);
};

/// Whether all triangles that are seen (bytes as of SkyShares::seen) have the rays of things as large
/// or a quarter as large, on the side that is seen (`behind`, a byte not 0: the back; empty: none
/// are).
bool covers(const SkyShares& shares, std::span<const uint8_t> seen,
            std::span<const uint8_t> behind = {});
/// Counts all of a surface as seen, of which another picture saw `before` (empty: nothing is known):
/// the larger sizes, and what neither of them shows as if it covered a pixel.
void see_all(std::span<uint8_t> seen, std::span<const uint8_t> before);
/// Whether the shares are those of the mesh as it is, without splits.
bool whole(const Mesh& mesh, const SkyShares& shares);
/// Whether the shares are the light on a mesh: splits may be those of another one.
bool fits(const Mesh& mesh, const SkyShares& shares);
/// A mesh with its splits, and the triangle that each of its triangles is a part of.
struct SkySplitMesh {
    Mesh mesh;
    std::vector<uint32_t> sources;
};
/// The mesh with its splits; the same one for equal arguments. None where the shares are those of
/// another mesh.
std::optional<SkySplitMesh> split_for_sky(const Mesh& mesh, const SkyShares& shares);

}  // namespace lodestone::light
