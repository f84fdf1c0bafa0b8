// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/edge_split_mesh.h"

#include <algorithm>
#include <array>
#include <unordered_map>

namespace lodestone::geometry {
namespace {

/// The middles of edges that are made so far: by the edge's own vertices, and by its welded ones.
struct EdgeMiddles {
    std::unordered_map<uint64_t, uint32_t> of_vertices;
    std::unordered_map<WeldedEdge, uint32_t> of_edges;
};

}  // namespace

WeldedEdge welded_edge(uint32_t a, uint32_t b) {
    return uint64_t{std::min(a, b)} << 32u | std::max(a, b);
}

EdgeSplitMesh::EdgeSplitMesh(const Mesh& mesh) : mesh_(mesh) {
    check(mesh_);
    welded_ = weld(mesh_);
}

WeldedEdge EdgeSplitMesh::edge(size_t triangle, int corner) const {
    const Triangle& t = mesh_.triangles[triangle];
    return welded_edge(welded_[t[corner]], welded_[t[(corner + 1) % 3]]);
}

bool EdgeSplitMesh::splits(std::span<const WeldedEdge> edges, size_t triangle, int corner) const {
    return std::binary_search(edges.begin(), edges.end(), edge(triangle, corner));
}

size_t EdgeSplitMesh::triangles_after(std::span<const WeldedEdge> edges) const {
    size_t count = mesh_.triangles.size();
    for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner)
            count += splits(edges, i, corner) ? 1 : 0;
    }
    return count;
}

std::vector<uint32_t> EdgeSplitMesh::split(std::span<const WeldedEdge> edges) {
    EdgeMiddles middles;
    const auto middle_of = [&](uint32_t a, uint32_t b) {
        const auto [at, fresh] = middles.of_vertices.try_emplace(
            welded_edge(a, b), static_cast<uint32_t>(mesh_.positions.size()));
        if (!fresh)
            return at->second;
        // The middle is the same number from both sides, as sums do not depend on the order.
        mesh_.positions.push_back(0.5f * (mesh_.positions[a] + mesh_.positions[b]));
        if (!mesh_.normals.empty()) {
            const glm::vec3 sum = mesh_.normals[a] + mesh_.normals[b];
            const float length = glm::length(sum);
            mesh_.normals.push_back(length > 0 ? sum / length : mesh_.normals[a]);
        }
        if (!mesh_.uvs.empty())
            mesh_.uvs.push_back(0.5f * (mesh_.uvs[a] + mesh_.uvs[b]));
        if (!mesh_.colors.empty())
            mesh_.colors.push_back(0.5f * (mesh_.colors[a] + mesh_.colors[b]));
        const uint32_t made = at->second;
        welded_.push_back(
            middles.of_edges.try_emplace(welded_edge(welded_[a], welded_[b]), made).first->second);
        return made;
    };

    std::vector<Triangle> triangles;
    std::vector<uint16_t> slots;
    std::vector<uint32_t> parents;
    triangles.reserve(mesh_.triangles.size());
    parents.reserve(mesh_.triangles.size());
    for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
        const std::array<bool, 3> cut{splits(edges, i, 0), splits(edges, i, 1),
                                      splits(edges, i, 2)};
        const auto cuts = std::count(cut.begin(), cut.end(), true);
        Triangle t = mesh_.triangles[i];
        // The triangle is turned so that its first edge is split, and of two the first two are.
        int turn = 0;
        const auto at = [&](int edge) { return cut[static_cast<size_t>((edge + turn) % 3)]; };
        while (cuts > 0 && cuts < 3 && !(at(0) && (cuts == 1 || at(1))))
            ++turn;
        t = Triangle(t[turn % 3], t[(turn + 1) % 3], t[(turn + 2) % 3]);
        const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
            triangles.emplace_back(a, b, c);
            parents.push_back(static_cast<uint32_t>(i));
            if (!mesh_.slots.empty())
                slots.push_back(mesh_.slots[i]);
        };
        if (cuts == 0) {
            add(t.x, t.y, t.z);
            continue;
        }
        const uint32_t ab = middle_of(t.x, t.y);
        if (cuts == 1) {
            add(t.x, ab, t.z);
            add(ab, t.y, t.z);
            continue;
        }
        const uint32_t bc = middle_of(t.y, t.z);
        if (cuts == 2) {
            add(ab, t.y, bc);
            add(t.x, ab, bc);
            add(t.x, bc, t.z);
            continue;
        }
        const uint32_t ca = middle_of(t.z, t.x);
        add(t.x, ab, ca);
        add(ab, t.y, bc);
        add(ca, bc, t.z);
        add(ab, bc, ca);
    }
    mesh_.triangles = std::move(triangles);
    mesh_.slots = std::move(slots);
    return parents;
}

}  // namespace lodestone::geometry
