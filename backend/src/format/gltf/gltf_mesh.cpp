// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/gltf/gltf_mesh.h"

#include "format/gltf/gltf_accessor.h"
#include "format/gltf/gltf_extensions.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

namespace lodestone::format {
namespace {

glm::vec3 to_y_up(const glm::vec3& v) {
    return {v.x, v.z, -v.y};
}

glm::vec3 to_z_up(const glm::vec3& v) {
    return {v.x, -v.z, v.y};
}

bool same_bits(float a, float b) {
    return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b);
}

template <int N>
std::span<const float> floats(const std::vector<glm::vec<N, float>>& values) {
    return {reinterpret_cast<const float*>(values.data()), values.size() * N};
}

void check_finite(const Mesh& mesh, const std::string& name) {
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        bool finite = true;
        for (int c = 0; c < 3; ++c)
            finite = finite && std::isfinite(mesh.positions[i][c]) &&
                     (mesh.normals.empty() || std::isfinite(mesh.normals[i][c])) &&
                     (mesh.uvs.empty() || std::isfinite(mesh.uvs[i][c % 2]));
        if (!mesh.colors.empty()) {
            for (int c = 0; c < 4; ++c)
                finite = finite && std::isfinite(mesh.colors[i][c]);
        }
        if (!finite)
            fail(Status::InvalidArgument, "mesh '", name, "': vertex ", i,
                 " has a value that is not a number");
    }
}

using Attributes = std::map<std::string, int>;

constexpr const char* kColors = "COLOR_0";
constexpr const char* kUnusedColors = "_LODESTONE_COLOR";

Attributes add_attributes(tinygltf::Model& model, const Mesh& mesh) {
    Attributes attributes;
    std::vector<glm::vec3> turned(mesh.positions.size());
    std::transform(mesh.positions.begin(), mesh.positions.end(), turned.begin(), to_y_up);
    attributes["POSITION"] = add_floats(model, floats<3>(turned), 3, true);
    if (!mesh.normals.empty()) {
        std::transform(mesh.normals.begin(), mesh.normals.end(), turned.begin(), to_y_up);
        attributes["NORMAL"] = add_floats(model, floats<3>(turned), 3, false);
    }
    if (!mesh.uvs.empty()) {
        std::vector<glm::vec2> uvs = mesh.uvs;
        std::vector<float> true_v;
        bool lossless = true;
        for (glm::vec2& uv : uvs) {
            true_v.push_back(uv.y);
            uv.y = 1 - uv.y;
            lossless = lossless && same_bits(1 - uv.y, true_v.back());
        }
        attributes["TEXCOORD_0"] = add_floats(model, floats<2>(uvs), 2, false);
        if (!lossless)
            attributes["_LODESTONE_V"] = add_floats(model, true_v, 1, false);
    }
    if (!mesh.colors.empty())
        attributes[kColors] = add_floats(model, floats<4>(mesh.colors), 4, false);
    return attributes;
}

/// Slots in order of first use, each with its triangles.
struct SlotTriangles {
    uint16_t slot = 0;
    std::vector<Triangle> triangles;
};

std::vector<SlotTriangles> groups_of(const Mesh& mesh) {
    std::vector<SlotTriangles> groups;
    std::map<uint16_t, size_t> group_of;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto found = group_of.emplace(mesh.slot(i), groups.size());
        if (found.second)
            groups.push_back({mesh.slot(i), {}});
        groups[found.first->second].triangles.push_back(mesh.triangles[i]);
    }
    return groups;
}

int add_indices(tinygltf::Model& model, const std::vector<Triangle>& triangles, size_t vertices) {
    tinygltf::Accessor accessor;
    accessor.type = TINYGLTF_TYPE_SCALAR;
    accessor.count = triangles.size() * 3;
    constexpr int kTarget = TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER;
    if (vertices <= 65535) {  // 65535 itself means "restart"
        std::vector<uint16_t> small;
        small.reserve(accessor.count);
        for (const Triangle& t : triangles) {
            for (int corner = 0; corner < 3; ++corner)
                small.push_back(static_cast<uint16_t>(t[corner]));
        }
        accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
        accessor.bufferView = add_view(model, small.data(), small.size() * 2, kTarget);
    } else {
        accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        accessor.bufferView =
            add_view(model, triangles.data(), triangles.size() * sizeof(Triangle), kTarget);
    }
    model.accessors.push_back(std::move(accessor));
    return static_cast<int>(model.accessors.size() - 1);
}

