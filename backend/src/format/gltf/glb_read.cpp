// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/gltf/glb.h"
#include "format/gltf/gltf_accessor.h"
#include "format/gltf/gltf_extensions.h"
#include "format/gltf/gltf_file.h"
#include "format/gltf/gltf_frame.h"
#include "format/gltf/gltf_material.h"
#include "format/gltf/gltf_mesh.h"
#include "format/gltf/gltf_meshopt.h"
#include "format/gltf/gltf_view.h"

#include <glm/gtc/quaternion.hpp>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>

namespace lodestone::format {
namespace {

// The most nodes one in another.
// Taste: a larger number reads files that nest deeper and needs more stack.
constexpr int kMostDepth = 256;

/// The transform of a node, in glTF's frame.
Affine transform_of(const tinygltf::Node& node) {
    Affine out;
    if (node.matrix.size() == 16) {
        const auto at = [&node](int column, int row) {
            return node.matrix[4 * static_cast<size_t>(column) + static_cast<size_t>(row)];
        };
        for (int column = 0; column < 3; ++column) {
            for (int row = 0; row < 3; ++row)
                out.linear[column][row] = at(column, row);
            out.offset[column] = at(3, column);
        }
        return out;
    }
    if (node.rotation.size() == 4) {
        const auto& r = node.rotation;
        const glm::dquat turn(r[3], r[0], r[1], r[2]);
        const double length = glm::length(turn);
        if (length > 0)
            out.linear = glm::mat3_cast(turn / length);
    }
    for (int i = 0; i < 3; ++i) {
        if (node.scale.size() == 3)
            out.linear[i] *= node.scale[static_cast<size_t>(i)];
        if (node.translation.size() == 3)
            out.offset[i] = node.translation[static_cast<size_t>(i)];
    }
    return out;
}

class GlbReader {
public:
    GlbReader(const tinygltf::Model& from, const std::filesystem::path& folder,
              const std::string& name, Problems& problems, size_t bytes)
        : from_(from), name_(name), problems_(problems), pictures_(from, folder, name, bytes) {
        // Meshes may share data, and a hostile file would share it a million times.
        budget_.vertices = budget_.triangles = (uint64_t{1} << 24u) + 4 * uint64_t{bytes};
    }

    Model read() {
        const std::vector<int> roots = scene_nodes();
        const std::vector<int> order = top_down(roots);
        model_.materials = read_materials(from_, pictures_, name_, problems_);
        object_of_mesh_.assign(from_.meshes.size(), kUnread);
        placements_.resize(from_.nodes.size());
        // Children before parents.
        for (size_t i = order.size(); i-- > 0;)
            read_node(order[i]);
        const auto own = [this](int node) {
            return placements_[static_cast<size_t>(node)].transform;
        };
        read_view(from_, order, own, model_, problems_);
        model_.root = add_group("gltf:scene", scene_name(), gather(roots));
        summarize_assemblies(model_, bottom_up(model_));
        return std::move(model_);
    }

private:
    // Law: an index that no object has, as kNoObject is taken.
    static constexpr ObjectIndex kUnread = kNoObject - 1;

    std::string scene_name() const {
        const size_t scene = from_.defaultScene < 0 ? 0 : static_cast<size_t>(from_.defaultScene);
        const bool named = scene < from_.scenes.size() && !from_.scenes[scene].name.empty();
        return named ? from_.scenes[scene].name : name_;
    }

    std::vector<int> scene_nodes() const {
        const size_t scene = from_.defaultScene < 0 ? 0 : static_cast<size_t>(from_.defaultScene);
        if (scene < from_.scenes.size())
            return from_.scenes[scene].nodes;
        std::vector<uint8_t> child(from_.nodes.size(), 0);
        for (const tinygltf::Node& node : from_.nodes) {
            for (const int index : node.children) {
                if (index >= 0 && static_cast<size_t>(index) < child.size())
                    child[static_cast<size_t>(index)] = 1;
            }
        }
        std::vector<int> roots;
        for (size_t i = 0; i < child.size(); ++i) {
            if (!child[i])
                roots.push_back(static_cast<int>(i));
        }
        return roots;
    }

    /// Parents before children. Every node has one parent at most, so there are no cycles.
    std::vector<int> top_down(const std::vector<int>& roots) const {
        std::vector<uint8_t> seen(from_.nodes.size(), 0);
        std::vector<int> order;
        std::vector<std::pair<int, int>> stack;  // node, depth
        const auto push = [&](int node, int depth) {
            if (node < 0 || static_cast<size_t>(node) >= seen.size())
                fail(Status::BadFile, "'", name_, "': node ", node, " of ", seen.size());
            if (seen[static_cast<size_t>(node)])
                fail(Status::BadFile, "'", name_, "': node ", node, " has two parents");
            if (depth > kMostDepth)
                fail(Status::BadFile, "'", name_, "': nodes are nested more than ", kMostDepth,
                     " deep");
            seen[static_cast<size_t>(node)] = 1;
            stack.emplace_back(node, depth);
        };
        for (const int root : roots)
            push(root, 1);
        while (!stack.empty()) {
            const auto [node, depth] = stack.back();
            stack.pop_back();
            order.push_back(node);
            for (const int child : from_.nodes[static_cast<size_t>(node)].children)
                push(child, depth + 1);
        }
        return order;
    }

