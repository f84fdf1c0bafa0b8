// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/polygon_mesh.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lodestone {
namespace {

constexpr uint32_t kEnd = ~uint32_t{0};
// The most tries for an equal vertex, the last made first.
// Taste: more find more equal vertices; the limit bounds the time.
constexpr size_t kMostTries = 256;
// The distance below which given normals are those of the faces.
// Law: Blender's normals equal ours to 1e-5 (measured); this is twice that.
constexpr double kRounding = 2e-5;

glm::dvec3 point(const PolygonMesh& faces, size_t corner) {
    const float* p = faces.positions + 3 * size_t{faces.vertices[corner]};
    return {p[0], p[1], p[2]};
}

/// Twice the area of a face times its unit normal; 0 for fewer than three corners.
glm::dvec3 area_of(const PolygonMesh& faces, size_t begin, size_t end) {
    if (end < begin + 3)
        return glm::dvec3(0.0);
    const glm::dvec3 first = point(faces, begin);
    glm::dvec3 sum(0.0);
    glm::dvec3 last = point(faces, begin + 1) - first;
    for (size_t corner = begin + 2; corner < end; ++corner) {
        const glm::dvec3 next = point(faces, corner) - first;
        sum += glm::cross(last, next);
        last = next;
    }
    return sum;
}

glm::dvec3 unit(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0 ? v / length : glm::dvec3(0.0);
}

/// True when the line between the first and third corner lies outside of a face of four corners.
bool split_other_way(const PolygonMesh& faces, size_t begin) {
    const glm::dvec3 first = point(faces, begin);
    const glm::dvec3 line = point(faces, begin + 2) - first;
    return glm::dot(glm::cross(point(faces, begin + 1) - first, line),
                    glm::cross(point(faces, begin + 3) - first, line)) > 0;
}

/// Calls add(face, corner, corner, corner) for every triangle.
template <typename Add>
void for_each_triangle(const PolygonMesh& faces, const Add& add) {
    size_t face = 0;
    if (!faces.triangles.empty()) {
        for (size_t t = 0; t < faces.triangles.size(); t += 3) {
            const uint32_t* corners = faces.triangles.data() + t;
            while (face + 1 < faces.count() && corners[0] >= faces.begin(face + 1))
                ++face;
            add(face, corners[0], corners[1], corners[2]);
        }
        return;
    }
    for (; face < faces.count(); ++face) {
        const auto at = static_cast<uint32_t>(faces.begin(face));
        const size_t size = faces.end(face) - at;
        if (size == 3) {
            add(face, at, at + 1, at + 2);
        } else if (size == 4) {
            const uint32_t other = split_other_way(faces, at) ? 1 : 0;
            add(face, at, at + 1, at + 2 + other);
            add(face, at + other, at + 2, at + 3);
        }
    }
}

size_t triangle_count(const PolygonMesh& faces) {
    return faces.triangles.empty()
               ? faces.vertices.size() - 2 * std::min(faces.count(), faces.vertices.size() / 2)
               : faces.triangles.size() / 3;
}

/// The unit normals of vertices: means of the faces' normals, weighted by their angles. 0 where a
/// vertex has none.
std::vector<glm::vec3> vertex_normals(const PolygonMesh& faces) {
    std::vector<glm::dvec3> sums(faces.vertex_count, glm::dvec3(0.0));
    for (size_t face = 0; face < faces.count(); ++face) {
        const size_t begin = faces.begin(face);
        const size_t end = faces.end(face);
        if (end < begin + 3)
            continue;
        const glm::dvec3 normal = unit(area_of(faces, begin, end));
        const glm::dvec3 closing = unit(point(faces, begin) - point(faces, end - 1));
        glm::dvec3 before = closing;
        for (size_t corner = begin; corner < end; ++corner) {
            const glm::dvec3 after =
                corner + 1 == end ? closing : unit(point(faces, corner + 1) - point(faces, corner));
            const double turn = std::clamp(-glm::dot(before, after), -1.0, 1.0);
            sums[faces.vertices[corner]] += std::acos(turn) * normal;
            before = after;
        }
    }
    std::vector<glm::vec3> normals(sums.size());
    for (size_t i = 0; i < sums.size(); ++i)
        normals[i] = glm::vec3(unit(sums[i]));
    return normals;
}

class FaceCornerNormals {
public:
    explicit FaceCornerNormals(const PolygonMesh& faces) : faces_(faces) {
        const bool smooth = std::find_if(faces.smooth.begin(), faces.smooth.end(),
                                         [](uint8_t s) { return s != 0; }) != faces.smooth.end();
        if (smooth)
            vertex_normals_ = vertex_normals(faces);
        has_normals_ = smooth || faces.normals != nullptr;
        if (!has_normals_)
            return;
        flat_.assign(faces.count(), 0);
        for (size_t face = 0; face < flat_.size(); ++face)
            flat_[face] = faces.smooth.empty() || faces.smooth[face] == 0 ? 1 : 0;
        any_flat_ = std::find(flat_.begin(), flat_.end(), 1) != flat_.end();
    }

