// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse/corner_wedges.h"

#include "base/maths.h"
#include "geometry/closest_on_triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::simplify {
namespace {

/// The most wedges around an edge; if there are more, the normals are noise and the corners keep
/// what they have.
/// Taste: more take time that grows with the square.
constexpr size_t kMostWedges = 64;

/// Whether nobody sees the difference of two colors, whatever light falls on them.
bool alike(const glm::vec4& a, const glm::vec4& b) {
    // Law: a quarter of a step of an 8-bit picture.
    constexpr float kStep = 1.0f / 1024;
    return std::abs(a.x - b.x) <= kStep && std::abs(a.y - b.y) <= kStep &&
           std::abs(a.z - b.z) <= kStep && std::abs(a.w - b.w) <= kStep;
}

}  // namespace

bool shows_faces(const CollapseMesh& mesh, const Mesh& source) {
    size_t judged = 0;
    size_t faces = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::dvec3 facet(mesh.facets[i]);
        const double area = glm::length(facet);
        if (!(area > 0))
            continue;
        ++judged;
        double least = 1;
        for (int corner = 0; corner < 3; ++corner)
            least = std::min(
                least, glm::dot(facet, glm::dvec3(source.normals[mesh.wedges[i][corner]])) / area);
        faces += least > 0.99999;  // a quarter of a degree
    }
    if (judged == 0 || static_cast<double>(faces) < 0.98 * static_cast<double>(judged))
        return false;
    // A finely tessellated smooth surface comes this far, too, but its neighbors share normals:
    // compare the triangles around each vertex with the first of them.
    std::vector<uint32_t> first(mesh.points.size(), kNone);
    size_t split = 0;
    size_t shared = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            uint32_t& known = first[mesh.triangles[i][corner]];
            const uint32_t vertex = mesh.wedges[i][corner];
            if (known == kNone)
                known = vertex;
            else if (source.normals[known] == source.normals[vertex])
                ++shared;
            else
                ++split;
        }
    }
    return split > shared;
}

void make_wedges(CollapseMesh& mesh, const Mesh& source) {
    const bool normals = mesh.has_normals && !mesh.flat_normals;
    const bool uvs = !source.uvs.empty();
    const bool colors = !source.colors.empty();
    if (!normals && !uvs && !colors) {
        mesh.wedges = {};
        return;
    }
    // The most wedges of a vertex that a corner is compared with; a corner beyond gets a wedge of
    // its own.
    // Taste: more join more wedges; the limit bounds the time on any input.
    constexpr int kMostCompared = 32;
    std::vector<uint32_t> head(mesh.points.size(), kNone);
    std::vector<uint32_t> next;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = mesh.triangles[i][corner];
            const uint32_t origin = mesh.wedges[i][corner];
            glm::vec3 normal = normals ? source.normals[origin] : glm::vec3(0);
            glm::vec2 uv = uvs ? source.uvs[origin] : glm::vec2(0);
            if (!finite(glm::dvec3(normal)))
                normal = glm::vec3(0, 0, 1);
            if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
                uv = glm::vec2(0);
            glm::vec4 color = colors ? source.colors[origin] : glm::vec4(1);
            if (!std::isfinite(color.x + color.y + color.z + color.w))
                color = glm::vec4(1);
            uint32_t wedge = head[vertex];
            for (int n = 0; wedge != kNone; wedge = next[wedge], ++n) {
                if (n == kMostCompared) {
                    wedge = kNone;
                    break;
                }
                if ((!normals || glm::dot(mesh.normals[wedge], normal) > 0.99985f) &&
                    (!uvs || (std::abs(mesh.uvs[wedge].x - uv.x) <= 1e-5f &&
                              std::abs(mesh.uvs[wedge].y - uv.y) <= 1e-5f)) &&
                    (!colors || alike(mesh.colors[wedge], color)))
                    break;
            }
            if (wedge == kNone) {
                wedge = static_cast<uint32_t>(next.size());
                next.push_back(head[vertex]);
                head[vertex] = wedge;
                if (normals)
                    mesh.normals.push_back(normal);
                if (uvs)
                    mesh.uvs.push_back(uv);
                if (colors)
                    mesh.colors.push_back(color);
            }
            mesh.wedges[i][corner] = wedge;
        }
    }
}

uint32_t WedgeMerge::find_or_add(uint32_t wedge, bool at_a) {
    for (uint32_t i = 0; i < members_.size(); ++i) {
        if (members_[i].wedge == wedge)
            return i;
    }
    members_.push_back({wedge, static_cast<uint32_t>(members_.size()), at_a});
    return static_cast<uint32_t>(members_.size() - 1);
}

