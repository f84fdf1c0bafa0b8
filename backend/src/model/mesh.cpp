// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lodestone {
namespace {

// Law: white multiplies by 1.
constexpr glm::vec4 kWhite(1);

/// Drops vertices nothing uses, keeping order.
void compact(Mesh& mesh) {
    constexpr uint32_t kUnused = ~uint32_t{0};
    std::vector<uint32_t> moved(mesh.positions.size(), kUnused);
    for (const Triangle& t : mesh.triangles)
        moved[t.x] = moved[t.y] = moved[t.z] = 0;
    if (std::find(moved.begin(), moved.end(), kUnused) == moved.end())
        return;
    uint32_t count = 0;
    for (size_t i = 0; i < moved.size(); ++i) {
        if (moved[i] == kUnused)
            continue;
        mesh.positions[count] = mesh.positions[i];
        if (!mesh.normals.empty())
            mesh.normals[count] = mesh.normals[i];
        if (!mesh.uvs.empty())
            mesh.uvs[count] = mesh.uvs[i];
        if (!mesh.colors.empty())
            mesh.colors[count] = mesh.colors[i];
        moved[i] = count++;
    }
    mesh.positions.resize(count);
    if (!mesh.normals.empty())
        mesh.normals.resize(count);
    if (!mesh.uvs.empty())
        mesh.uvs.resize(count);
    if (!mesh.colors.empty())
        mesh.colors.resize(count);
    for (Triangle& t : mesh.triangles)
        t = Triangle(moved[t.x], moved[t.y], moved[t.z]);
}

/// Splits every triangle's vertices and gives them the face's normal.
void make_flat_normals(Mesh& mesh) {
    Mesh flat;
    flat.slots = std::move(mesh.slots);
    flat.triangles.reserve(mesh.triangles.size());
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::dvec3 area = area_vector(mesh, i);
        const double length = glm::length(area);
        const glm::vec3 normal(length > 0 ? area / length : glm::dvec3(0, 0, 1));
        const auto first = static_cast<uint32_t>(flat.positions.size());
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = mesh.triangles[i][corner];
            flat.positions.push_back(mesh.positions[vertex]);
            flat.normals.push_back(normal);
            if (!mesh.uvs.empty())
                flat.uvs.push_back(mesh.uvs[vertex]);
            if (!mesh.colors.empty())
                flat.colors.push_back(mesh.colors[vertex]);
        }
        flat.triangles.emplace_back(first, first + 1, first + 2);
    }
    mesh = std::move(flat);
}

}  // namespace

glm::dvec3 area_vector(const Mesh& mesh, size_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    const glm::dvec3 a(mesh.positions[t.x]);
    return glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
}

double surface_area(const Mesh& mesh) {
    double twice = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        twice += glm::length(area_vector(mesh, i));
    return 0.5 * twice;
}

Hash hash_of(const Mesh& mesh) {
    return Hasher()
        .array(std::span<const glm::vec3>(mesh.positions))
        .array(std::span<const glm::vec3>(mesh.normals))
        .array(std::span<const glm::vec2>(mesh.uvs))
        .array(std::span<const Triangle>(mesh.triangles))
        .array(std::span<const uint16_t>(mesh.slots))
        .array(std::span<const glm::vec4>(mesh.colors))
        .result();
}

