// SPDX-License-Identifier: GPL-3.0-or-later
#include "build/flatten.h"

#include "quality/cut.h"

#include <cmath>
#include <limits>
#include <map>

namespace lodestone::build {
namespace {

constexpr uint64_t kTrianglesOfBox = 12;
constexpr int kSubdivisions = 1;  // an ellipsoid drawn with 80 triangles
constexpr uint64_t kTrianglesOfEllipsoid = 80;

/// A view in which a representation is good enough when its error is at most `error`.
View view_within(double error) {
    View view;
    view.camera.orthographic = true;
    view.camera.right = {1, 0, 0};
    view.camera.up = {0, 1, 0};
    view.width = view.height = 1;
    view.pixel_error = error;
    return view;
}

uint64_t triangles_of(const Model& model, const quality::Cut& cut) {
    uint64_t triangles = cut.triangles;
    for (const uint32_t index : cut.chosen) {
        const quality::Node& node = cut.nodes[index];
        const Kind kind = model.objects[node.object].representations[node.lod].summary.kind;
        if (kind == Kind::Box)
            triangles += kTrianglesOfBox;
        else if (kind == Kind::Ellipsoid)
            triangles += kTrianglesOfEllipsoid;
        else if (kind == Kind::Composite)  // mostly ellipsoids
            triangles +=
                model.objects[node.object].representations[node.lod].composite().solids.size() *
                kTrianglesOfEllipsoid;
    }
    return triangles;
}

/// What a material shows on a mesh without texture coordinates: joined with one that has them, the
/// mesh gets some too, but they mean nothing.
Material without_textures(Material material) {
    for_own_textures(material, [](Texture& texture) { texture = Texture{}; });
    if (material.other)
        material.other = std::make_shared<const Material>(without_textures(*material.other));
    return material;
}

}  // namespace

Flat flatten(const Model& model, ObjectIndex group, double error, const MeshSource& source,
             const Job& job) {
    Flat flat;
    const quality::Cut cut = quality::choose_below(model, group, view_within(error), job);
    std::map<std::pair<uint32_t, bool>, uint16_t> slots;  // by material, and whether it is plain
    const auto slot_of = [&](uint32_t index, bool has_uvs) {
        const Material& material = model.materials.at(index);
        const bool plain = !has_uvs && textured(material);
        const auto [at, fresh] =
            slots.try_emplace({index, plain}, static_cast<uint16_t>(slots.size()));
        if (fresh)
            flat.materials.push_back(plain ? without_textures(material) : material);
        return at->second;
    };
    for (const uint32_t index : cut.chosen) {
        job.check();
        const quality::Node& node = cut.nodes[index];
        const Object& object = model.objects[node.object];
        const Representation& representation = object.representations[node.lod];
        flat.child_error =
            std::max(flat.child_error, representation.summary.error * stretch(node.world));
        Mesh part = representation.summary.kind == Kind::Mesh
                        ? *source(representation)
                        : tessellated(representation, kSubdivisions);
        part.slots.resize(part.triangles.size(), 0);
        std::vector<uint16_t> moved;
        for (const uint32_t material : representation.materials) {
            if (slots.size() >= std::numeric_limits<uint16_t>::max())
                fail(Status::InvalidArgument, "group '", model.objects[group].name,
                     "' uses more than 65535 materials");
            moved.push_back(slot_of(material, !part.uvs.empty()));
        }
        for (uint16_t& slot : part.slots)
            slot = slot < moved.size() ? moved[slot] : uint16_t{0};
        append(flat.mesh, part, node.world);
        flat.occurrence.resize(flat.mesh.triangles.size(), static_cast<uint32_t>(flat.occurrences));
        ++flat.occurrences;
    }
    if (flat.materials.empty())
        flat.materials.emplace_back();
    return flat;
}

double error_for_triangles(const Model& model, ObjectIndex group, uint64_t wanted, uint64_t most,
                           const Job& job) {
    // What is larger than this part of the size is not fine: what is measured against it would look
    // as far off. And what saves little is not worth an error: a roof of boxes stays one.
    constexpr int kLastFine = -5;
    constexpr int kLast = 2;
    const double size = model.objects[group].bound().radius;
    const auto triangles_at = [&](double error) {
        return triangles_of(model, quality::choose_below(model, group, view_within(error), job));
    };
    uint64_t enough = std::max(wanted, triangles_at(std::ldexp(size, kLastFine)) * 5 / 4);
    if (enough > most)
        enough = std::max(most, triangles_at(std::ldexp(size, kLast)));
    double error = 0;
    for (int power = -12; triangles_at(error) > enough && power <= kLast; ++power)
        error = std::ldexp(size, power);
    return error;
}

std::vector<uint64_t> uses_of(const Model& model) {
    std::vector<uint64_t> uses(model.objects.size(), 0);
    std::vector<ObjectIndex> order = bottom_up(model);
    if (!order.empty())
        uses[model.root] = 1;
    for (auto at = order.rbegin(); at != order.rend(); ++at) {
        const Object& object = model.objects[*at];
        if (!object.group())
            continue;
        for (const Placement& placement : object.representations[0].assembly().placements)
            uses[placement.object] += uses[*at];
    }
    return uses;
}

double bytes_within(const Model& model, ObjectIndex group, double error,
                    const std::vector<uint64_t>& uses, const Job& job) {
    const quality::Cut cut = quality::choose_below(model, group, view_within(error), job);
    double bytes = 0;
    for (const uint32_t index : cut.chosen) {
        const quality::Node& node = cut.nodes[index];
        const Summary& summary = model.objects[node.object].representations[node.lod].summary;
        bytes += static_cast<double>(kBytesPerOccurrence) +
                 bytes_each(summary.kind, summary.cost.bytes, uses[node.object]);
    }
    return bytes;
}

}  // namespace lodestone::build