    bool has_normals() const { return has_normals_; }
    /// Whether every vertex looks the same from all of its corners.
    bool whole() const {
        return (!has_normals_ || (!any_flat_ && faces_.normals == nullptr)) &&
               faces_.uvs == nullptr && faces_.colors == nullptr;
    }
    std::vector<glm::vec3>& of_vertices() { return vertex_normals_; }

    glm::vec3 normal(size_t face, size_t corner) {
        if (flat_[face] != 0) {
            if (face != last_face_) {
                last_face_ = face;
                last_normal_ = unit(area_of(faces_, faces_.begin(face), faces_.end(face)));
            }
            return settled(corner, last_normal_);
        }
        return settled(corner, vertex_normals_[faces_.vertices[corner]]);
    }

private:
    glm::vec3 settled(size_t corner, const glm::vec3& made) const {
        if (faces_.normals == nullptr)
            return made;
        const float* n = faces_.normals + 3 * corner;
        const glm::vec3 given(n[0], n[1], n[2]);
        const glm::vec3 apart = given - made;
        return glm::dot(apart, apart) < static_cast<float>(kRounding * kRounding) ? made : given;
    }

    const PolygonMesh& faces_;
    std::vector<glm::vec3> vertex_normals_;
    std::vector<uint8_t> flat_;
    bool has_normals_ = false;
    bool any_flat_ = false;
    size_t last_face_ = ~size_t{0};
    glm::vec3 last_normal_{0};
};

}  // namespace

void check(const PolygonMesh& faces) {
    const size_t corners = faces.vertices.size();
    // The most vertices and corners.
    // Law: indices have 32 bits, and some numbers above are marks.
    constexpr size_t kMost = size_t{1} << 31u;
    if (faces.vertex_count > kMost || corners > kMost)
        fail(Status::InvalidArgument, "a mesh of ", faces.vertex_count, " vertices and ", corners,
             " corners is larger than 2^31");
    if (faces.starts.empty() && corners % 3 != 0)
        fail(Status::InvalidArgument, corners, " corners are not those of triangles");
    const auto beyond = [](std::span<const uint32_t> values, size_t count) {
        uint32_t largest = 0;  // without a branch for each
        for (const uint32_t value : values)
            largest = std::max(largest, value);
        return values.empty() || largest < count
                   ? values.end()
                   : std::find_if(values.begin(), values.end(),
                                  [&](uint32_t value) { return value >= count; });
    };
    if (const auto at = beyond(faces.vertices, faces.vertex_count); at != faces.vertices.end())
        fail(Status::InvalidArgument, "corner ", at - faces.vertices.begin(), " uses vertex ", *at,
             " of ", faces.vertex_count);
    for (size_t face = 0; face < faces.starts.size(); ++face) {
        const size_t begin = faces.begin(face);
        const size_t end = faces.end(face);
        if (begin > end || end > corners || (face == 0 && begin != 0))
            fail(Status::InvalidArgument, "face ", face, " has the corners ", begin, " to ", end,
                 " of ", corners);
        if (end - begin > 4 && faces.triangles.empty())
            fail(Status::InvalidArgument, "face ", face, " of ", end - begin,
                 " corners comes without triangles");
    }
    if (faces.triangles.size() % 3 != 0)
        fail(Status::InvalidArgument, faces.triangles.size(),
             " corners are not those of triangles");
    if (const auto at = beyond(faces.triangles, corners); at != faces.triangles.end())
        fail(Status::InvalidArgument, "triangle ", (at - faces.triangles.begin()) / 3,
             " uses corner ", *at, " of ", corners);
    if (!faces.smooth.empty() && faces.smooth.size() != faces.count())
        fail(Status::InvalidArgument, faces.smooth.size(), " flags for ", faces.count(), " faces");
    if (!faces.slots.empty() && faces.slots.size() != faces.count())
        fail(Status::InvalidArgument, faces.slots.size(), " material slots for ", faces.count(),
             " faces");
}

size_t largest_face(std::span<const uint32_t> starts, size_t corner_count) {
    size_t largest = 0;
    for (size_t face = 0; face < starts.size(); ++face) {
        const size_t end = face + 1 < starts.size() ? starts[face + 1] : corner_count;
        if (starts[face] > end)
            return 0;
        largest = std::max(largest, end - starts[face]);
    }
    return largest;
}