void check(const Mesh& mesh) {
    const size_t vertices = mesh.positions.size();
    // Law: indices have 32 bits, and this leaves room for sums of two.
    constexpr size_t kMost = size_t{1} << 31u;
    if (vertices > kMost || mesh.triangles.size() > kMost)
        fail(Status::InvalidArgument, "a mesh of ", vertices, " vertices and ",
             mesh.triangles.size(), " triangles is larger than 2^31");
    if (!mesh.normals.empty() && mesh.normals.size() != vertices)
        fail(Status::InvalidArgument, mesh.normals.size(), " normals for ", vertices, " vertices");
    if (!mesh.uvs.empty() && mesh.uvs.size() != vertices)
        fail(Status::InvalidArgument, mesh.uvs.size(), " texture coordinates for ", vertices,
             " vertices");
    if (!mesh.colors.empty() && mesh.colors.size() != vertices)
        fail(Status::InvalidArgument, mesh.colors.size(), " colors for ", vertices, " vertices");
    if (!mesh.slots.empty() && mesh.slots.size() != mesh.triangles.size())
        fail(Status::InvalidArgument, mesh.slots.size(), " material slots for ",
             mesh.triangles.size(), " triangles");
    // All of them first, without a branch: an index beyond the last has the highest bit, or what is
    // left of the last has.
    const auto last = static_cast<uint32_t>(vertices) - 1;
    Triangle beyond(0);
    for (const Triangle& t : mesh.triangles)
        beyond |= t | (last - t);
    if ((beyond.x | beyond.y | beyond.z) >> 31u == 0)
        return;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            if (mesh.triangles[i][corner] >= vertices)
                fail(Status::InvalidArgument, "triangle ", i, " uses vertex ",
                     mesh.triangles[i][corner], " of ", vertices);
        }
    }
}

void repair(Mesh& mesh, const std::string& object, Problems& problems) {
    std::vector<uint8_t> keep;
    size_t dropped = 0;
    if (!all_finite(mesh.positions)) {
        keep.assign(mesh.triangles.size(), 1);
        for (size_t i = 0; i < mesh.triangles.size(); ++i) {
            const Triangle& t = mesh.triangles[i];
            if (!finite(mesh.positions[t.x]) || !finite(mesh.positions[t.y]) ||
                !finite(mesh.positions[t.z])) {
                keep[i] = 0;
                ++dropped;
            }
        }
    }
    if (dropped > 0) {
        mesh = subset(mesh, keep);
        problems.push_back({object, Severity::Error, "non_finite_vertices",
                            text(dropped,
                                 " triangles with vertices that are not numbers were left "
                                 "out; merge or delete those vertices")});
    } else if (!mesh.positions.empty()) {
        compact(mesh);
    }
    size_t normals = 0;
    std::vector<uint8_t> bad(mesh.normals.size(), 0);
    for (size_t i = 0; i < mesh.normals.size(); ++i) {
        const float square = glm::dot(mesh.normals[i], mesh.normals[i]);
        bad[i] = !std::isfinite(square) || square < 1e-12f;
        if (bad[i])
            ++normals;
        else if (std::abs(square - 1) > 1e-4f)
            mesh.normals[i] /= std::sqrt(square);
    }
    if (normals > 0) {
        for (size_t i = 0; i < mesh.triangles.size(); ++i) {
            const glm::dvec3 area = area_vector(mesh, i);
            const double length = glm::length(area);
            for (int corner = 0; corner < 3; ++corner) {
                const uint32_t vertex = mesh.triangles[i][corner];
                if (bad[vertex])
                    mesh.normals[vertex] =
                        glm::vec3(length > 0 ? area / length : glm::dvec3(0, 0, 1));
            }
        }
    }
    for (glm::vec2& uv : mesh.uvs) {
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
            uv = glm::vec2(0);
    }
    for (glm::vec4& color : mesh.colors) {
        if (!std::isfinite(color.x + color.y + color.z + color.w))
            color = kWhite;
    }
}

