// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse/collapse_mesh.h"

#include "base/maths.h"
#include "base/parallel.h"
#include "geometry/morton_order.h"
#include "simplify/collapse/adjacency.h"
#include "simplify/collapse/corner_wedges.h"
#include "simplify/collapse/split_touching.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lodestone::simplify {
namespace {

/// Finds the output vertex of (vertex, attributes), or makes it.
class OutputVertices {
public:
    OutputVertices(Mesh& out, size_t vertices, std::vector<uint32_t>* made)
        : out_(out), heads_(vertices, kNone), made_(made) {}

    uint32_t at(uint32_t vertex, const glm::vec3& position, const glm::vec3* normal,
                const glm::vec2* uv, const glm::vec4* color) {
        // Taste: more find equal attributes in any order, in time that grows with the square.
        constexpr int kMostCompared = 64;
        int compared = 0;
        for (uint32_t i = heads_[vertex]; i != kNone && compared < kMostCompared;
             i = next_[i], ++compared) {
            if ((normal == nullptr || out_.normals[i] == *normal) &&
                (uv == nullptr || out_.uvs[i] == *uv) &&
                (color == nullptr || out_.colors[i] == *color))
                return i;
        }
        const auto fresh = static_cast<uint32_t>(out_.positions.size());
        out_.positions.push_back(position);
        if (normal != nullptr)
            out_.normals.push_back(*normal);
        if (uv != nullptr)
            out_.uvs.push_back(*uv);
        if (color != nullptr)
            out_.colors.push_back(*color);
        if (made_ != nullptr)
            made_->push_back(vertex);
        next_.push_back(heads_[vertex]);
        heads_[vertex] = fresh;
        return fresh;
    }

private:
    Mesh& out_;
    std::vector<uint32_t> heads_;
    std::vector<uint32_t> next_;
    std::vector<uint32_t>* made_;
};

/// The positions relative to the middle of their box, so that a mesh far from the origin loses no
/// digits.
std::vector<glm::dvec3> scaled(const std::vector<glm::vec3>& positions, double scale,
                               const std::vector<uint32_t>& order) {
    Box3 box;
    for (const glm::vec3& position : positions)
        box.add(glm::dvec3(position));
    const glm::dvec3 center = box.center();
    std::vector<glm::dvec3> points;
    points.reserve(order.size());
    for (const uint32_t v : order)
        points.push_back((glm::dvec3(positions[v]) - center) / scale);
    return points;
}

bool all_differ(const Triangle& t) {
    return t.x != t.y && t.y != t.z && t.z != t.x;
}

/// Takes the input's triangles of finite vertices in different places, sorted by the first of their
/// vertices on the curve, so that data that lie together are read together. `place`: the place of a
/// vertex on the curve, kNone for none.
void take_triangles(CollapseMesh& mesh, const Mesh& source, const std::vector<uint32_t>& place,
                    std::span<const uint16_t> chunks) {
    const auto corners_of = [&](const Triangle& t) {
        return Triangle(place[t.x], place[t.y], place[t.z]);
    };
    const auto first_of = [](const Triangle& t) { return std::min({t.x, t.y, t.z}); };
    const auto taken = [](const Triangle& t) {
        return t.x != kNone && t.y != kNone && t.z != kNone && all_differ(t);
    };
    std::vector<uint32_t> starts(mesh.points.size() + 1, 0);
    for (const Triangle& t : source.triangles) {
        const Triangle corners = corners_of(t);
        if (taken(corners))
            ++starts[first_of(corners) + 1];
    }
    for (size_t v = 0; v < mesh.points.size(); ++v)
        starts[v + 1] += starts[v];
    const size_t count = starts.back();
    const bool carried = mesh.has_normals || !source.uvs.empty() || !source.colors.empty();
    mesh.triangles.resize(count);
    if (carried)
        mesh.wedges.resize(count);
    if (!source.slots.empty())
        mesh.slots.resize(count);
    if (!chunks.empty())
        mesh.chunks.resize(count);
    for (size_t i = 0; i < source.triangles.size(); ++i) {
        const Triangle& t = source.triangles[i];
        const Triangle corners = corners_of(t);
        if (!taken(corners))
            continue;
        const uint32_t at = starts[first_of(corners)]++;
        mesh.triangles[at] = corners;
        if (carried)
            mesh.wedges[at] = t;
        if (!source.slots.empty())
            mesh.slots[at] = source.slots[i];
        if (!chunks.empty())
            mesh.chunks[at] = chunks[i];
    }
    mesh.live = count;
}

/// Numbers the vertices: the input's vertices keep their numbers as ids, copies get the next ones.
/// All input vertices at one position become the first one (by `first`).
void number(CollapseMesh& mesh, const std::vector<uint32_t>& order, std::vector<uint32_t> first) {
    const auto inputs = static_cast<std::ptrdiff_t>(first.size());
    const auto welded = static_cast<std::ptrdiff_t>(order.size());
    const auto next = static_cast<uint32_t>(inputs);
    mesh.ids = order;
    mesh.ids.resize(mesh.points.size());
    std::iota(mesh.ids.begin() + welded, mesh.ids.end(), next);
    mesh.merged = std::move(first);
    for (size_t copy = order.size(); copy < mesh.points.size(); ++copy) {
        mesh.shared.push_back(mesh.ids[copy]);
        mesh.shared.push_back(mesh.merged[mesh.sources[copy]]);
    }
    std::sort(mesh.shared.begin(), mesh.shared.end());
    mesh.shared.erase(std::unique(mesh.shared.begin(), mesh.shared.end()), mesh.shared.end());
    std::vector<uint32_t> sources = mesh.merged;
    sources.insert(sources.end(), mesh.sources.begin() + welded, mesh.sources.end());
    mesh.merged.resize(sources.size());
    std::iota(mesh.merged.begin() + inputs, mesh.merged.end(), next);
    mesh.sources = std::move(sources);
}

}  // namespace

