// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/cells.h"

#include "approximate/cell_numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace lodestone::approximate {
namespace {

// A vertex may move along its surface, but not for nothing: this share of its planes' weight holds
// it in all directions. Less follows creases better, more keeps flat faces' cells regular.
constexpr float kHold = 1e-4f;
// Open borders and those between material slots are held this much of the planes' weight.
constexpr float kBorder = 0.3f;
// A cell without area has at least some weight (in a frame of unit extent).
constexpr float kLeastWeight = 1e-20f;
constexpr Four kNothing{0, 0, 0, 0};

/// Neighboring slots count differently in `open`, so that their border does not close.
float side_of(uint16_t slot) {
    return 1 + 0.37f * static_cast<float>(slot % 7u);
}

/// What lies around each vertex; the cells' triangles between three of them.
void add_triangles(Cells& cells, const Mesh& mesh, ScratchVector<CellVertex>& vertices,
                   const Job& job) {
    constexpr size_t kAhead = 12;  // triangles whose vertices are asked for
    // As many as a surface has, or more: what is left over would be a page of memory.
    size_t room = std::min(mesh.triangles.size(), 4 * cells.split.size() + 64);
    cells.triangles.resize(room);
    cells.sources.resize(room);
    size_t kept = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if ((i & 0xffffu) == 0)
            job.check();
        if (i + kAhead < mesh.triangles.size()) {
            const Triangle& coming = mesh.triangles[i + kAhead];
            for (const uint32_t v : {coming.x, coming.y, coming.z})
                __builtin_prefetch(&vertices[v], 1);
        }
        const Triangle& t = mesh.triangles[i];
        const Triangle of(cells.cell[t.x], cells.cell[t.y], cells.cell[t.z]);
        if (kept == room) {
            room = std::min(mesh.triangles.size(), 2 * room);
            cells.triangles.resize(room);
            cells.sources.resize(room);
        }
        // Without a branch: nobody can predict it.
        cells.triangles[kept] = of;
        cells.sources[kept] = static_cast<uint32_t>(i);
        kept += (of.x != of.y) & (of.y != of.z) & (of.z != of.x);
        const Four a = vertices[t.x].point;
        const Four b = vertices[t.y].point;
        const Four c = vertices[t.z].point;
        const Four n = cross(b - a, c - a);
        const float square = dot_three(n, n);
        if (!(square > 0))
            continue;
        const float factor = 1 / std::sqrt(square);
        const float side = mesh.slots.empty() ? 1.0f : side_of(mesh.slots[i]);
        const Four scaled = n * factor;
        const Four planes_a = Four{scaled[0], scaled[0], scaled[0], scaled[1]} *
                              __builtin_shufflevector(n, n, 0, 1, 2, 1);
        const Four planes_b = Four{scaled[1], scaled[2], 0, 0} * n[2];
        const auto add = [&](uint32_t v, const Four& across) {
            CellVertex& vertex = vertices[v];
            vertex.planes_a += planes_a;
            vertex.planes_b += planes_b;
            vertex.open += across * side;
        };
        add(t.x, c - b);
        add(t.y, a - c);
        add(t.z, b - a);
    }
    cells.triangles.resize(kept);
    cells.sources.resize(kept);
}

/// Of vertices at one position (split ones) the first is given what the others have.
void join_open(ScratchVector<CellVertex>& vertices, const ScratchVector<uint32_t>& open) {
    size_t size = 64;
    while (size < 2 * open.size())
        size *= 2;
    ScratchVector<uint32_t> table(size, kNoCell);
    for (const uint32_t v : open) {
        const Four point = vertices[v].point;
        std::array<uint32_t, 4> bits{};
        std::memcpy(bits.data(), &point, sizeof(point));
        uint32_t key = bits[0] * 0x9e3779b1u ^ bits[1] * 0x85ebca6bu ^ bits[2] * 0xc2b2ae35u;
        key ^= key >> 15u;
        for (size_t at = key & (size - 1);; at = (at + 1) & (size - 1)) {
            if (table[at] == kNoCell) {
                table[at] = v;
                break;
            }
            CellVertex& first = vertices[table[at]];
            if (first_three(first.point) == first_three(point)) {
                first.planes_a += vertices[v].planes_a;
                first.planes_b += vertices[v].planes_b;
                first.open += vertices[v].open;
                vertices[v].planes_a = vertices[v].planes_b = vertices[v].open = kNothing;
                break;
            }
        }
    }
}

