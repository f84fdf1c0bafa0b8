// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text.h"
#include "format/gltf/glb.h"
#include "format/gltf/gltf_file.h"
#include "format/gltf/gltf_frame.h"
#include "format/gltf/gltf_material.h"
#include "format/gltf/gltf_mesh.h"

#include <glm/gtc/quaternion.hpp>
#include <tiny_gltf.h>

#include <array>
#include <cmath>

namespace lodestone::format {
namespace {

// Taste: a larger number writes larger scenes, in memory in proportion.
constexpr size_t kMostNodes = size_t{1} << 22u;

class GlbWriter {
public:
    explicit GlbWriter(const Model& from) : from_(from), materials_(out_, true) {}

    std::string write() {
        bottom_up(from_);  // refuses cycles
        out_.asset.version = "2.0";
        out_.asset.generator = "Lodestone";
        out_.scenes.emplace_back();
        out_.defaultScene = 0;
        mesh_of_.assign(from_.objects.size(), kUnwritten);
        material_of_.assign(from_.materials.size(), {-1, -1});
        if (from_.root != kNoObject)
            write_root();
        return save_glb(out_);
    }

private:
    // Law: a mesh's index is 0 or more, and -1 is that of none.
    static constexpr int kUnwritten = -2;

    void write_root() {
        const Object& root = from_.objects[from_.root];
        out_.scenes[0].name = valid_utf8(root.name);
        if (!root.group()) {
            out_.scenes[0].nodes.push_back(add_node({from_.root, Affine{}, root.name}));
            return;
        }
        struct PendingGroup {
            ObjectIndex group;
            int node;  // -1: the scene itself
        };
        std::vector<PendingGroup> stack{{from_.root, -1}};
        while (!stack.empty()) {
            const PendingGroup entry = stack.back();
            stack.pop_back();
            const Assembly& assembly = from_.objects[entry.group].representations[0].assembly();
            for (const Placement& placement : assembly.placements) {
                const int node = add_node(placement);
                if (entry.node < 0)
                    out_.scenes[0].nodes.push_back(node);
                else
                    out_.nodes[static_cast<size_t>(entry.node)].children.push_back(node);
                if (from_.objects[placement.object].group())
                    stack.push_back({placement.object, last_});
            }
        }
    }

    /// Returns the node; last_ is the one that children and mesh belong to.
    int add_node(const Placement& placement) {
        if (out_.nodes.size() + 2 > kMostNodes)
            fail(Status::InvalidArgument, "a GLB of more than ", kMostNodes,
                 " nodes is not written; export it with shared groups (3D Tiles)");
        if (!placement.transform.finite())
            fail(Status::InvalidArgument, "placement '", placement.name,
                 "' has a transform that is not finite");
        const Object& object = from_.objects[placement.object];
        const int first = static_cast<int>(out_.nodes.size());
        tinygltf::Node node;
        node.name = valid_utf8(placement.name.empty() ? object.name : placement.name);
        if (node.name.empty())
            node.name = "node";  // tinygltf writes a node without anything as null
        const Affine transform = converted(placement.transform, false);
        if (rectangular(transform.linear)) {
            set_matrix(node, transform);
            out_.nodes.push_back(std::move(node));
        } else {
            add_sheared(std::move(node), transform);
        }
        last_ = static_cast<int>(out_.nodes.size() - 1);
        if (!object.group())
            out_.nodes.back().mesh = mesh_index(placement.object);
        return first;
    }

    /// Whether the columns are orthogonal and not 0: a rotation (or mirror) and scales, as glTF
    /// demands.
    static bool rectangular(const glm::dmat3& m) {
        // The most by which the cosine of two columns may differ from 0.
        // Taste: a larger value writes more matrices as rotations, and is off by as much.
        constexpr double kTolerance = 1e-5;
        for (int i = 0; i < 3; ++i) {
            const int k = (i + 1) % 3;
            const double lengths = glm::length(m[i]) * glm::length(m[k]);
            if (!(lengths > 0) || std::abs(glm::dot(m[i], m[k])) > kTolerance * lengths)
                return false;
        }
        return true;
    }

