// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/seen/sight_scene.h"

#include "base/parallel.h"
#include "light/clear_materials.h"
#include "light/seen/distinct_shapes.h"

#include <algorithm>
#include <utility>

namespace lodestone::light {
namespace {

// The surfaces that a ray meets at most.
// Taste: a larger value finds things behind more leaves of a crown, which hide them.
constexpr int kMostSteps = 64;
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

bool transmits(const Material& material) {
    return material.transmission > 0 || (material.other && transmits(*material.other));
}

/// Whether a material sends rays on in directions that its normals alone do not tell.
bool bends_rays(const Material& material, bool mirrors) {
    const bool own = material.transmission > 0 || (mirrors && material.normal_texture) ||
                     (mirrors && material.bump_texture);
    return own || (material.other && bends_rays(*material.other, mirrors));
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
        transmits_.push_back(transmits(material) ? 1 : 0);
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

bool SightScene::step(SightWalk& walk, SightCrossing& out) const {
    const ray::PlacedScenes& scene = walk.sees == kShadowRays ? shading_ : seen_;
    while (walk.steps < kMostSteps && walk.far > 0) {
        const ray::PlacedScenes::PlacedHit hit =
            scene.first_hit(walk.origin, walk.direction, walk.far);
        if (!hit.hit)
            return false;
        ++walk.steps;
        const DrawnThing& thing = drawn_[hit.name];
        const SightShape& shape = shapes_[shape_of_[hit.name]];
        const bool again = hit.name == walk.last_drawn && hit.triangle == walk.last_triangle;
        walk.last_drawn = hit.name;
        walk.last_triangle = hit.triangle;
        const double onward = hit.t + (again ? 1 : kBehind) * aside(walk.way + hit.t);
        out.point = walk.origin + hit.t * walk.direction;
        out.way = walk.way + hit.t;
        walk.origin += onward * walk.direction;
        walk.way += onward;
        walk.far -= onward;
        if (again || (thing.hidden & walk.sees) != 0)
            continue;
        out.drawn = hit.name;
        out.triangle = hit.triangle;
        out.u = hit.u;
        out.v = hit.v;
        out.ends =
            !shape.skin || shape.skin->alpha(*shape.mesh, hit.triangle, hit.u, hit.v) >= kEnds;
        const uint16_t slot = shape.mesh->slot(hit.triangle);
        const std::vector<uint32_t>& materials = thing.representation->materials;
        const size_t material = slot < materials.size() ? materials[slot] : bends_.size();
        const bool known = material < bends_.size();
        out.mirrors = known && renderer_.reflections[material].may_mirror;
        out.ends = out.ends && !(known && transmits_[material] != 0);
        out.bends = known && bends_[material] != 0;
        return true;
    }
    return false;
}

}  // namespace lodestone::light
