// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/cluster/cell_grid.h"

#include "simplify/cluster/cell_numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace lodestone::simplify {
namespace {

// The share of its planes' weight that holds a vertex in all directions: it may move along its
// surface, but not for nothing.
// Taste: less follows creases better, more keeps the cells of flat faces regular.
constexpr float kHold = 1e-4f;
// The share of the planes' weight that holds open borders and those between material slots.
// Taste: more keeps borders in place, less lets them shrink.
constexpr float kBorder = 0.3f;
// The least weight of a cell, if it has no area (in a frame of unit extent).
// Law: single precision; smaller weights would underflow when they are multiplied.
constexpr float kLeastWeight = 1e-20f;
// Law: the sum of no planes.
constexpr Four kNothing{0, 0, 0, 0};

/// Neighboring slots count differently in `open`, so that their border does not close.
float side_of(uint16_t slot) {
    return 1 + 0.37f * static_cast<float>(slot % 7u);
}

/// A vertex, with sums over the triangles around it: half a line of the processor's cache.
struct alignas(32) CellVertex {
    glm::vec3 at;   // in the frame
    uint32_t cell;  // the cell that the vertex lies in
    // The way from the first neighbor to the last: zero where the fan closes; the weight.
    Four open;

    Four point() const {
        using Bits = uint32_t __attribute__((vector_size(16)));
        Bits bits;
        std::memcpy(&bits, this, sizeof(bits));
        return (Four)(bits & Bits{~0u, ~0u, ~0u, 0});
    }
    /// The weight of its planes: twice the area around it.
    float weight() const { return open[3]; }
    bool is_open() const { return dot_three(open, open) > 1e-4f * weight(); }
};

/// The vertices of the cells. The origin of a cell's quadric is at the cell's first vertex.
ScratchVector<CellVertex> vertices_of(GridCells& cells, const Mesh& mesh, const CellFrame& frame) {
    // Law: the last number of an origin is 0, so no number but this can mark an unset one.
    constexpr float kUnset = -1;
    cells.quadrics.assign(cells.split.size(),
                          CellQuadric{kNothing, kNothing, kNothing, {kUnset, 0, 0, 0}});
    ScratchVector<CellVertex> vertices(mesh.positions.size());
    for (size_t i = 0; i < vertices.size(); ++i) {
        const Four point = frame(mesh.positions[i]);
        const uint32_t cell = cells.cell[i];
        vertices[i] = {first_three(point), cell, kNothing};
        Four& origin = cells.quadrics[cell].at;
        if (origin[0] == kUnset)
            origin = point;
    }
    return vertices;
}

/// Adds the planes of all triangles to the cells of their corners, sums up the surroundings of each
/// vertex, and lists the triangles between three cells.
void add_triangles(GridCells& cells, const Mesh& mesh, ScratchVector<CellVertex>& vertices,
                   const Job& job) {
    // The triangles ahead whose vertices memory is asked for.
    // Taste: more displace what is still needed, fewer come too late.
    constexpr size_t kAhead = 12;
    // Triangles between two looks at whether the job was cancelled.
    // Taste: more of them look less often.
    constexpr size_t kBlock = 4096;
    // Plain pointers: writing through them does not make the compiler read the vectors again.
    CellVertex* const around = vertices.data();
    CellQuadric* const quadrics = cells.quadrics.data();
    const uint16_t* const slots = mesh.slots.empty() ? nullptr : mesh.slots.data();
    const std::span<const Triangle> triangles = mesh.triangles;
    size_t kept = 0;
    for (size_t begin = 0; begin < triangles.size(); begin += kBlock) {
        job.check();
        const size_t end = std::min(triangles.size(), begin + kBlock);
        if (cells.triangles.size() < kept + kBlock) {
            // Room for the triangles of a surface, or more: unused room would cost pages of memory.
            const size_t room = std::max(4 * cells.split.size(), 2 * kept) + kBlock;
            cells.triangles.resize(std::min(triangles.size() + kBlock, room));
            cells.sources.resize(cells.triangles.size());
        }
        Triangle* const into = cells.triangles.data();
        uint32_t* const sources = cells.sources.data();
        for (size_t i = begin; i < end; ++i) {
            const Triangle& coming = triangles[std::min(i + kAhead, triangles.size() - 1)];
            __builtin_prefetch(around + coming.x, 1);
            __builtin_prefetch(around + coming.y, 1);
            __builtin_prefetch(around + coming.z, 1);
            CellVertex& first = around[triangles[i].x];
            CellVertex& second = around[triangles[i].y];
            CellVertex& third = around[triangles[i].z];
            const uint32_t x = first.cell;
            const uint32_t y = second.cell;
            const uint32_t z = third.cell;
            // There is no branch, because nobody can predict it.
            into[kept].x = x;
            into[kept].y = y;
            into[kept].z = z;
            sources[kept] = static_cast<uint32_t>(i);
            kept += (x != y) & (y != z) & (z != x);
            const Four a = first.point();
            const Four b = second.point();
            const Four c = third.point();
            const Four n = cross(b - a, c - a);
            const float square = dot_three(n, n);
            if (!(square > 0))
                continue;
            const float weight = std::sqrt(square);
            const Four normal = n * (1 / std::sqrt(weight));
            const Four planes_a = __builtin_shufflevector(normal, normal, 0, 0, 0, 1) *
                                  __builtin_shufflevector(normal, normal, 0, 1, 2, 1);
            const Four planes_b = __builtin_shufflevector(normal, normal, 1, 2, 3, 3) * normal[2];
            CellQuadric& of = quadrics[x];
            if (x == y && y == z) {
                of.add_plane(normal * std::sqrt(3.0f), planes_a * 3, planes_b * 3, a - of.at);
            } else {
                CellQuadric& of_second = quadrics[y];
                CellQuadric& of_third = quadrics[z];
                of.add_plane(normal, planes_a, planes_b, a - of.at);
                of_second.add_plane(normal, planes_a, planes_b, b - of_second.at);
                of_third.add_plane(normal, planes_a, planes_b, c - of_third.at);
            }
            Four past_first = c - b;
            Four past_second = a - c;
            Four past_third = b - a;
            if (slots != nullptr) {
                const float side = side_of(slots[i]);
                past_first *= side;
                past_second *= side;
                past_third *= side;
            }
            const Four more = Four{0, 0, 0, 1} * weight;
            first.open += past_first + more;
            second.open += past_second + more;
            third.open += past_third + more;
        }
    }
    cells.triangles.resize(kept);
    cells.sources.resize(kept);
}

/// Gives the first of the vertices at one position (split ones) the sums of the others.
void join_open(ScratchVector<CellVertex>& vertices, const ScratchVector<uint32_t>& open) {
    size_t size = 64;
    while (size < 2 * open.size())
        size *= 2;
    ScratchVector<uint32_t> table(size, kNoCell);
    for (const uint32_t v : open) {
        const glm::vec3 point = vertices[v].at;
        std::array<uint32_t, 3> bits{};
        std::memcpy(bits.data(), &point, sizeof(point));
        uint32_t key = bits[0] * 0x9e3779b1u ^ bits[1] * 0x85ebca6bu ^ bits[2] * 0xc2b2ae35u;
        key ^= key >> 15u;
        for (size_t at = key & (size - 1);; at = (at + 1) & (size - 1)) {
            if (table[at] == kNoCell) {
                table[at] = v;
                break;
            }
            CellVertex& first = vertices[table[at]];
            if (first.at == point) {
                first.open += vertices[v].open;
                vertices[v].open = kNothing;
                break;
            }
        }
    }
}

/// Holds all vertices a little, and those on borders at the lines along them.
void add_vertices(GridCells& cells, ScratchVector<CellVertex>& vertices) {
    ScratchVector<uint32_t> open;
    open.reserve(vertices.size());
    for (CellQuadric& quadric : cells.quadrics) {
        // The planes of a cell weigh as much as its vertices.
        const float all = quadric.trace() * kHold + kLeastWeight;
        quadric.planes_a += Four{all, 0, 0, all};
        quadric.planes_b += Four{0, all, 0, 0};
    }
    for (uint32_t v = 0; v < vertices.size(); ++v) {
        const CellVertex& vertex = vertices[v];
        CellQuadric& quadric = cells.quadrics[vertex.cell];
        const Four away = vertex.point() - quadric.at;
        quadric.pull +=
            (away + Four{0, 0, 0, 1} * dot_three(away, away)) * (kHold * vertex.weight());
        if (vertex.is_open())
            open.push_back(v);
    }
    join_open(vertices, open);
    for (const uint32_t v : open) {
        const CellVertex& vertex = vertices[v];
        if (!vertex.is_open())
            continue;
        // The line along the border holds in all directions but its own.
        const float all = kBorder * vertex.weight();
        const Four o = vertex.open;
        const Four along = o * (all / dot_three(o, o));
        const Four planes_a{all - along[0] * o[0], -along[0] * o[1], -along[0] * o[2],
                            all - along[1] * o[1]};
        const Four planes_b{-along[1] * o[2], all - along[2] * o[2], 0, 0};
        CellQuadric& quadric = cells.quadrics[vertex.cell];
        quadric.add_planes(planes_a, planes_b, vertex.point() - quadric.at);
    }
}

}  // namespace

