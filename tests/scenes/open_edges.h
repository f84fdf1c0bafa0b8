// SPDX-License-Identifier: GPL-3.0-or-later
// Open edges: where a surface ends, and so where it is torn.
#pragma once

#include "model/mesh.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace lodestone {

/// The edges, by the first vertices at their ends' places, that triangles do not use as often in
/// one direction as in the other: the border of the surface.
inline std::set<std::pair<uint32_t, uint32_t>> open_edges(const Mesh& mesh) {
    const std::vector<uint32_t> place = weld(mesh);
    std::vector<std::pair<std::pair<uint32_t, uint32_t>, int>> uses;
    uses.reserve(3 * mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            const uint32_t a = place[t[i]];
            const uint32_t b = place[t[(i + 1) % 3]];
            uses.push_back({{std::min(a, b), std::max(a, b)}, a < b ? 1 : -1});
        }
    }
    std::sort(uses.begin(), uses.end());
    std::set<std::pair<uint32_t, uint32_t>> open;
    for (size_t i = 0; i < uses.size();) {
        int sum = 0;
        const size_t first = i;
        for (; i < uses.size() && uses[i].first == uses[first].first; ++i)
            sum += uses[i].second;
        if (sum != 0)
            open.insert(uses[first].first);
    }
    return open;
}

/// The loops of a border: a sheet has one, each hole in it one more.
inline size_t loops_of(const std::set<std::pair<uint32_t, uint32_t>>& edges) {
    std::map<uint32_t, uint32_t> root;
    const auto find = [&](uint32_t of) {
        root.try_emplace(of, of);
        while (root[of] != of)
            of = root[of] = root[root[of]];
        return of;
    };
    for (const auto& [a, b] : edges)
        root[find(a)] = find(b);
    size_t loops = 0;
    for (const auto& [vertex, above] : root)
        loops += vertex == above;
    return loops;
}

}  // namespace lodestone