CollapseMesh open_collapse_mesh(const Mesh& source, const Job& job, OtherPositions others,
                                Adjacency* adjacency, std::span<const uint16_t> chunks) {
    CollapseMesh mesh;
    mesh.has_normals = !source.normals.empty();
    Box3 box;
    for (const Triangle& t : source.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            if (finite(source.positions[t[corner]]))
                box.add(glm::dvec3(source.positions[t[corner]]));
        }
    }
    if (box.empty())
        return mesh;
    mesh.center = box.center();
    const glm::dvec3 half = 0.5 * box.size();
    const double reach = std::max({half.x, half.y, half.z});
    // A power of two: points that never move come back with the bits they had.
    mesh.scale = reach > 0 ? std::exp2(std::ceil(std::log2(reach))) : 1;
    std::vector<uint32_t> order;
    std::vector<uint32_t> first;
    {
        order = geometry::morton_order(source.positions, first);
        std::vector<uint32_t> place(first.size(), kNone);
        for (uint32_t i = 0; i < order.size(); ++i)
            place[order[i]] = i;
        for (uint32_t v = 0; v < place.size(); ++v)
            place[v] = place[first[v]];
        job.check();
        mesh.points.reserve(order.size());
        for (const uint32_t v : order)
            mesh.points.push_back((glm::dvec3(source.positions[v]) - mesh.center) / mesh.scale);
        for (const std::vector<glm::vec3>& positions : others)
            mesh.others.push_back({scaled(positions, mesh.scale, order), {}});
        take_triangles(mesh, source, place, chunks);
        mesh.sources = order;
    }
    job.check();
    split_layers(mesh);
    job.check();
    Adjacency lists;
    split_fans(mesh, lists);
    job.check();
    find_parts(mesh);
    mesh.facets.resize(mesh.triangles.size());
    // Triangles that one thread computes at a time.
    // Taste: larger chunks share the work less evenly.
    constexpr size_t kChunk = 16384;
    parallel_for((mesh.triangles.size() + kChunk - 1) / kChunk, [&](size_t chunk) {
        const size_t end = std::min(mesh.triangles.size(), (chunk + 1) * kChunk);
        for (size_t i = chunk * kChunk; i < end; ++i)
            mesh.facets[i] = glm::vec3(mesh.facet_of(mesh.triangles[i]));
    });
    for (OtherPose& other : mesh.others) {
        other.facets.reserve(mesh.triangles.size());
        for (const Triangle& t : mesh.triangles)
            other.facets.emplace_back(CollapseMesh::facet_of(other.points, t));
    }
    number(mesh, order, std::move(first));
    mesh.flat_normals = mesh.has_normals && shows_faces(mesh, source);
    make_wedges(mesh, source);
    job.check();
    const std::vector<uint32_t>& starts = lists.first;
    if (std::adjacent_find(starts.begin(), starts.end()) != starts.end())
        compact(mesh, &lists);
    if (adjacency != nullptr)
        *adjacency = std::move(lists);
    return mesh;
}