int add_slots(tinygltf::Model& model, const std::vector<uint16_t>& slots) {
    tinygltf::Accessor accessor;
    accessor.type = TINYGLTF_TYPE_SCALAR;
    accessor.count = slots.size();
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    accessor.bufferView = add_view(model, slots.data(), slots.size() * 2, 0);
    model.accessors.push_back(std::move(accessor));
    return static_cast<int>(model.accessors.size() - 1);
}

std::vector<glm::vec3> read_vectors(const AccessorElements& from) {
    std::vector<glm::vec3> out(from.count());
    for (size_t i = 0; i < out.size(); ++i)
        out[i] = to_z_up({from.number(i, 0), from.number(i, 1), from.number(i, 2)});
    return out;
}

/// Positions, normals, uvs, colors of one set of attributes.
Mesh read_attributes(const tinygltf::Model& model, const Attributes& attributes) {
    const auto accessor = [&](const char* name) {
        const auto found = attributes.find(name);
        return found == attributes.end() ? -1 : found->second;
    };
    Mesh mesh;
    if (accessor("POSITION") < 0)
        fail(Status::BadFile, "there are no positions");
    mesh.positions = read_vectors(AccessorElements(model, accessor("POSITION"), 3));
    const size_t count = mesh.positions.size();
    const auto check_count = [count](size_t found, const char* what) {
        if (found != count)
            fail(Status::BadFile, found, ' ', what, " for ", count, " positions");
    };
    if (accessor("NORMAL") >= 0) {
        const AccessorElements normals(model, accessor("NORMAL"), 3);
        check_count(normals.count(), "normals");
        mesh.normals = read_vectors(normals);
    }
    if (accessor("TEXCOORD_0") >= 0) {
        const AccessorElements uvs(model, accessor("TEXCOORD_0"), 2);
        check_count(uvs.count(), "texture coordinates");
        mesh.uvs.resize(count);
        for (size_t i = 0; i < count; ++i)
            mesh.uvs[i] = {uvs.number(i, 0), 1 - uvs.number(i, 1)};
    }
    const int color = accessor(kColors) >= 0 ? accessor(kColors) : accessor(kUnusedColors);
    if (color >= 0) {
        const bool alpha = components_of(model, color) == 4;
        const AccessorElements colors(model, color, alpha ? 4 : 3);
        check_count(colors.count(), "colors");
        mesh.colors.resize(count);
        for (size_t i = 0; i < count; ++i)
            mesh.colors[i] = {colors.number(i, 0), colors.number(i, 1), colors.number(i, 2),
                              alpha ? colors.number(i, 3) : 1.0f};
    }
    if (accessor("_LODESTONE_V") >= 0 && !mesh.uvs.empty()) {
        const AccessorElements true_v(model, accessor("_LODESTONE_V"), 1);
        check_count(true_v.count(), "values of _LODESTONE_V");
        for (size_t i = 0; i < count; ++i) {
            // Believed only where it is what the flipped value came from.
            const float v = true_v.number(i, 0);
            if (same_bits(1 - (1 - v), mesh.uvs[i].y))
                mesh.uvs[i].y = v;
        }
    }
    return mesh;
}

std::vector<uint32_t> read_indices(const tinygltf::Model& model, const tinygltf::Primitive& from,
                                   size_t vertices) {
    std::vector<uint32_t> indices;
    if (from.indices < 0) {
        indices.resize(vertices);
        for (size_t i = 0; i < vertices; ++i)
            indices[i] = static_cast<uint32_t>(i);
        return indices;
    }
    const AccessorElements elements(model, from.indices, 1);
    indices.resize(elements.count());
    for (size_t i = 0; i < indices.size(); ++i) {
        indices[i] = elements.index(i);
        if (indices[i] >= vertices)
            fail(Status::BadFile, "an index names vertex ", indices[i], " of ", vertices);
    }
    return indices;
}

std::vector<Triangle> triangles_of(const std::vector<uint32_t>& indices, int mode) {
    std::vector<Triangle> out;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        for (size_t i = 0; i + 2 < indices.size(); i += 3)
            out.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
        return out;
    }
    for (size_t i = 0; i + 2 < indices.size(); ++i) {
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
            out.emplace_back(indices[i + 1], indices[i + 2], indices[0]);
        else if (i % 2 == 0)
            out.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
        else
            out.emplace_back(indices[i + 1], indices[i], indices[i + 2]);
    }
    return out;
}

