// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/cluster/vertex_clustering.h"

#include "base/maths.h"
#include "simplify/cluster/cell_groups.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lodestone::simplify {
namespace {

// The cells of the fine grid for each one that the tree leaves: enough to choose from.
// Fitted: by tests/bench/peers/bench_simplify.py, 36 pairs: 0.6 of simplifySloppy's error.
constexpr double kCellsPerLeft = 1.3;
// The bytes of scratch memory that are reserved, for each vertex and each cell.
// Law: the sum of the arrays by vertex.
constexpr size_t kVertexBytes = 40;
// Law: the sum of the arrays by cell.
constexpr size_t kCellBytes = 320;

/// The triangles with finite corners.
Mesh finite_part(const Mesh& mesh) {
    std::vector<uint8_t> keep(mesh.triangles.size());
    for (size_t i = 0; i < keep.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        keep[i] = finite(mesh.positions[t.x]) && finite(mesh.positions[t.y]) &&
                  finite(mesh.positions[t.z]);
    }
    return subset(mesh, keep);
}

/// The `count` largest triangles; of equally large ones the first.
Mesh largest(const Mesh& mesh, size_t count) {
    std::vector<double> areas(mesh.triangles.size());
    for (size_t i = 0; i < areas.size(); ++i)
        areas[i] = glm::length(area_vector(mesh, i));
    std::vector<uint32_t> order(areas.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto larger = [&](uint32_t a, uint32_t b) {
        return areas[a] != areas[b] ? areas[a] > areas[b] : a < b;
    };
    std::vector<uint8_t> keep(areas.size(), 0);
    count = std::min(count, order.size());
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                     larger);
    for (size_t i = 0; i < count; ++i)
        keep[order[i]] = 1;
    return subset(mesh, keep);
}

/// The parts of the surface in each group that are connected within it: their vertices share
/// normals and texture coordinates.
ScratchVector<uint32_t> patches_of(const Mesh& mesh, const GridCells& cells,
                                   const CellGroups& grouping) {
    ScratchVector<uint32_t> patch(mesh.positions.size());
    std::iota(patch.begin(), patch.end(), 0u);
    const auto root = [&](uint32_t v) {
        while (patch[v] != v) {
            patch[v] = patch[patch[v]];
            v = patch[v];
        }
        return v;
    };
    for (const Triangle& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            const uint32_t a = t[i];
            const uint32_t b = t[(i + 1) % 3];
            if (grouping.group[cells.cell[a]] != grouping.group[cells.cell[b]])
                continue;
            const uint32_t one = root(a);
            const uint32_t other = root(b);
            patch[std::max(one, other)] = std::min(one, other);
        }
    }
    for (uint32_t v = 0; v < patch.size(); ++v)
        patch[v] = root(v);
    return patch;
}

/// The cells of one group.
class CellBlock {
public:
    explicit CellBlock(const CellQuadric& quadric)
        : quadric_(quadric), low_(quadric.at), high_(quadric.at) {}
    void add(const CellBlock& other) {
        quadric_.add(other.quadric_);
        low_ = least_of(low_, other.low_);
        high_ = most_of(high_, other.high_);
    }
    /// The position of its vertex, in metres.
    glm::vec3 point(const GridCells& cells) const {
        // Planes that hardly differ meet anywhere: the vertex must stay near the surface.
        const glm::vec3 low = first_three(low_);
        const glm::vec3 high = first_three(high_);
        const glm::vec3 size = high - low;
        const glm::vec3 room(0.25f * std::max({size.x, size.y, size.z}) + cells.step);
        return cells.metres(glm::clamp(quadric_.lowest(), low - room, high + room));
    }

private:
    CellQuadric quadric_;
    Four low_, high_;  // the box of the cells' origins, in the frame
};

/// One vertex for each group that a triangle uses.
struct ClusterVertices {
    ScratchVector<uint32_t> of;       // the place of a group; kNoCell where no triangle uses it
    ScratchVector<glm::vec3> points;  // in metres
};

