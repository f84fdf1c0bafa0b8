// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/sky/sky_scene.h"

#include "base/parallel.h"
#include "light/clear_materials.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lodestone::light {
namespace {

// The subdivisions of an ellipsoid.
// Taste: a larger value draws rounder outlines, for four times the triangles each.
constexpr int kSubdivisions = 3;

bool meets_back(const Mesh& mesh, uint32_t triangle, const glm::dvec3& direction) {
    return glm::dot(area_vector(mesh, triangle), direction) > 0;
}

}  // namespace

Mesh drawn_mesh(const Representation& representation) {
    return representation.summary.kind == Kind::Ellipsoid
               ? tessellated(representation, kSubdivisions)
               : tessellated(representation);
}

bool fits(const Representation& representation, const SkyShares& shares) {
    if (!representation.resident())
        return false;
    if (representation.summary.kind == Kind::Mesh)
        return fits(representation.mesh(), shares);
    return fits(drawn_mesh(representation), shares);
}

uint64_t drawn_triangles(const Representation& representation) {
    const RepresentationSummary& summary = representation.summary;
    if (summary.kind == Kind::Mesh)
        return summary.cost.triangles;
    return summary.kind == Kind::Ellipsoid ? uint64_t{20} << (2 * kSubdivisions)
                                           : solid_triangles(summary.kind, representation.payload);
}

SkySurface SkySurfaces::made(const Representation& representation) const {
    SkySurface out;
    if (representation.summary.kind == Kind::Mesh && representation.resident())
        out.mesh = std::get<std::shared_ptr<const Mesh>>(representation.payload);
    else
        out.mesh = std::make_shared<const Mesh>(drawn_mesh(representation));
    double area = 0;
    out.areas.reserve(out.mesh->triangles.size());
    for (size_t i = 0; i < out.mesh->triangles.size(); ++i) {
        const double own = glm::length(area_vector(*out.mesh, i));
        out.areas.push_back(area += std::isfinite(own) ? own : 0);
    }
    for (const uint32_t index : representation.materials) {
        const Material* material =
            index < model_.materials.size() ? &model_.materials[index] : nullptr;
        const bool clear = material != nullptr && lets_light_through(*material);
        out.see_through.push_back(clear ? 1 : 0);
        out.materials.push_back(index);
        out.masks.push_back(clear && material->alpha_texture ? material->alpha_texture.picture->hash
                                                             : Hash{0});
    }
    return out;
}

std::shared_ptr<const ray::MeshScene> SkySurfaces::scene_of(const SkySurface& surface) const {
    ray::SkinPtr skin;
    if (std::find(surface.see_through.begin(), surface.see_through.end(), uint8_t{1}) !=
        surface.see_through.end()) {
        std::vector<Material> materials;
        for (const uint32_t index : surface.materials)
            materials.push_back(index < model_.materials.size()
                                    ? clear_material(model_.materials[index])
                                    : Material{});
        skin = std::make_shared<const ray::MeshSkin>(materials, *texels_);
    }
    return std::make_shared<const ray::MeshScene>(*surface.mesh, std::move(skin));
}

ray::SkinPtr SkySurfaces::skin_of_model() const {
    return skin_;
}

void SkySurfaces::add(std::span<const Representation* const> representations, const Job& job) {
    add_meshes(representations, job);
    std::vector<SkySurface*> bare;
    for (const Representation* representation : representations) {
        SkySurface& surface = known_.at(representation->summary.hash);
        if (!surface.scene)
            bare.push_back(&surface);
    }
    std::sort(bare.begin(), bare.end());
    bare.erase(std::unique(bare.begin(), bare.end()), bare.end());
    parallel_for(bare.size(), [&](size_t i) {
        job.check();
        bare[i]->scene = scene_of(*bare[i]);
    });
}

void SkySurfaces::add_meshes(std::span<const Representation* const> representations,
                             const Job& job) {
    std::vector<std::pair<const Representation*, SkySurface*>> fresh;
    for (const Representation* representation : representations) {
        const auto [at, is_new] = known_.try_emplace(representation->summary.hash);
        if (is_new)
            fresh.emplace_back(representation, &at->second);
    }
    parallel_for(fresh.size(), [&](size_t i) {
        job.check();
        *fresh[i].second = made(*fresh[i].first);
    });
    if (skin_ || std::none_of(model_.materials.begin(), model_.materials.end(), lets_light_through))
        return;
    std::vector<Material> materials;
    for (const Material& material : model_.materials)
        materials.push_back(clear_material(material));
    skin_ = std::make_shared<const ray::MeshSkin>(materials, *texels_);
}

