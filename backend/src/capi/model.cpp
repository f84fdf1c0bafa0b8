// SPDX-License-Identifier: GPL-3.0-or-later
// The model's part of the C interface: making one, reading and writing files.
#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/pose.h"
#include "format/model_file.h"
#include "geometry/strand_tubes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <utility>

using namespace lodestone;
using namespace lodestone::capi;

namespace {

bool same(const float* a, const float* b, int count) {
    return std::equal(a, a + count, b);
}

/// One vertex for every distinct (position, normal, uv, color) that a corner uses.
Mesh mesh_of(const lds_mesh_view& view, size_t material_count) {
    if (view.vertex_count > 0)
        require(view.positions, "mesh.positions");
    if (view.triangle_count > 0)
        require(view.triangles, "mesh.triangles");
    const uint32_t* corners = view.corners != nullptr ? view.corners : view.triangles;
    const size_t corner_count = view.corners != nullptr ? view.corner_count : view.vertex_count;
    // Law: indices have 32 bits, and this leaves room for sums of two.
    constexpr size_t kMost = size_t{1} << 31u;
    if (view.vertex_count > kMost || view.triangle_count > kMost)
        fail(Status::InvalidArgument, "a mesh of ", view.vertex_count, " vertices and ",
             view.triangle_count, " triangles is larger than 2^31");
    for (size_t i = 0; i < view.triangle_count * 3; ++i) {
        if (view.triangles[i] >= view.vertex_count)
            fail(Status::InvalidArgument, "triangle ", i / 3, " uses vertex ", view.triangles[i],
                 " of ", view.vertex_count);
        if (corners[i] >= corner_count)
            fail(Status::InvalidArgument, "triangle ", i / 3, " uses corner ", corners[i], " of ",
                 corner_count);
    }
    Mesh mesh;
    const bool split = view.corner_normals != nullptr || view.corner_uvs != nullptr ||
                       view.corner_colors != nullptr;
    if (!split) {
        mesh.positions.resize(view.vertex_count);
        for (size_t i = 0; i < view.vertex_count; ++i)
            mesh.positions[i] = {view.positions[3 * i], view.positions[3 * i + 1],
                                 view.positions[3 * i + 2]};
    }
    // Chains of the vertices made so far from each position; almost always one or two long.
    constexpr uint32_t kEnd = ~uint32_t{0};
    // How many vertices at a position are compared with a new one, the last made first.
    // Taste: a larger number joins more vertices of a hostile mesh, in time in proportion.
    constexpr size_t kMostTries = 256;
    std::vector<uint32_t> first(split ? view.vertex_count : 0, kEnd);
    std::vector<uint32_t> next;
    std::vector<uint32_t> made_from;  // the corner a vertex was made from
    const auto vertex_of = [&](uint32_t position, uint32_t corner) {
        size_t tries = 0;
        for (uint32_t at = first[position]; at != kEnd && tries < kMostTries;
             at = next[at], ++tries) {
            const uint32_t other = made_from[at];
            if ((view.corner_normals == nullptr ||
                 same(view.corner_normals + 3 * size_t{corner},
                      view.corner_normals + 3 * size_t{other}, 3)) &&
                (view.corner_uvs == nullptr || same(view.corner_uvs + 2 * size_t{corner},
                                                    view.corner_uvs + 2 * size_t{other}, 2)) &&
                (view.corner_colors == nullptr || same(view.corner_colors + 4 * size_t{corner},
                                                       view.corner_colors + 4 * size_t{other}, 4)))
                return at;
        }
        const auto vertex = static_cast<uint32_t>(mesh.positions.size());
        const float* p = view.positions + 3 * size_t{position};
        mesh.positions.emplace_back(p[0], p[1], p[2]);
        if (view.corner_normals != nullptr) {
            const float* n = view.corner_normals + 3 * size_t{corner};
            mesh.normals.emplace_back(n[0], n[1], n[2]);
        }
        if (view.corner_uvs != nullptr) {
            const float* uv = view.corner_uvs + 2 * size_t{corner};
            mesh.uvs.emplace_back(uv[0], uv[1]);
        }
        if (view.corner_colors != nullptr) {
            const float* color = view.corner_colors + 4 * size_t{corner};
            mesh.colors.emplace_back(color[0], color[1], color[2], color[3]);
        }
        made_from.push_back(corner);
        next.push_back(first[position]);
        first[position] = vertex;
        return vertex;
    };
    mesh.triangles.reserve(view.triangle_count);
    for (size_t t = 0; t < view.triangle_count; ++t) {
        Triangle triangle;
        for (int c = 0; c < 3; ++c) {
            const uint32_t position = view.triangles[3 * t + static_cast<size_t>(c)];
            triangle[c] =
                split ? vertex_of(position, corners[3 * t + static_cast<size_t>(c)]) : position;
        }
        mesh.triangles.push_back(triangle);
    }
    if (view.slots != nullptr && material_count > 1) {
        const auto last = static_cast<int32_t>(std::min<size_t>(material_count, 65535)) - 1;
        mesh.slots.reserve(view.triangle_count);
        for (size_t t = 0; t < view.triangle_count; ++t)
            mesh.slots.push_back(static_cast<uint16_t>(std::clamp(view.slots[t], 0, last)));
    }
    return mesh;
}

/// One object with one mesh. Content-equal meshes share their memory; a build works once for all.
lds_object add_mesh_object(lds_model& model, const lds_object_info* info, Mesh&& mesh,
                           std::shared_ptr<const PosedSurface> pose, const uint32_t* materials,
                           size_t material_count) {
    Representation finest;
    finest.summary.kind = Kind::Mesh;
    for (size_t i = 0; i < material_count; ++i) {
        if (materials[i] >= model.model.materials.size())
            fail(Status::InvalidArgument, "slot ", i, " uses material ", materials[i], " of ",
                 model.model.materials.size());
        finest.materials.push_back(materials[i]);
    }
    repair(mesh, name_of(object_info(info).name), model.problems);
    if (finest.materials.empty()) {
        finest.materials.push_back(static_cast<uint32_t>(model.model.materials.size()));
        model.model.materials.emplace_back();
    }
    const Hash hash = hash_of(mesh);
    auto& held = model.meshes[hash];
    std::shared_ptr<const Mesh> made = held.lock();
    if (made == nullptr)
        held = made = std::make_shared<const Mesh>(std::move(mesh));
    finest.payload = std::move(made);
    summarize(finest, model.model, hash);
    const ObjectIndex index = add_object(model, info, std::move(finest));
    model.model.objects[index].pose = std::move(pose);
    return model.id_of(index);
}

Mesh mesh_of(const lds_strands_view& view, size_t material_count) {
    if (view.point_count > 0) {
        require(view.points, "strands.points");
        require(view.radii, "strands.radii");
    }
    if (view.strand_count > 0)
        require(view.counts, "strands.counts");
    // Law: indices have 32 bits, and this leaves room for sums of two.
    constexpr size_t kMost = size_t{1} << 31u;
    if (view.point_count > kMost || view.strand_count > kMost)
        fail(Status::InvalidArgument, view.strand_count, " strands of ", view.point_count,
             " points are more than 2^31");
    std::vector<glm::vec3> points(view.point_count);
    for (size_t i = 0; i < view.point_count; ++i)
        points[i] = {view.points[3 * i], view.points[3 * i + 1], view.points[3 * i + 2]};
    std::vector<uint16_t> slots;
    if (view.slots != nullptr && material_count > 1) {
        const auto last = static_cast<int32_t>(std::min<size_t>(material_count, 65535)) - 1;
        slots.reserve(view.strand_count);
        for (size_t i = 0; i < view.strand_count; ++i)
            slots.push_back(static_cast<uint16_t>(std::clamp(view.slots[i], 0, last)));
    }
    std::vector<glm::vec2> uvs;
    if (view.uvs != nullptr) {
        uvs.reserve(view.strand_count);
        for (size_t i = 0; i < view.strand_count; ++i)
            uvs.emplace_back(view.uvs[2 * i], view.uvs[2 * i + 1]);
    }
    return tubes_of(
        {points, {view.radii, view.point_count}, {view.counts, view.strand_count}, slots, uvs});
}

/// `make` gives the mesh and its pose, once the arguments are known to be there.
template <typename Make>
lds_status add_leaf(lds_model* model, const lds_object_info* info, const uint32_t* materials,
                    size_t material_count, lds_object* out_object, const Make& make) {
    return guard([&] {
        require(model, "model");
        require(out_object, "out_object");
        if (material_count > 0)
            require(materials, "materials");
        auto [mesh, pose] = make();
        *out_object = add_mesh_object(*model, info, std::move(mesh), std::move(pose), materials,
                                      material_count);
    });
}

}  // namespace