ClusterVertices places_of(const GridCells& cells, const CellGroups& grouping, size_t nodes) {
    // The mark of a group that is used and has no place yet.
    // Law: any number but kNoCell that is above all places.
    constexpr uint32_t kUsed = kNoCell - 1;
    ClusterVertices places;
    places.of.assign(nodes, kNoCell);
    for (const Triangle& t : grouping.triangles)
        places.of[t.x] = places.of[t.y] = places.of[t.z] = kUsed;
    ScratchVector<CellBlock> shared;  // those of groups whose cells do not all follow each other
    places.points.reserve(std::min(cells.count(), 3 * grouping.triangles.size()));
    for (size_t i = 0; i < cells.count();) {
        const uint32_t group = grouping.group[i];
        uint32_t& place = places.of[group];
        if (place == kNoCell) {
            ++i;
            continue;
        }
        CellBlock block(cells.quadrics[i]);
        for (++i; i < cells.count() && grouping.group[i] == group; ++i)
            block.add(CellBlock(cells.quadrics[i]));
        if (!grouping.scattered) {
            place = static_cast<uint32_t>(places.points.size());
            places.points.push_back(block.point(cells));
        } else if (place == kUsed) {
            place = static_cast<uint32_t>(shared.size());
            shared.push_back(block);
        } else {
            shared[place].add(block);
        }
    }
    for (const CellBlock& block : shared)
        places.points.push_back(block.point(cells));
    return places;
}

bool without_area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::cross(b - a, c - a) == glm::dvec3(0);
}

/// The mesh in which every place is a vertex.
Mesh plain(const Mesh& mesh, const CellGroups& grouping, const ClusterVertices& places) {
    Mesh out;
    out.positions.assign(places.points.begin(), places.points.end());
    out.triangles.reserve(grouping.triangles.size());
    std::vector<uint8_t> keep(grouping.triangles.size(), 1);
    size_t kept = 0;
    for (size_t i = 0; i < keep.size(); ++i) {
        const Triangle& of = grouping.triangles[i];
        const Triangle t(places.of[of.x], places.of[of.y], places.of[of.z]);
        keep[i] = !without_area(out.positions[t.x], out.positions[t.y], out.positions[t.z]);
        kept += keep[i];
        out.triangles.push_back(t);
        if (!mesh.slots.empty())
            out.slots.push_back(mesh.slots[grouping.sources[i]]);
    }
    if (kept < keep.size())
        out = subset(out, keep);
    return out;
}

/// The vertices of the result, made from the surface around them.
class ClusterAssembler {
public:
    ClusterAssembler(const Mesh& mesh, const GridCells& cells, const CellGroups& grouping,
                     const ClusterVertices& places)
        : mesh_(mesh) {
        const ScratchVector<uint32_t> patch = patches_of(mesh, cells, grouping);
        ScratchVector<uint32_t> vertex_of(patch.size(), kNoCell);
        out_.triangles.reserve(grouping.triangles.size());
        for (size_t i = 0; i < grouping.triangles.size(); ++i) {
            const Triangle& groups = grouping.triangles[i];
            const Triangle& source = mesh.triangles[grouping.sources[i]];
            if (without_area(places.points[places.of[groups.x]], places.points[places.of[groups.y]],
                             places.points[places.of[groups.z]]))
                continue;  // it draws nothing
            Triangle t;
            for (int k = 0; k < 3; ++k) {
                const uint32_t place = places.of[groups[k]];
                uint32_t& vertex = vertex_of[patch[source[k]]];
                if (vertex == kNoCell) {
                    vertex = static_cast<uint32_t>(out_.positions.size());
                    out_.positions.push_back(places.points[place]);
                }
                t[k] = vertex;
            }
            out_.triangles.push_back(t);
            if (!mesh.slots.empty())
                out_.slots.push_back(mesh.slots[grouping.sources[i]]);
        }
        take_attributes(patch, vertex_of);
        if (!mesh.normals.empty())
            mend_normals();
    }