    static void set_matrix(tinygltf::Node& node, const Affine& transform) {
        if (transform.linear == glm::dmat3(1.0) && transform.offset == glm::dvec3(0.0))
            return;
        for (int column = 0; column < 3; ++column) {
            for (int row = 0; row < 3; ++row)
                node.matrix.push_back(transform.linear[column][row]);
            node.matrix.push_back(0);
        }
        for (int row = 0; row < 3; ++row)
            node.matrix.push_back(transform.offset[row]);
        node.matrix.push_back(1);
    }

    static std::vector<double> quaternion_of(const glm::dmat3& turn) {
        const glm::dquat q = glm::normalize(glm::quat_cast(turn));
        return {q.x, q.y, q.z, q.w};
    }

    /// M = (M V) V^T with the eigenvectors V of M^T M: a rotation inside a rotation with scales.
    void add_sheared(tinygltf::Node outer, const Affine& transform) {
        const glm::dmat3& m = transform.linear;
        const glm::dmat3 v = eigen_symmetric(glm::transpose(m) * m).axes;
        const glm::dmat3 turned = m * v;
        glm::dmat3 axes(1.0);
        const double largest = glm::length(turned[0]);  // eigenvalues descend
        if (largest > 0) {
            axes[0] = turned[0] / largest;
            const double second = glm::length(turned[1]);
            const glm::dvec3 other =
                std::abs(axes[0].x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
            glm::dvec3 next =
                second > 1e-12 * largest ? turned[1] / second : glm::cross(axes[0], other);
            next -= glm::dot(next, axes[0]) * axes[0];
            axes[1] = glm::normalize(next);
            axes[2] = glm::cross(axes[0], axes[1]);
        }
        outer.translation = {transform.offset.x, transform.offset.y, transform.offset.z};
        outer.rotation = quaternion_of(axes);
        for (int i = 0; i < 3; ++i)
            outer.scale.push_back(glm::dot(axes[i], turned[i]));
        tinygltf::Node inner;
        inner.name = outer.name;
        inner.rotation = quaternion_of(glm::transpose(v));
        outer.children.push_back(static_cast<int>(out_.nodes.size() + 1));
        out_.nodes.push_back(std::move(outer));
        out_.nodes.push_back(std::move(inner));
    }

    int mesh_index(ObjectIndex index) {
        int& known = mesh_of_[index];
        if (known != kUnwritten)
            return known;
        const Object& object = from_.objects[index];
        known = -1;
        if (object.representations.empty())
            return known;
        const Representation& finest = object.representations[0];
        Mesh triangles;
        if (finest.summary.kind != Kind::Mesh)
            triangles = tessellated(finest, 3);
        const Mesh& mesh = finest.summary.kind == Kind::Mesh ? finest.mesh() : triangles;
        if (mesh.empty())
            return known;
        std::vector<SlotMaterial> materials;
        for (const uint32_t material : finest.materials)
            materials.push_back(slot_material(material, !mesh.uvs.empty()));
        known = add_mesh(out_, mesh, materials, valid_utf8(object.name));
        return known;
    }

    SlotMaterial slot_material(uint32_t material, bool uvs) {
        if (material >= from_.materials.size())
            fail(Status::InvalidArgument, "material ", material, " of ", from_.materials.size());
        const Material& from = from_.materials[material];
        int& known = material_of_[material][uvs && textured(from) ? 1 : 0];
        if (known < 0)
            known = materials_.add(from, uvs);
        return {known, from.vertex_colors};
    }

    const Model& from_;
    tinygltf::Model out_;
    MaterialWriter materials_;
    std::vector<int> mesh_of_;
    std::vector<std::array<int, 2>> material_of_;  // for meshes without and with uvs
    int last_ = -1;
};

}  // namespace

std::string write_glb(const Model& model) {
    return GlbWriter(model).write();
}

}  // namespace lodestone::format