lds_object_info lodestone::capi::object_info(const lds_object_info* info) {
    return checked(info, "info");
}

ObjectIndex lodestone::capi::add_object(lds_model& model, const lds_object_info* info,
                                        Representation finest) {
    const lds_object_info given = object_info(info);
    Object object;
    object.uid = name_of(given.uid);
    object.name = name_of(given.name);
    if (object.uid.empty())
        fail(Status::InvalidArgument, "object '", object.name, "' has no uid");
    if (model.by_uid.count(object.uid) != 0)
        fail(Status::InvalidArgument, "uid '", object.uid, "' of object '", object.name,
             "' is taken");
    if (given.role < LDS_ROLE_AUTOMATIC || given.role > LDS_ROLE_ORDINARY)
        fail(Status::InvalidArgument, "role ", given.role, " of object '", object.name,
             "' is unknown");
    object.deforms = given.deforms != 0;
    object.role = static_cast<ObjectRole>(given.role);
    object.representations.push_back(std::move(finest));
    const auto index = static_cast<ObjectIndex>(model.model.objects.size());
    model.by_uid.emplace(object.uid, index);
    model.model.objects.push_back(std::move(object));
    model.summarized = false;
    return index;
}

lds_status lds_model_create(lds_model** out_model) {
    return guard([&] {
        require(out_model, "out_model");
        *out_model = new_model();
    });
}