void append(Mesh& mesh, const Mesh& part, const Affine& transform, uint16_t first_slot) {
    if (part.empty())
        return;
    const Mesh* source = &part;
    Mesh flat;
    if (!mesh.empty() && mesh.normals.empty() != part.normals.empty()) {
        if (mesh.normals.empty()) {
            make_flat_normals(mesh);
        } else {
            flat = part;
            make_flat_normals(flat);
            source = &flat;
        }
    }
    const size_t old_triangles = mesh.triangles.size();
    if (!source->uvs.empty() || !mesh.uvs.empty()) {
        mesh.uvs.resize(mesh.positions.size(), glm::vec2(0));
        mesh.uvs.insert(mesh.uvs.end(), source->uvs.begin(), source->uvs.end());
    }
    if (!source->colors.empty() || !mesh.colors.empty()) {
        mesh.colors.resize(mesh.positions.size(), kWhite);
        mesh.colors.insert(mesh.colors.end(), source->colors.begin(), source->colors.end());
    }
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const glm::vec3& position : source->positions)
        mesh.positions.emplace_back(transform(glm::dvec3(position)));
    if (!mesh.uvs.empty())
        mesh.uvs.resize(mesh.positions.size(), glm::vec2(0));
    if (!mesh.colors.empty())
        mesh.colors.resize(mesh.positions.size(), kWhite);
    const double determinant = glm::determinant(transform.linear);
    if (!source->normals.empty()) {
        // The cofactor matrix turns normals right even where the transform is singular.
        const glm::dmat3& m = transform.linear;
        glm::dmat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
        if (determinant < 0)
            cofactor = -cofactor;
        for (const glm::vec3& normal : source->normals) {
            const glm::dvec3 turned = cofactor * glm::dvec3(normal);
            const double length = glm::length(turned);
            mesh.normals.emplace_back(length > 0 ? turned / length : glm::dvec3(0, 0, 1));
        }
    }
    for (const Triangle& t : source->triangles) {
        const Triangle moved = t + first;
        mesh.triangles.push_back(determinant < 0 ? Triangle(moved.x, moved.z, moved.y) : moved);
    }
    if (first_slot != 0 || !source->slots.empty() || !mesh.slots.empty()) {
        mesh.slots.resize(old_triangles, 0);
        for (size_t i = 0; i < source->triangles.size(); ++i)
            mesh.slots.push_back(static_cast<uint16_t>(first_slot + source->slot(i)));
    }
}

Mesh subset(const Mesh& mesh, const std::vector<uint8_t>& keep) {
    Mesh out;
    out.positions = mesh.positions;
    out.normals = mesh.normals;
    out.uvs = mesh.uvs;
    out.colors = mesh.colors;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (!keep[i])
            continue;
        out.triangles.push_back(mesh.triangles[i]);
        if (!mesh.slots.empty())
            out.slots.push_back(mesh.slots[i]);
    }
    compact(out);
    return out;
}

std::vector<uint32_t> weld(const Mesh& mesh) {
    const size_t count = mesh.positions.size();
    size_t size = 16;
    while (size < count * 2)
        size *= 2;
    constexpr uint32_t kFree = ~uint32_t{0};
    std::vector<uint32_t> table(size, kFree);
    std::vector<uint32_t> welded(count);
    for (size_t i = 0; i < count; ++i) {
        const glm::vec3 position = mesh.positions[i] + 0.0f;  // -0 becomes +0
        uint64_t bits[2] = {0, 0};
        std::memcpy(bits, &position, sizeof position);
        uint64_t key = (bits[0] ^ (bits[1] * 0x9e3779b97f4a7c15u)) * 0xd6e8feb86659fd93u;
        key ^= key >> 32;
        for (size_t slot = key & (size - 1);; slot = (slot + 1) & (size - 1)) {
            if (table[slot] == kFree) {
                table[slot] = static_cast<uint32_t>(i);
                welded[i] = static_cast<uint32_t>(i);
                break;
            }
            if (mesh.positions[table[slot]] == mesh.positions[i]) {
                welded[i] = table[slot];
                break;
            }
        }
    }
    return welded;
}

bool closed(const Mesh& mesh) {
    if (mesh.empty())
        return false;
    const std::vector<uint32_t> welded = weld(mesh);
    std::vector<uint64_t> forward;
    std::vector<uint64_t> backward;
    forward.reserve(mesh.triangles.size() * 3);
    backward.reserve(mesh.triangles.size() * 3);
    for (const Triangle& t : mesh.triangles) {
        const uint64_t corners[3] = {welded[t.x], welded[t.y], welded[t.z]};
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
            continue;
        for (int i = 0; i < 3; ++i) {
            const uint64_t from = corners[i];
            const uint64_t to = corners[(i + 1) % 3];
            forward.push_back((from << 32u) | to);
            backward.push_back((to << 32u) | from);
        }
    }
    std::sort(forward.begin(), forward.end());
    if (std::adjacent_find(forward.begin(), forward.end()) != forward.end())
        return false;
    std::sort(backward.begin(), backward.end());
    return !forward.empty() && forward == backward;
}

}  // namespace lodestone