/// Puts the triangles of the groups back into the order of `slots`.
bool reorder(const std::vector<SlotTriangles>& groups, const std::vector<uint16_t>& slots,
             Mesh& mesh) {
    std::map<uint16_t, std::pair<const SlotTriangles*, size_t>> next;
    size_t total = 0;
    for (const SlotTriangles& group : groups) {
        next[group.slot] = {&group, 0};
        total += group.triangles.size();
    }
    if (total != slots.size() || next.size() != groups.size())
        return false;
    for (const uint16_t slot : slots) {
        const auto found = next.find(slot);
        if (found == next.end() || found->second.second >= found->second.first->triangles.size())
            return false;
        mesh.triangles.push_back(found->second.first->triangles[found->second.second++]);
    }
    mesh.slots = slots;
    return true;
}

/// With colors called the same whether they are used or not.
Attributes by_one_name(Attributes attributes) {
    if (auto unused = attributes.extract(kUnusedColors)) {
        unused.key() = kColors;
        attributes.insert(std::move(unused));
    }
    return attributes;
}

/// own_mesh() without the safety net.
std::optional<ReadMesh> try_own(const tinygltf::Model& model, const tinygltf::Mesh& from) {
    const tinygltf::Value& mark = member(from.extras, "lodestone");
    if (!mark.Has("version") || !mark.Get("version").IsInt() ||
        mark.Get("version").GetNumberAsInt() != 1 || from.primitives.empty())
        return std::nullopt;
    Mesh mesh = read_attributes(model, from.primitives[0].attributes);
    if (from.primitives.size() == 1 && from.primitives[0].mode == TINYGLTF_MODE_POINTS)
        return ReadMesh{std::move(mesh), {from.primitives[0].material}};
    std::vector<SlotTriangles> groups;
    for (size_t i = 0; i < from.primitives.size(); ++i) {
        const tinygltf::Primitive& primitive = from.primitives[i];
        if (primitive.mode != TINYGLTF_MODE_TRIANGLES || primitive.indices < 0 ||
            by_one_name(primitive.attributes) != by_one_name(from.primitives[0].attributes))
            return std::nullopt;
        groups.push_back({0, triangles_of(read_indices(model, primitive, mesh.positions.size()),
                                          primitive.mode)});
    }
    if (!mark.Has("slots")) {
        if (groups.size() != 1)
            return std::nullopt;
        mesh.triangles = std::move(groups[0].triangles);
        return ReadMesh{std::move(mesh), {from.primitives[0].material}};
    }
    const tinygltf::Value& slots = mark.Get("slots");
    if (!slots.IsArray() || slots.ArrayLen() != groups.size())
        return std::nullopt;
    std::vector<int> materials;
    for (size_t i = 0; i < groups.size(); ++i) {
        const tinygltf::Value& slot = slots.Get(static_cast<int>(i));
        if (!slot.IsInt() || slot.GetNumberAsInt() < 0 || slot.GetNumberAsInt() > 65535)
            return std::nullopt;
        groups[i].slot = static_cast<uint16_t>(slot.GetNumberAsInt());
        if (groups[i].slot >= materials.size())
            materials.resize(groups[i].slot + size_t{1}, -1);
        materials[groups[i].slot] = from.primitives[i].material;
    }
    std::vector<uint16_t> order;
    if (mark.Has("order")) {
        if (!mark.Get("order").IsInt())
            return std::nullopt;
        const AccessorElements elements(model, mark.Get("order").GetNumberAsInt(), 1);
        for (size_t i = 0; i < elements.count(); ++i)
            order.push_back(static_cast<uint16_t>(elements.index(i)));
    } else {
        for (const SlotTriangles& group : groups)
            order.insert(order.end(), group.triangles.size(), group.slot);
    }
    if (!reorder(groups, order, mesh))
        return std::nullopt;
    return ReadMesh{std::move(mesh), std::move(materials)};
}

}  // namespace