void lds_model_destroy(lds_model* model) {
    delete model;
}

lds_status lds_model_read(const char* path, lds_model** out_model) {
    return guard([&] {
        require(path, "path");
        require(out_model, "out_model");
        std::unique_ptr<lds_model> model(new_model());
        const std::filesystem::path file(path);
        std::error_code error;
        if (file.filename() == "tileset.json" || std::filesystem::is_directory(file, error)) {
            model->store.emplace(file);
            const CostModel costs = model->model.costs;
            model->model = model->store->read();
            model->model.costs = costs;
            model->summarized = true;
        } else {
            const CostModel costs = model->model.costs;
            model->model = format::read_model(file, model->problems);
            set_costs(model->model, costs);
        }
        for (uint32_t i = 0; i < model->model.objects.size(); ++i)
            model->by_uid.emplace(model->model.objects[i].uid, i);
        *out_model = model.release();
    });
}

lds_status lds_model_write(lds_model* model, const char* path) {
    return guard([&] {
        require(model, "model");
        require(path, "path");
        model->load_finest();
        format::write_model(path, model->model);
    });
}

lds_status lds_model_add_mesh(lds_model* model, const lds_object_info* info,
                              const lds_mesh_view* mesh, const uint32_t* materials,
                              size_t material_count, lds_object* out_object) {
    return add_leaf(model, info, materials, material_count, out_object, [&] {
        const lds_mesh_view view = checked(mesh, "mesh");
        Mesh made = mesh_of(view, material_count);
        std::shared_ptr<const PosedSurface> pose =
            pose_of(view, object_info(info), made, material_count);
        return std::pair(std::move(made), std::move(pose));
    });
}

lds_status lds_model_add_faces(lds_model* model, const lds_object_info* info,
                               const lds_faces_view* faces, const uint32_t* materials,
                               size_t material_count, lds_object* out_object) {
    return add_leaf(model, info, materials, material_count, out_object, [&] {
        const PolygonMesh given = faces_of(faces);
        Mesh made = mesh_of(given, material_count);
        std::shared_ptr<const PosedSurface> pose =
            pose_of(given, object_info(info), made, material_count);
        return std::pair(std::move(made), std::move(pose));
    });
}

lds_status lds_model_add_strands(lds_model* model, const lds_object_info* info,
                                 const lds_strands_view* strands, const uint32_t* materials,
                                 size_t material_count, lds_object* out_object) {
    return add_leaf(model, info, materials, material_count, out_object, [&] {
        Mesh made = mesh_of(checked(strands, "strands"), material_count);
        std::shared_ptr<const PosedSurface> pose = pose_of(made, object_info(info), material_count);
        return std::pair(std::move(made), std::move(pose));
    });
}

lds_status lds_model_set_root(lds_model* model, lds_object root) {
    return guard([&] {
        require(model, "model");
        model->model.root = model->index_of(root);
        model->summarized = false;
    });
}