/// The planes around vertices; where these are a little, too, and borders the lines along them.
void add_vertices(Cells& cells, ScratchVector<CellVertex>& vertices) {
    constexpr float kUnset = -1;
    // By itself: what is read must not wait for the last sum.
    ScratchVector<Four> origins(cells.split.size(), Four{kUnset, 0, 0, 0});
    const CellQuadric nothing{
        {kLeastWeight, 0, 0, 0}, {0, kLeastWeight, 0, 0}, {0, 0, kLeastWeight, 0}, {0, 0, 0, 0}};
    cells.quadrics.assign(cells.split.size(), nothing);
    ScratchVector<uint32_t> open;
    open.reserve(vertices.size());
    const auto add = [&](uint32_t v, const CellVertex& vertex, float all, const Four& along) {
        const uint32_t cell = cells.cell[v];
        Four& origin = origins[cell];
        if (origin[0] == kUnset)
            origin = cells.quadrics[cell].at = vertex.point;
        const Four& o = vertex.open;
        const Four across{along[0] * o[0] - all, along[0] * o[1], along[0] * o[2],
                          along[1] * o[1] - all};
        cells.quadrics[cell].add_planes(
            vertex.planes_a - across, vertex.planes_b[0] - along[1] * o[2],
            vertex.planes_b[1] - along[2] * o[2] + all, vertex.point - origin);
    };
    for (uint32_t v = 0; v < vertices.size(); ++v) {
        const CellVertex& vertex = vertices[v];
        if (vertex.is_open())
            open.push_back(v);
        else
            add(v, vertex, kHold * vertex.weight(), kNothing);
    }
    join_open(vertices, open);
    for (const uint32_t v : open) {
        const CellVertex& vertex = vertices[v];
        const float weight = vertex.weight();
        if (!vertex.is_open()) {
            add(v, vertex, kHold * weight, kNothing);
            continue;
        }
        // The line along the border: everything but what lies in its direction.
        const float border = kBorder * weight;
        add(v, vertex, kHold * weight + border,
            vertex.open * (border / dot_three(vertex.open, vertex.open)));
    }
}

}  // namespace

Cells divide(const Mesh& mesh, size_t least, const Job& job) {
    Cells cells;
    if (mesh.triangles.empty())
        return cells;
    glm::vec3 low = mesh.positions[0];
    glm::vec3 high = low;
    for (const glm::vec3& p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    cells.low = glm::dvec3(low);
    const glm::dvec3 size = glm::dvec3(high) - cells.low;
    cells.unit = std::max({size.x, size.y, size.z});
    const double scale = 1 / cells.unit;
    if (!(scale < 0.25 * std::numeric_limits<float>::max())) {
        cells.unit = 0;
        return cells;
    }
    ScratchVector<CellVertex> vertices(mesh.positions.size());
    // Halves, as their differences are floats in any case.
    const Four from = four(low) * 0.5f;
    const auto twice = static_cast<float>(2 * scale);
    for (size_t i = 0; i < vertices.size(); ++i) {
        const Four point = (four(mesh.positions[i]) * 0.5f - from) * twice;
        vertices[i] = CellVertex{point, kNothing, kNothing, kNothing};
    }
    job.check();
    number_cells(cells, vertices, least);
    job.check();
    add_triangles(cells, mesh, vertices, job);
    add_vertices(cells, vertices);
    return cells;
}

}  // namespace lodestone::approximate