void SkyScene::join(const SkyOccluder& occluder, const SkySurface& surface) {
    const Mesh& mesh = *surface.mesh;
    const bool mirrored = glm::determinant(occluder.world.linear) < 0;
    for (JoinedMesh* joined : {&opaque_, &clear_}) {
        const bool clear = joined == &clear_;
        Mesh& all = joined->mesh;
        std::vector<uint32_t> numbers(mesh.positions.size(), ~uint32_t{0});
        for (size_t i = 0; i < mesh.triangles.size(); ++i) {
            const uint16_t slot = mesh.slot(i);
            if (surface.opaque_slot(slot) == clear)
                continue;
            Triangle t = mesh.triangles[i];
            if (mirrored)
                std::swap(t.y, t.z);
            for (int corner = 0; corner < 3; ++corner) {
                const uint32_t vertex = t[corner];
                if (numbers[vertex] == ~uint32_t{0}) {
                    numbers[vertex] = static_cast<uint32_t>(all.positions.size());
                    all.positions.emplace_back(occluder.world(glm::dvec3(mesh.positions[vertex])) -
                                               origin_);
                    if (clear) {
                        all.uvs.push_back(mesh.uvs.empty() ? glm::vec2(0.0f) : mesh.uvs[vertex]);
                        all.colors.push_back(mesh.colors.empty() ? glm::vec4(1.0f)
                                                                 : mesh.colors[vertex]);
                    }
                }
                t[corner] = numbers[vertex];
            }
            all.triangles.push_back(t);
            if (clear)
                all.slots.push_back(static_cast<uint16_t>(surface.materials[slot]));
        }
    }
}

SkyScene::SkyScene(const Model& model, SkySurfaces& surfaces,
                   std::span<const SkyOccluder> occluders, const Job& job, uint64_t most_joined)
    : occluders_(occluders) {
    std::unordered_map<Hash, uint64_t> counts;
    for (const SkyOccluder& occluder : occluders)
        ++counts[occluder.representation->summary.hash];
    // Meshes that are placed seldom are joined first.
    std::vector<std::pair<uint64_t, uint32_t>> order;
    order.reserve(occluders.size());
    std::array<std::vector<double>, 3> centers;
    for (uint32_t i = 0; i < occluders.size(); ++i) {
        const RepresentationSummary& summary = occluders[i].representation->summary;
        surfaces_.push_back(&surfaces.of(*occluders[i].representation));
        order.emplace_back(counts[summary.hash], i);
        if (summary.bound.empty() || !occluders[i].world.finite())
            continue;
        const glm::dvec3 center = transformed(summary.bound, occluders[i].world).box.center();
        for (int axis = 0; axis < 3 && finite(center); ++axis)
            centers[static_cast<size_t>(axis)].push_back(center[axis]);
    }
    std::sort(order.begin(), order.end());
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double>& all = centers[static_cast<size_t>(axis)];
        if (all.empty())
            continue;
        const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
        std::nth_element(all.begin(), middle, all.end());
        origin_[axis] = *middle;
    }
    uint64_t triangles = 0;
    std::vector<uint32_t> apart;
    // Slots have 16 bits.
    const bool materials_fit = model.materials.size() < 0xffffu;
    for (const auto& [count, i] : order) {
        const SkyOccluder& occluder = occluders[i];
        const SkySurface& surface = *surfaces_[i];
        if ((i & 255u) == 0)
            job.check();
        // Coordinates of the joined mesh have single precision.
        const bool fits =
            occluder.world.finite() && largest(glm::abs(occluder.world.offset)) < 1e30;
        triangles += surface.mesh->triangles.size();
        if (fits && triangles <= most_joined && (materials_fit || surface.see_through.empty()))
            join(occluder, surface);
        else
            apart.push_back(i);
    }
    std::vector<const Representation*> needed;
    for (const uint32_t i : apart)
        needed.push_back(occluders[i].representation);
    surfaces.add(needed, job);
    for (const uint32_t i : apart)
        placed_.add(surfaces_[i]->scene, occluders[i].representation->summary.bound,
                    occluders[i].world, i);
    placed_.finish();
    if (!opaque_.mesh.triangles.empty())
        opaque_.scene.emplace(opaque_.mesh);
    if (!clear_.mesh.triangles.empty())
        clear_.scene.emplace(clear_.mesh, surfaces.skin_of_model());
}

SkyScene::SkyBlock SkyScene::first_block(const glm::dvec3& from, const glm::dvec3& direction,
                                         double far) const {
    SkyBlock out;
    if (opaque_.scene) {
        const ray::RayHit hit = opaque_.scene->first_hit(from - origin_, direction, far);
        if (hit.hit)
            out = {hit.t, meets_back(opaque_.mesh, hit.triangle, direction)};
    }
    const ray::PlacedScenes::PlacedHit hit =
        placed_.first_hit(from, direction, std::min(far, out.t));
    if (!hit.hit)
        return out;
    // A mirrored placement keeps what is outside outside.
    const SkySurface& surface = *surfaces_[hit.name];
    const glm::dvec3 own = glm::inverse(occluders_[hit.name].world.linear) * direction;
    return {hit.t, surface.opaque_slot(surface.mesh->slot(hit.triangle)) &&
                       meets_back(*surface.mesh, hit.triangle, own)};
}

SkyScene::SkyBlock first_block(const SkySurface& surface, const glm::dvec3& from,
                               const glm::dvec3& direction, double far) {
    const ray::RayHit hit = surface.scene->first_hit(from, direction, far);
    if (!hit.hit)
        return {};
    return {hit.t, surface.opaque_slot(surface.mesh->slot(hit.triangle)) &&
                       meets_back(*surface.mesh, hit.triangle, direction)};
}

}  // namespace lodestone::light
