// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse/split_touching.h"

#include "base/disjoint_sets.h"
#include "base/parallel.h"
#include "simplify/collapse/adjacency.h"
#include "simplify/collapse/edge_neighbors.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace lodestone::simplify {
namespace {

Triangle sorted(Triangle t) {
    if (t.x > t.y)
        std::swap(t.x, t.y);
    if (t.y > t.z)
        std::swap(t.y, t.z);
    if (t.x > t.y)
        std::swap(t.x, t.y);
    return t;
}

}  // namespace

void split_layers(CollapseMesh& mesh) {
    const size_t count = mesh.triangles.size();
    // The most triangles of a vertex that are compared one by one.
    // Taste: sorting is faster for larger hubs only.
    constexpr size_t kFew = 32;
    std::unordered_map<uint64_t, uint32_t> moved;
    std::vector<std::pair<Triangle, uint32_t>> keys;  // the triangles of one lowest vertex
    // Those of them that coincide: a triangle and the first like it.
    std::vector<std::pair<uint32_t, uint32_t>> copies;
    std::unordered_map<uint32_t, uint32_t> layers;  // the layers so far, by the first triangle
    for (size_t begin = 0, end = 0; begin < count; begin = end) {
        keys.clear();
        for (; end < count; ++end) {
            const Triangle key = sorted(mesh.triangles[end]);
            if (!keys.empty() && key.x != keys[0].first.x)
                break;
            keys.emplace_back(key, static_cast<uint32_t>(end));
        }
        copies.clear();
        if (keys.size() > kFew) {
            std::sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) {
                return std::tie(a.first.y, a.first.z, a.second) <
                       std::tie(b.first.y, b.first.z, b.second);
            });
            for (size_t i = 1, first = 0; i < keys.size(); ++i) {
                if (keys[i].first == keys[first].first)
                    copies.emplace_back(keys[i].second, keys[first].second);
                else
                    first = i;
            }
            std::sort(copies.begin(), copies.end());
        } else {
            for (size_t i = 1; i < keys.size(); ++i) {
                for (size_t first = 0; first < i; ++first) {
                    if (keys[i].first.y != keys[first].first.y ||
                        keys[i].first.z != keys[first].first.z)
                        continue;
                    copies.emplace_back(keys[i].second, keys[first].second);
                    break;
                }
            }
        }
        for (const auto& [triangle, first] : copies) {
            const uint32_t layer = ++layers[first];
            for (int corner = 0; corner < 3; ++corner) {
                uint32_t& vertex = mesh.triangles[triangle][corner];
                const auto [entry, fresh] = moved.try_emplace(
                    (uint64_t{layer} << 32u) | vertex, static_cast<uint32_t>(mesh.points.size()));
                if (fresh)
                    mesh.copy_vertex(vertex);
                vertex = entry->second;
            }
        }
    }
}

void split_fans(CollapseMesh& mesh, Adjacency& adjacency) {
    adjacency.build(mesh);
    StampedSet seen;
    seen.resize(mesh.points.size());
    std::vector<uint32_t> parents;
    std::vector<uint32_t> copy_of_root;
    const auto vertices = static_cast<uint32_t>(mesh.points.size());
    // A vertex with one fan, all turned alike, needs no split. Most vertices have one, and
    // splitting others does not change it.
    // Vertices that one thread computes at a time.
    // Taste: larger chunks share the work less evenly.
    constexpr uint32_t kChunk = 8192;
    std::vector<uint8_t> whole(vertices, 0);
    parallel_for((vertices + kChunk - 1) / kChunk, [&](size_t chunk) {
        VertexNeighbors neighbors;
        const auto first = static_cast<uint32_t>(chunk * kChunk);
        for (uint32_t v = first; v < std::min(vertices, first + kChunk); ++v) {
            for (const uint32_t t : adjacency.ahead(v))
                __builtin_prefetch(&mesh.triangles[t]);
            const std::span<const uint32_t> ring = adjacency.around(v);
            whole[v] = neighbors.find_fan(mesh, ring, v) != VertexNeighbors::FanKind::None &&
                       neighbors.is_one(ring.size());
        }
    });
    for (uint32_t v = 0; v < vertices; ++v) {
        if (whole[v])
            continue;
        const std::span<const uint32_t> ring = adjacency.around(v);
        parents.resize(ring.size());
        std::iota(parents.begin(), parents.end(), 0u);
        seen.clear();
        for (uint32_t i = 0; i < ring.size(); ++i) {
            for (int corner = 0; corner < 3; ++corner) {
                // Copies made of other vertices have numbers from `vertices` on; fans keep them
                // apart already.
                const uint32_t u = mesh.triangles[ring[i]][corner];
                if (u == v)
                    continue;
                if (u >= seen.size())
                    seen.grow(mesh.points.size());
                if (seen.has(u))
                    join(parents, seen.number(u), i);
                else
                    seen.set(u, i);
            }
        }
        copy_of_root.assign(ring.size(), kNone);
        for (uint32_t i = 0; i < ring.size(); ++i) {
            const uint32_t root = root_of(parents, i);
            if (root == 0)
                continue;
            if (copy_of_root[root] == kNone)
                copy_of_root[root] = mesh.copy_vertex(v);
            Triangle& t = mesh.triangles[ring[i]];
            for (int corner = 0; corner < 3; ++corner) {
                if (t[corner] == v)
                    t[corner] = copy_of_root[root];
            }
        }
    }
    if (mesh.points.size() > vertices)
        adjacency.build(mesh);
}

void drop_copies(CollapseMesh& mesh) {
    std::vector<std::pair<Triangle, uint32_t>> keys;
    keys.reserve(mesh.live);
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (!mesh.dead(i))
            keys.emplace_back(sorted(mesh.triangles[i]), static_cast<uint32_t>(i));
    }
    std::sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) {
        return std::tie(a.first.x, a.first.y, a.first.z, a.second) <
               std::tie(b.first.x, b.first.y, b.first.z, b.second);
    });
    for (size_t i = 1; i < keys.size(); ++i) {
        if (keys[i].first != keys[i - 1].first)
            continue;
        mesh.triangles[keys[i].second].x = kNone;
        --mesh.live;
    }
}

void find_parts(CollapseMesh& mesh) {
    std::vector<uint32_t>& parents = mesh.parts;
    parents.resize(mesh.points.size());
    std::iota(parents.begin(), parents.end(), 0u);
    for (const Triangle& t : mesh.triangles) {
        join(parents, t.x, t.y);
        join(parents, t.y, t.z);
    }
    // A root is the lowest vertex of its part, so its number is known before it is needed.
    mesh.part_count = 0;
    std::vector<uint32_t> numbers(parents.size());
    for (uint32_t v = 0; v < parents.size(); ++v) {
        const uint32_t root = root_of(parents, v);
        numbers[v] = root == v ? mesh.part_count++ : numbers[root];
    }
    parents = std::move(numbers);
}

}  // namespace lodestone::simplify