void compact(CollapseMesh& mesh, Adjacency* adjacency) {
    std::vector<uint32_t> moved(mesh.points.size(), 0);  // at first, how many triangles use it
    size_t kept = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (mesh.dead(i))
            continue;
        for (int corner = 0; corner < 3; ++corner)
            ++moved[mesh.triangles[i][corner]];
        mesh.triangles[kept] = mesh.triangles[i];
        mesh.facets[kept] = mesh.facets[i];
        for (OtherPose& other : mesh.others)
            other.facets[kept] = other.facets[i];
        if (!mesh.wedges.empty())
            mesh.wedges[kept] = mesh.wedges[i];
        if (!mesh.slots.empty())
            mesh.slots[kept] = mesh.slots[i];
        if (!mesh.chunks.empty())
            mesh.chunks[kept] = mesh.chunks[i];
        ++kept;
    }
    mesh.triangles.resize(kept);
    mesh.facets.resize(kept);
    for (OtherPose& other : mesh.others)
        other.facets.resize(kept);
    if (!mesh.wedges.empty())
        mesh.wedges.resize(kept);
    if (!mesh.slots.empty())
        mesh.slots.resize(kept);
    if (!mesh.chunks.empty())
        mesh.chunks.resize(kept);
    mesh.live = kept;
    uint32_t count = 0;
    uint32_t uses = 0;
    if (adjacency != nullptr)
        adjacency->first.assign(mesh.points.size() + 1, 0);
    for (size_t v = 0; v < moved.size(); ++v) {
        if (moved[v] == 0)
            continue;
        // The starts are shifted by one, as in Adjacency::build().
        if (adjacency != nullptr)
            adjacency->first[count + 1] = uses;
        uses += moved[v];
        mesh.points[count] = mesh.points[v];
        for (OtherPose& other : mesh.others)
            other.points[count] = other.points[v];
        mesh.ids[count] = mesh.ids[v];
        mesh.parts[count] = mesh.parts[v];
        moved[v] = count++;
    }
    mesh.points.resize(count);
    for (OtherPose& other : mesh.others)
        other.points.resize(count);
    mesh.ids.resize(count);
    mesh.parts.resize(count);
    for (Triangle& t : mesh.triangles)
        t = Triangle(moved[t.x], moved[t.y], moved[t.z]);
    if (adjacency == nullptr)
        return;
    adjacency->first.resize(count + 1);
    adjacency->triangles.resize(uses);
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner)
            adjacency->triangles[adjacency->first[mesh.triangles[i][corner] + 1]++] = i;
    }
}

void shrink(CollapseMesh& mesh) {
    mesh.points.shrink_to_fit();
    mesh.parts.shrink_to_fit();
    mesh.ids.shrink_to_fit();
    mesh.triangles.shrink_to_fit();
    mesh.facets.shrink_to_fit();
    mesh.wedges.shrink_to_fit();
    mesh.slots.shrink_to_fit();
    mesh.chunks.shrink_to_fit();
    for (OtherPose& other : mesh.others) {
        other.points.shrink_to_fit();
        other.facets.shrink_to_fit();
    }
}

Mesh extract(const CollapseMesh& mesh, std::vector<uint32_t>* made,
             std::span<const glm::vec3> corner_normals) {
    constexpr double kMost = std::numeric_limits<float>::max();
    Mesh out;
    out.triangles.reserve(mesh.live);
    OutputVertices vertices(out, mesh.points.size(), made);
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (mesh.dead(i))
            continue;
        const glm::dvec3 facet(mesh.facets[i]);
        const double length = glm::length(facet);
        const glm::vec3 face(length > 0 ? facet / length : glm::dvec3(0, 0, 1));
        Triangle t;
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = mesh.triangles[i][corner];
            const uint32_t wedge = mesh.wedges.empty() ? kNone : mesh.wedges[i][corner];
            const glm::vec3* normal = nullptr;
            if (mesh.flat_normals)
                normal = &face;
            else if (mesh.has_normals)
                normal = &mesh.normals[wedge];
            const size_t at = 3 * i + static_cast<size_t>(corner);
            if (!corner_normals.empty() && corner_normals[at] != glm::vec3(0.0f))
                normal = &corner_normals[at];
            // A vertex may end just outside the input's box, which may be as large as floats can
            // be.
            const glm::dvec3 place =
                glm::clamp(mesh.center + mesh.points[vertex] * mesh.scale, -kMost, kMost);
            t[corner] = vertices.at(vertex, glm::vec3(place), normal,
                                    mesh.uvs.empty() ? nullptr : &mesh.uvs[wedge],
                                    mesh.colors.empty() ? nullptr : &mesh.colors[wedge]);
        }
        out.triangles.push_back(t);
        if (!mesh.slots.empty())
            out.slots.push_back(mesh.slots[i]);
    }
    return out;
}

}  // namespace lodestone::simplify
