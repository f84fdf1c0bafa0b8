// SPDX-License-Identifier: GPL-3.0-or-later
#include "ray/mesh_cover.h"

#include <bit>

namespace lodestone::ray {
namespace {

/// A point with less alpha shows nothing.
/// Taste: nobody sees less; a larger value loses thin veils.
constexpr double kLeastShown = 1.0 / 64;
// Points are looked up a little inside the triangle: on the very edge of a card a repeated picture
// shows its other side.
// Taste: the share of the way to the middle; a larger value may step over a narrow edge.
constexpr double kInside = 1.0 / 256;

/// A number uniform in [0, 1), by the point alone.
double chance(uint32_t triangle, double u, double v) {
    const auto bits = [](double value) {
        return uint64_t{std::bit_cast<uint32_t>(static_cast<float>(value))};
    };
    uint64_t x = (bits(u) << 32u | bits(v)) + triangle * 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 32u)) * 0xd6e8feb86659fd93u;
    x = (x ^ (x >> 29u)) * 0xa0761d6478bd642fu;
    return static_cast<double>((x ^ (x >> 32u)) >> 11u) * 0x1p-53;
}

}  // namespace

MeshCover::MeshCover(const Mesh& mesh, SkinPtr skin) : skin_(std::move(skin)) {
    mesh_.uvs = mesh.uvs;
    mesh_.colors = mesh.colors;
    mesh_.triangles = mesh.triangles;
    mesh_.slots = mesh.slots;
}

double MeshCover::alpha(uint32_t triangle, double u, double v) const {
    return skin_->alpha(mesh_, triangle, u, v);
}

bool MeshCover::ends_ray(uint32_t triangle, double u, double v) const {
    return ends_ray(alpha(triangle, u, v), triangle, u, v);
}

bool MeshCover::ends_ray(double alpha, uint32_t triangle, double u, double v) {
    return alpha >= 1 || (alpha > 0 && alpha > chance(triangle, u, v));
}

bool MeshCover::shows(uint32_t triangle, double u, double v) const {
    return alpha(triangle, u + kInside * (1.0 / 3 - u), v + kInside * (1.0 / 3 - v)) >= kLeastShown;
}

std::optional<double> MeshCover::uniform_alpha(uint32_t triangle) const {
    return skin_->uniform_alpha(mesh_, mesh_.slot(triangle));
}

}  // namespace lodestone::ray