bool WedgeMerge::plan(const CollapseMesh& mesh, const Adjacency& adjacency, uint32_t a, uint32_t b,
                      const glm::dvec3& point, bool join_seams) {
    members_.clear();
    for (const uint32_t end : {a, b}) {
        for (const uint32_t t : adjacency.around(end)) {
            if (mesh.dead(t))
                continue;
            uint32_t at_a = kNone;
            uint32_t at_b = kNone;
            for (int corner = 0; corner < 3; ++corner) {
                if (mesh.triangles[t][corner] == a)
                    at_a = find_or_add(mesh.wedges[t][corner], true);
                if (mesh.triangles[t][corner] == b)
                    at_b = find_or_add(mesh.wedges[t][corner], false);
            }
            if (members_.size() > kMostWedges) {
                members_.clear();
                return join_seams;
            }
            if (end == b || at_a == kNone || at_b == kNone)
                continue;
            // The triangle is on the edge: both corners become one.
            const uint32_t to = members_[at_a].group;
            const uint32_t from = members_[at_b].group;
            if (to == from)
                continue;
            int at_a_of[2] = {0, 0};
            int at_b_of[2] = {0, 0};
            for (const WedgeMember& member : members_) {
                if (member.group == to || member.group == from)
                    ++(member.at_a ? at_a_of : at_b_of)[member.group == from];
            }
            const bool clash = (at_a_of[0] && at_a_of[1]) || (at_b_of[0] && at_b_of[1]);
            if (clash && !join_seams)
                return false;
            if (clash)
                continue;
            for (WedgeMember& member : members_) {
                if (member.group == from)
                    member.group = to;
            }
        }
    }
    values_.assign(members_.size(), WedgeValue{});
    for (WedgeValue& value : values_)
        value.square = std::numeric_limits<double>::infinity();
    for (const uint32_t end : {a, b}) {
        for (const uint32_t t : adjacency.around(end)) {
            if (mesh.dead(t))
                continue;
            const Triangle& corners = mesh.triangles[t];
            const glm::dvec3 p[3] = {mesh.points[corners.x], mesh.points[corners.y],
                                     mesh.points[corners.z]};
            const glm::dvec3 weights =
                geometry::nearest_weights(p[0] - point, p[1] - point, p[2] - point);
            if (!finite(weights))
                continue;
            const glm::dvec3 off = weights.x * p[0] + weights.y * p[1] + weights.z * p[2] - point;
            const double square = glm::dot(off, off);
            for (int corner = 0; corner < 3; ++corner) {
                if (corners[corner] != end)
                    continue;
                const uint32_t member = find_or_add(mesh.wedges[t][corner], end == a);
                WedgeValue& value = values_[members_[member].group];
                if (!(square < value.square))
                    continue;
                value.square = square;
                value.normal = glm::dvec3(0.0);
                value.uv = glm::dvec2(0.0);
                value.color = glm::dvec4(0.0);
                for (int k = 0; k < 3; ++k) {
                    const uint32_t wedge = mesh.wedges[t][k];
                    if (!mesh.normals.empty())
                        value.normal += weights[k] * glm::dvec3(mesh.normals[wedge]);
                    if (!mesh.uvs.empty())
                        value.uv += weights[k] * glm::dvec2(mesh.uvs[wedge]);
                    if (!mesh.colors.empty())
                        value.color += weights[k] * glm::dvec4(mesh.colors[wedge]);
                }
            }
        }
    }
    return true;
}

void WedgeMerge::apply(CollapseMesh& mesh) {
    for (uint32_t i = 0; i < members_.size(); ++i) {
        const WedgeValue& value = values_[i];
        if (members_[i].group != i || !std::isfinite(value.square))
            continue;
        const uint32_t wedge = members_[i].wedge;
        if (!mesh.normals.empty()) {
            const double length = glm::length(value.normal);
            if (length > 1e-6)
                mesh.normals[wedge] = glm::vec3(value.normal / length);
        }
        if (!mesh.uvs.empty())
            mesh.uvs[wedge] = glm::vec2(value.uv);
        if (!mesh.colors.empty())
            mesh.colors[wedge] = glm::vec4(value.color);
    }
}

uint32_t WedgeMerge::wedge_of(uint32_t old_wedge) const {
    for (const WedgeMember& member : members_) {
        if (member.wedge == old_wedge)
            return members_[member.group].wedge;
    }
    return old_wedge;
}

}  // namespace lodestone::simplify