FaceTriangles triangulated(const PolygonMesh& faces) {
    FaceTriangles out;
    out.corners.reserve(triangle_count(faces));
    out.faces.reserve(triangle_count(faces));
    for_each_triangle(faces, [&](size_t face, uint32_t a, uint32_t b, uint32_t c) {
        out.corners.emplace_back(a, b, c);
        out.faces.push_back(static_cast<uint32_t>(face));
    });
    return out;
}

Mesh mesh_of(const PolygonMesh& faces, size_t slot_count) {
    Mesh mesh;
    FaceCornerNormals corners(faces);
    mesh.triangles.reserve(triangle_count(faces));
    if (!faces.slots.empty() && slot_count > 1) {
        const auto last = static_cast<int32_t>(std::min<size_t>(slot_count, 65535)) - 1;
        mesh.slots.reserve(triangle_count(faces));
        for_each_triangle(faces, [&](size_t face, uint32_t, uint32_t, uint32_t) {
            mesh.slots.push_back(static_cast<uint16_t>(std::clamp(faces.slots[face], 0, last)));
        });
    }
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float) && sizeof(glm::vec4) == 4 * sizeof(float));
    mesh.positions.resize(faces.vertex_count);
    if (faces.vertex_count > 0)
        std::memcpy(mesh.positions.data(), faces.positions, faces.vertex_count * sizeof(glm::vec3));
    if (faces.colors == nullptr && faces.vertex_colors != nullptr) {
        mesh.colors.resize(faces.vertex_count);
        if (faces.vertex_count > 0)
            std::memcpy(mesh.colors.data(), faces.vertex_colors,
                        faces.vertex_count * sizeof(glm::vec4));
    }
    if (corners.whole()) {
        mesh.normals = std::move(corners.of_vertices());
        for_each_triangle(faces, [&](size_t, uint32_t a, uint32_t b, uint32_t c) {
            mesh.triangles.emplace_back(faces.vertices[a], faces.vertices[b], faces.vertices[c]);
        });
        return mesh;
    }
    if (corners.has_normals())
        mesh.normals.resize(faces.vertex_count);
    if (faces.uvs != nullptr)
        mesh.uvs.resize(faces.vertex_count);
    if (faces.colors != nullptr)
        mesh.colors.resize(faces.vertex_count);
    // The first corner of a position takes its place; corners that differ follow behind all
    // positions, in chains, which almost always are one or two long.
    std::vector<uint8_t> taken(faces.vertex_count, 0);
    std::vector<uint32_t> next(faces.vertex_count, kEnd);
    std::vector<uint32_t> made(faces.vertices.size(), kEnd);  // by corner
    const auto vertex_of = [&](size_t face, size_t corner) {
        if (made[corner] != kEnd)
            return made[corner];
        const uint32_t position = faces.vertices[corner];
        glm::vec3 normal(0);
        glm::vec2 uv(0);
        glm::vec4 color(1);
        if (corners.has_normals())
            normal = corners.normal(face, corner);
        if (faces.uvs != nullptr)
            uv = {faces.uvs[2 * corner], faces.uvs[2 * corner + 1]};
        if (faces.colors != nullptr) {
            const float* c = faces.colors + 4 * corner;
            color = {c[0], c[1], c[2], c[3]};
        } else if (!mesh.colors.empty()) {
            color = mesh.colors[position];
        }
        uint32_t vertex = position;
        if (taken[position] != 0) {
            size_t tries = 0;
            for (uint32_t at = position; at != kEnd && tries < kMostTries; at = next[at], ++tries) {
                if ((mesh.normals.empty() || mesh.normals[at] == normal) &&
                    (mesh.uvs.empty() || mesh.uvs[at] == uv) &&
                    (mesh.colors.empty() || mesh.colors[at] == color))
                    return made[corner] = at;
            }
            vertex = static_cast<uint32_t>(mesh.positions.size());
            mesh.positions.push_back(glm::vec3(mesh.positions[position]));
            mesh.normals.resize(mesh.normals.empty() ? 0 : vertex + size_t{1});
            mesh.uvs.resize(mesh.uvs.empty() ? 0 : vertex + size_t{1});
            mesh.colors.resize(mesh.colors.empty() ? 0 : vertex + size_t{1});
            next.push_back(next[position]);
            next[position] = vertex;
        }
        taken[position] = 1;
        if (!mesh.normals.empty())
            mesh.normals[vertex] = normal;
        if (!mesh.uvs.empty())
            mesh.uvs[vertex] = uv;
        if (!mesh.colors.empty())
            mesh.colors[vertex] = color;
        return made[corner] = vertex;
    };
    for_each_triangle(faces, [&](size_t face, uint32_t a, uint32_t b, uint32_t c) {
        const uint32_t x = vertex_of(face, a);
        const uint32_t y = vertex_of(face, b);
        mesh.triangles.emplace_back(x, y, vertex_of(face, c));
    });
    return mesh;
}

}  // namespace lodestone