    Mesh result() { return std::move(out_); }

private:
    /// Normals and colors are the mean of the patch. Texture coordinates are those of its vertex
    /// nearest to the new one, because their mean would lie outside of a bent island.
    void take_attributes(const ScratchVector<uint32_t>& patch,
                         const ScratchVector<uint32_t>& vertex_of) {
        const size_t count = out_.positions.size();
        ScratchVector<uint32_t> members(count, 0);
        ScratchVector<float> nearest(count, std::numeric_limits<float>::infinity());
        if (!mesh_.normals.empty())
            out_.normals.assign(count, glm::vec3(0));
        if (!mesh_.uvs.empty())
            out_.uvs.assign(count, glm::vec2(0));
        if (!mesh_.colors.empty())
            out_.colors.assign(count, glm::vec4(0));
        for (size_t v = 0; v < patch.size(); ++v) {
            const uint32_t to = vertex_of[patch[v]];
            if (to == kNoCell)
                continue;
            ++members[to];
            if (!mesh_.normals.empty())
                out_.normals[to] += mesh_.normals[v];
            if (!mesh_.colors.empty())
                out_.colors[to] += mesh_.colors[v];
            if (mesh_.uvs.empty())
                continue;
            const glm::vec3 away = mesh_.positions[v] - out_.positions[to];
            const float square = glm::dot(away, away);
            if (square < nearest[to] || members[to] == 1) {
                nearest[to] = square;
                out_.uvs[to] = mesh_.uvs[v];
            }
        }
        for (size_t i = 0; i < out_.colors.size(); ++i)
            out_.colors[i] /= static_cast<float>(members[i]);
        for (glm::vec3& normal : out_.normals) {
            const float length = glm::length(normal);
            normal = length > 1e-6f ? normal / length : glm::vec3(0);
        }
    }

    /// Where a normal points away from its triangle, or has no direction, the triangle's own is
    /// used.
    void mend_normals() {
        for (size_t i = 0; i < out_.triangles.size(); ++i) {
            const glm::dvec3 area = area_vector(out_, i);
            const double length = glm::length(area);
            const glm::vec3 face(length > 0 ? area / length : glm::dvec3(0, 0, 1));
            for (int k = 0; k < 3; ++k) {
                uint32_t& vertex = out_.triangles[i][k];
                const glm::vec3 normal = out_.normals[vertex];
                const bool lost = glm::dot(normal, normal) < 0.5f;
                if (!lost && glm::dot(normal, face) > 0.1f)
                    continue;
                const uint32_t from = vertex;
                vertex = static_cast<uint32_t>(out_.positions.size());
                const glm::vec3 point = out_.positions[from];
                out_.positions.push_back(point);
                out_.normals.push_back(face);
                if (!out_.uvs.empty())
                    out_.uvs.push_back(glm::vec2(out_.uvs[from]));
                if (!out_.colors.empty())
                    out_.colors.push_back(glm::vec4(out_.colors[from]));
            }
        }
    }

    const Mesh& mesh_;
    Mesh out_;
};

}  // namespace

Mesh cluster_vertices(const Mesh& mesh, size_t target, const Job& job) {
    check(mesh);
    if (target == 0)
        fail(Status::InvalidArgument, "the target is 0 triangles");
    if (mesh.triangles.size() <= target)
        return mesh;
    const PointExtent extent = extent_of(mesh.positions);
    if (!extent.finite)
        return cluster_vertices(finite_part(mesh), target, job);
    const GroupingPlan plan(mesh.triangles.size(), target);
    const size_t least =
        16 + static_cast<size_t>(kCellsPerLeft * plan.begin * 0.5 * static_cast<double>(target));
    ScratchArena scratch(kVertexBytes * mesh.positions.size() + kCellBytes * least);
    const GridCells cells = divide_into_cells(mesh, extent, least, job);
    CellGroups grouping;
    if (cells.count() > 0)
        grouping = group_cells(cells, plan, target, job);
    job.progress(0.8);
    if (grouping.triangles.empty())  // it has no extent, or consists of specks
        return largest(mesh, target);
    const ClusterVertices places = places_of(cells, grouping, 2 * cells.count());
    const bool attributes = !mesh.normals.empty() || !mesh.uvs.empty() || !mesh.colors.empty();
    Mesh out = attributes ? ClusterAssembler(mesh, cells, grouping, places).result()
                          : plain(mesh, grouping, places);
    if (out.empty())
        out = largest(mesh, target);
    if (out.triangles.size() > target)
        out = largest(out, target);
    job.progress(1);
    return out;
}

}  // namespace lodestone::simplify