PointExtent extent_of(std::span<const glm::vec3> points) {
    if (points.empty())
        return {};
    Four low = four(points[0]);
    Four high = low;
    // Without a branch: only a number that is not finite gives anything but 0.
    Four sum = kNothing;
    for (const glm::vec3& p : points) {
        const Four point = four(p);
        low = least_of(point, low);
        high = most_of(point, high);
        sum += point - point;
    }
    return {first_three(low), first_three(high), first_three(sum) == glm::vec3(0.0f)};
}

GridCells divide_into_cells(const Mesh& mesh, const PointExtent& extent, size_t least,
                            const Job& job) {
    GridCells cells;
    if (mesh.triangles.empty())
        return cells;
    cells.low = glm::dvec3(extent.low);
    const glm::dvec3 size = glm::dvec3(extent.high) - cells.low;
    cells.unit = std::max({size.x, size.y, size.z});
    const double scale = 1 / cells.unit;
    if (!(scale < 0.25 * std::numeric_limits<float>::max())) {
        cells.unit = 0;
        return cells;
    }
    const CellFrame frame(extent.low, scale);
    job.check();
    number_cells(cells, mesh.positions, frame, least);
    job.check();
    ScratchVector<CellVertex> vertices = vertices_of(cells, mesh, frame);
    add_triangles(cells, mesh, vertices, job);
    add_vertices(cells, vertices);
    return cells;
}

}  // namespace lodestone::simplify
