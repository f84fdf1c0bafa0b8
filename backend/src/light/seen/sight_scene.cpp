// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/seen/sight_scene.h"

#include "base/parallel.h"
#include "light/clear_materials.h"
#include "light/seen/distinct_shapes.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <tuple>
#include <utility>

namespace lodestone::light {
namespace {

// The surfaces that a ray meets at most.
// Taste: a larger value finds things behind more leaves of a crown, which hide them.
constexpr size_t kMostCrossings = 64;
// The alpha from which on nothing is seen through a point.
// Law: half a step of 8 bits.
constexpr double kEnds = 1 - 0.5 / 255;

/// A material's alpha alone: what it transmits meets its surface first.
Material covering_material(Material material) {
    material.transmission = 0;
    if (material.other)
        material.other = std::make_shared<const Material>(covering_material(*material.other));
    return material;
}

bool transmits_any(const Material& material) {
    return material.transmission > 0 || (material.other && transmits_any(*material.other));
}

/// Whether a material sends rays on in directions that its normals alone do not tell.
bool bends_rays(const Material& material, bool mirrors) {
    const bool own = material.transmission > 0 || (mirrors && material.normal_texture) ||
                     (mirrors && material.bump_texture);
    return own || (material.other && bends_rays(*material.other, mirrors));
}

bool nearer(const SightCrossing& a, const SightCrossing& b) {
    return std::tie(a.way, a.drawn, a.triangle) < std::tie(b.way, b.drawn, b.triangle);
}

/// Keeps as many as a ray meets at most; returns the way to the last of them.
double keep_nearest(std::vector<SightCrossing>& all) {
    const auto last = all.begin() + static_cast<std::ptrdiff_t>(kMostCrossings) - 1;
    std::nth_element(all.begin(), last, all.end(), nearer);
    all.resize(kMostCrossings);
    return all.back().way;
}

}  // namespace

SightScene::SightShape SightScene::shape_of(const DrawnThing& thing) {
    const Representation& representation = *thing.representation;
    SightShape shape;
    if (representation.summary.kind == Kind::Mesh && representation.resident())
        shape.mesh = std::get<std::shared_ptr<const Mesh>>(representation.payload);
    else
        shape.mesh = std::make_shared<const Mesh>(tessellated(representation));
    std::vector<Material> materials;
    bool clear = false;
    for (const uint32_t index : representation.materials) {
        const Material covering = index < model_.materials.size()
                                      ? covering_material(model_.materials[index])
                                      : Material{};
        materials.push_back(clear_material(covering));
        clear = clear || lets_light_through(covering);
    }
    if (clear)
        shape.skin = std::make_shared<const ray::MeshSkin>(materials, *renderer_.texels);
    shape.scene = std::make_shared<const ray::MeshScene>(*shape.mesh, shape.skin);
    return shape;
}

SightScene::SightScene(const Model& model, const RendererSurfaces& renderer,
                       std::span<const DrawnThing> drawn, const Job& job)
    : model_(model), renderer_(renderer), drawn_(drawn) {
    for (size_t i = 0; i < model.materials.size(); ++i) {
        const Material& material = model.materials[i];
        bends_.push_back(bends_rays(material, renderer.reflections[i].may_mirror) ? 1 : 0);
        transmits_.push_back(transmits_any(material) ? 1 : 0);
    }
    DistinctShapes distinct = distinct_shapes(drawn);
    shape_of_ = std::move(distinct.of_thing);
    shapes_.resize(distinct.firsts.size());
    parallel_for(shapes_.size(), [&](size_t i) {
        job.check();
        shapes_[i] = shape_of(drawn[distinct.firsts[i]]);
    });
    for (uint32_t i = 0; i < drawn.size(); ++i) {
        const DrawnThing& thing = drawn[i];
        const Bound& bound = thing.representation->summary.bound;
        const SightShape& shape = shapes_[shape_of_[i]];
        if ((thing.hidden & kCameraRays) == 0 || (thing.hidden & kReflectionRays) == 0)
            seen_.add(shape.scene, bound, thing.world, i);
        if ((thing.hidden & kShadowRays) == 0)
            shading_.add(shape.scene, bound, thing.world, i);
    }
    seen_.finish();
    shading_.finish();
    // Rays have single precision.
    least_ = 1e-6 * glm::length(seen_.box().size());
}

void SightScene::cross(const SightWalk& walk, std::vector<SightCrossing>& out) const {
    out.clear();
    thread_local std::vector<ray::RayCrossing> met;  // rays are many, and memory is slow to get
    double end = walk.far;
    const auto visit = [&](const ray::MeshScene& mesh, uint32_t drawn, const glm::dvec3& origin,
                           const glm::dvec3& direction, double far) {
        if ((drawn_[drawn].hidden & walk.sees) != 0)
            return far;
        met.clear();
        mesh.list_crossings(
            origin, direction, far, kMostCrossings,
            [&](uint32_t triangle, double alpha) {
                return alpha >= kEnds && !transmits(drawn, triangle);
            },
            met);
        for (const ray::RayCrossing& one : met) {
            SightCrossing at;
            at.drawn = drawn;
            at.triangle = one.triangle;
            at.u = one.u;
            at.v = one.v;
            at.way = one.t;
            at.ends = one.ends;
            out.push_back(at);
            end = one.ends ? std::min(end, one.t) : end;
        }
        if (out.size() >= 2 * kMostCrossings)
            end = std::min(end, keep_nearest(out));
        return end;
    };
    const ray::PlacedScenes& scene = walk.sees == kShadowRays ? shading_ : seen_;
    scene.visit(walk.origin, walk.direction, walk.far, std::ref(visit));
    std::erase_if(out, [&](const SightCrossing& at) { return !(at.way <= end); });
    std::sort(out.begin(), out.end(), nearer);
    const auto last =
        std::find_if(out.begin(), out.end(), [](const SightCrossing& at) { return at.ends; });
    if (last != out.end())
        out.erase(last + 1, out.end());
    out.resize(std::min(out.size(), kMostCrossings));
    for (SightCrossing& at : out) {
        at.point = walk.origin + at.way * walk.direction;
        at.way += walk.way;
        const size_t material = material_of(at.drawn, at.triangle);
        at.mirrors = material < bends_.size() && renderer_.reflections[material].may_mirror;
        at.bends = material < bends_.size() && bends_[material] != 0;
    }
}

size_t SightScene::material_of(uint32_t drawn, uint32_t triangle) const {
    const uint16_t slot = mesh(drawn).slot(triangle);
    const std::vector<uint32_t>& materials = drawn_[drawn].representation->materials;
    return slot < materials.size() ? materials[slot] : bends_.size();
}

bool SightScene::transmits(uint32_t drawn, uint32_t triangle) const {
    const size_t material = material_of(drawn, triangle);
    return material < transmits_.size() && transmits_[material] != 0;
}

}  // namespace lodestone::light
