// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/sheets.h"

#include "approximate/adjacency.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace lodestone::approximate {
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

uint32_t root_of(std::vector<uint32_t>& parents, uint32_t i) {
    while (parents[i] != i) {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    return i;
}

/// The lower index becomes the root, so roots do not depend on the order of joins.
void join(std::vector<uint32_t>& parents, uint32_t a, uint32_t b) {
    a = root_of(parents, a);
    b = root_of(parents, b);
    if (a != b)
        parents[std::max(a, b)] = std::min(a, b);
}

}  // namespace

void split_layers(CollapseMesh& mesh) {
    const size_t count = mesh.triangles.size();
    size_t size = 16;
    while (size < count * 2)
        size *= 2;
    std::vector<uint32_t> table(size, kNone);
    std::vector<uint32_t> copies;  // of the triangle a table entry names; made on first need
    std::unordered_map<uint64_t, uint32_t> moved;
    for (size_t i = 0; i < count; ++i) {
        const Triangle key = sorted(mesh.triangles[i]);
        uint64_t hash = (key.x + (uint64_t{key.y} << 32u)) * 0x9e3779b97f4a7c15u;
        hash = (hash ^ (hash >> 29u) ^ key.z) * 0xd6e8feb86659fd93u;
        hash ^= hash >> 32u;
        for (size_t at = hash & (size - 1);; at = (at + 1) & (size - 1)) {
            const uint32_t other = table[at];
            if (other == kNone) {
                table[at] = static_cast<uint32_t>(i);
                break;
            }
            // Only first copies are in the table, and those still have their own vertices.
            if (sorted(mesh.triangles[other]) != key)
                continue;
            if (copies.empty())
                copies.assign(count, 0);
            const uint32_t layer = ++copies[other];
            for (int corner = 0; corner < 3; ++corner) {
                uint32_t& vertex = mesh.triangles[i][corner];
                const auto [entry, fresh] = moved.try_emplace(
                    (uint64_t{layer} << 32u) | vertex, static_cast<uint32_t>(mesh.points.size()));
                if (fresh)
                    mesh.copy_vertex(vertex);
                vertex = entry->second;
            }
            break;
        }
    }
}

void split_fans(CollapseMesh& mesh) {
    Adjacency adjacency;
    adjacency.build(mesh);
    Marks seen;
    seen.resize(mesh.points.size());
    std::vector<uint32_t> parents;
    std::vector<uint32_t> copy_of_root;
    const auto vertices = static_cast<uint32_t>(mesh.points.size());
    for (uint32_t v = 0; v < vertices; ++v) {
        const std::span<const uint32_t> ring = adjacency.around(v);
        parents.resize(ring.size());
        std::iota(parents.begin(), parents.end(), 0u);
        seen.clear();
        for (uint32_t i = 0; i < ring.size(); ++i) {
            for (int corner = 0; corner < 3; ++corner) {
                // Copies made of other vertices lie past `vertices`; fans keep them apart already.
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
    // A root is the lowest vertex of its part, so its number is known before it is asked for.
    mesh.part_count = 0;
    std::vector<uint32_t> numbers(parents.size());
    for (uint32_t v = 0; v < parents.size(); ++v) {
        const uint32_t root = root_of(parents, v);
        numbers[v] = root == v ? mesh.part_count++ : numbers[root];
    }
    parents = std::move(numbers);
}

}  // namespace lodestone::approximate