    std::string node_name(int index) const {
        const std::string& name = from_.nodes[static_cast<size_t>(index)].name;
        return name.empty() ? text("node ", index) : name;
    }

    /// The placements that nodes became, in their order.
    std::vector<Placement> gather(const std::vector<int>& nodes) {
        std::vector<Placement> out;
        for (const int node : nodes) {
            Placement& placement = placements_[static_cast<size_t>(node)];
            if (placement.object != kNoObject)
                out.push_back(std::move(placement));
        }
        return out;
    }

    void read_node(int index) {
        const tinygltf::Node& node = from_.nodes[static_cast<size_t>(index)];
        Placement& placement = placements_[static_cast<size_t>(index)];
        placement.name = node_name(index);
        placement.transform = converted(transform_of(node), true);
        if (!placement.transform.finite()) {
            problems_.push_back({placement.name, Severity::Error, "bad_transform",
                                 "its transform is not finite; the identity is used"});
            placement.transform = Affine{};
        }
        if (node.extensions.contains("EXT_mesh_gpu_instancing"))
            problems_.push_back({placement.name, Severity::Warning, "instances_skipped",
                                 "EXT_mesh_gpu_instancing is not read: it is placed once"});
        const ObjectIndex mesh = object_of(node.mesh, placement.name);
        std::vector<Placement> children = gather(node.children);
        if (children.empty()) {
            placement.object = mesh;
            return;
        }
        if (mesh != kNoObject)
            children.insert(children.begin(), {mesh, Affine{}, model_.objects[mesh].name});
        placement.object =
            add_group(text("gltf:node:", index), placement.name, std::move(children));
    }

    ObjectIndex add_group(std::string uid, std::string name, std::vector<Placement> placements) {
        Object group;
        group.uid = std::move(uid);
        group.name = std::move(name);
        group.representations.emplace_back();
        group.representations[0].summary.kind = Kind::Assembly;
        group.representations[0].payload =
            std::make_shared<const Assembly>(Assembly{std::move(placements)});
        model_.objects.push_back(std::move(group));
        return static_cast<ObjectIndex>(model_.objects.size() - 1);
    }

    ObjectIndex object_of(int mesh, const std::string& node) {
        if (mesh < 0)
            return kNoObject;
        if (static_cast<size_t>(mesh) >= from_.meshes.size()) {
            problems_.push_back({node, Severity::Error, "bad_mesh",
                                 text("it names mesh ", mesh, " of ", from_.meshes.size())});
            return kNoObject;
        }
        ObjectIndex& known = object_of_mesh_[static_cast<size_t>(mesh)];
        if (known == kUnread)
            known = read_mesh(mesh, node);
        return known;
    }

    ObjectIndex read_mesh(int index, const std::string& node) {
        const tinygltf::Mesh& from = from_.meshes[static_cast<size_t>(index)];
        const std::string name = from.name.empty() ? node : from.name;
        Representation finest;
        std::optional<ReadMesh> read = own_mesh(from_, from);
        if (read && read->mesh.positions.size() <= budget_.vertices &&
            read->mesh.triangles.size() * 3 <= budget_.triangles) {
            budget_.vertices -= read->mesh.positions.size();
            budget_.triangles -= read->mesh.triangles.size() * 3;
        } else {
            read = foreign_mesh(from_, from, name, budget_, problems_);
        }
        auto mesh = std::make_shared<Mesh>(std::move(read->mesh));
        check(*mesh);
        repair(*mesh, name, problems_);
        if (mesh->empty()) {
            problems_.push_back(
                {name, Severity::Warning, "no_faces", "the mesh has no triangles; it is left out"});
            return kNoObject;
        }
        const auto standard = static_cast<uint32_t>(from_.materials.size());  // as read_materials()
        const bool colored = std::any_of(
            from.primitives.begin(), from.primitives.end(), [](const tinygltf::Primitive& p) {
                return p.material < 0 && p.attributes.contains("COLOR_0");
            });
        for (const int material : read->materials)
            finest.materials.push_back(material >= 0 && static_cast<uint32_t>(material) < standard
                                           ? static_cast<uint32_t>(material)
                                           : standard + (colored ? 1 : 0));
        finest.payload = std::shared_ptr<const Mesh>(std::move(mesh));
        summarize(finest, model_);
        Object object;
        object.uid = text("gltf:mesh:", index);
        object.name = name;
        object.representations.push_back(std::move(finest));
        model_.objects.push_back(std::move(object));
        return static_cast<ObjectIndex>(model_.objects.size() - 1);
    }

    const tinygltf::Model& from_;
    const std::string& name_;
    Problems& problems_;
    GltfPictureReader pictures_;
    GltfReadBudget budget_;
    Model model_;
    std::vector<ObjectIndex> object_of_mesh_;
    std::vector<Placement> placements_;
};

}  // namespace

Model read_glb(std::string_view bytes, const std::filesystem::path& folder, const std::string& name,
               Problems& problems) {
    tinygltf::Model from;
    load_gltf(from, bytes, folder, name);
    check_extensions(from, name);
    unpack_views(from, name);
    return GlbReader(from, folder, name, problems, bytes.size()).read();
}

}  // namespace lodestone::format