int add_mesh(tinygltf::Model& model, const Mesh& mesh, std::span<const SlotMaterial> materials,
             const std::string& name) {
    check(mesh);
    check_finite(mesh, name);
    if (mesh.positions.empty())
        return -1;
    tinygltf::Mesh out;
    out.name = name;
    tinygltf::Value::Object mark{{"version", tinygltf::Value(1)}};
    tinygltf::Primitive primitive;
    const Attributes attributes = add_attributes(model, mesh);
    const auto use = [&](const SlotMaterial& material) {
        primitive.material = material.index;
        primitive.attributes = attributes;
        if (auto colors = primitive.attributes.extract(kColors)) {
            colors.key() = material.vertex_colors ? kColors : kUnusedColors;
            primitive.attributes.insert(std::move(colors));
        }
    };
    use({});
    if (mesh.triangles.empty()) {
        primitive.mode = TINYGLTF_MODE_POINTS;
        out.primitives.push_back(primitive);
    }
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    tinygltf::Value::Array slots;
    std::vector<uint16_t> sorted;
    for (const SlotTriangles& group : groups_of(mesh)) {
        primitive.indices = add_indices(model, group.triangles, mesh.positions.size());
        use(group.slot < materials.size() ? materials[group.slot] : SlotMaterial{});
        slots.emplace_back(static_cast<int>(group.slot));
        sorted.insert(sorted.end(), group.triangles.size(), group.slot);
        out.primitives.push_back(primitive);
    }
    if (!mesh.slots.empty()) {
        mark["slots"] = tinygltf::Value(slots);
        if (sorted != mesh.slots)
            mark["order"] = tinygltf::Value(add_slots(model, mesh.slots));
    }
    out.extras =
        tinygltf::Value(tinygltf::Value::Object{{"lodestone", tinygltf::Value(std::move(mark))}});
    model.meshes.push_back(std::move(out));
    return static_cast<int>(model.meshes.size() - 1);
}

std::optional<ReadMesh> own_mesh(const tinygltf::Model& model, const tinygltf::Mesh& from) {
    if (!from.extras.Has("lodestone"))
        return std::nullopt;
    try {
        return try_own(model, from);
    } catch (const Error&) {
        return std::nullopt;
    }
}

ReadMesh foreign_mesh(const tinygltf::Model& model, const tinygltf::Mesh& from,
                      const std::string& name, GltfReadBudget& budget, Problems& problems) {
    ReadMesh out;
    std::map<int, uint16_t> slot_of;
    std::vector<Mesh> parts;
    std::map<Attributes, size_t> part_of;
    size_t not_triangles = 0;
    for (const tinygltf::Primitive& primitive : from.primitives) {
        if (primitive.mode < TINYGLTF_MODE_TRIANGLES ||
            primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
            ++not_triangles;
            continue;
        }
        try {
            check_draco(model, primitive);
            Attributes used;
            for (const char* attribute : {"POSITION", "NORMAL", "TEXCOORD_0", kColors}) {
                const auto found = primitive.attributes.find(attribute);
                if (found != primitive.attributes.end())
                    used.insert(*found);
            }
            auto part = part_of.find(used);
            if (part == part_of.end()) {
                if (used.contains("POSITION")) {
                    const size_t count = AccessorElements(model, used["POSITION"], 3).count();
                    if (count > budget.vertices)
                        fail(Status::BadFile, "the file shows the same data too often");
                    budget.vertices -= count;
                }
                parts.push_back(read_attributes(model, used));
                part = part_of.emplace(used, parts.size() - 1).first;
            }
            Mesh& mesh = parts[part->second];
            const size_t corners = primitive.indices < 0
                                       ? mesh.positions.size()
                                       : AccessorElements(model, primitive.indices, 1).count();
            if (corners > budget.triangles)
                fail(Status::BadFile, "the file shows the same data too often");
            budget.triangles -= corners;
            const std::vector<Triangle> triangles =
                triangles_of(read_indices(model, primitive, mesh.positions.size()), primitive.mode);
            const auto slot = slot_of.emplace(primitive.material, out.materials.size());
            if (slot.second) {
                if (out.materials.size() > 65534)
                    fail(Status::BadFile, "more than 65535 materials");
                out.materials.push_back(primitive.material);
            }
            mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
            mesh.slots.resize(mesh.triangles.size(), slot.first->second);
        } catch (const Error& e) {
            if (e.status != Status::BadFile)
                throw;
            problems.push_back({name, Severity::Error, "bad_primitive",
                                text("a part of the mesh was left out: ", e.what())});
        }
    }
    if (not_triangles > 0)
        problems.push_back({name, Severity::Warning, "not_triangles",
                            text(not_triangles, " parts made of points or lines were left out")});
    if (parts.size() == 1) {
        out.mesh = std::move(parts[0]);
    } else {
        for (const Mesh& part : parts)
            append(out.mesh, part, Affine{});
    }
    if (out.materials.size() < 2)
        out.mesh.slots.clear();
    return out;
}

}  // namespace lodestone::format
