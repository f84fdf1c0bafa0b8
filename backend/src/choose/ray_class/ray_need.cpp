// SPDX-License-Identifier: GPL-3.0-or-later
#include "choose/ray_class/ray_need.h"

#include "choose/criterion.h"
#include "choose/ray_class/bound_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::choose {
namespace {

/// The least width of a lamp's surface as seen from somewhere, in metres.
double least_width(const Light& light, const glm::dvec3& from) {
    if (light.kind != LightKind::Area)
        return 2 * std::max(0.0, light.radius);
    const glm::dvec3 ray = glm::normalize(light.position - from);
    const glm::dvec3 u = light.edge_u - glm::dot(light.edge_u, ray) * ray;
    const glm::dvec3 v = light.edge_v - glm::dot(light.edge_v, ray) * ray;
    // The width of a parallelogram is its area over its longer side; its ellipse is no narrower
    // than this
    const double both = std::sqrt(glm::dot(u, u) + glm::dot(v, v));
    return both > 0 ? glm::length(glm::cross(u, v)) / both : 0;
}

double half_size(const Light& light) {
    return light.kind == LightKind::Area
               ? 0.5 * (glm::length(light.edge_u) + glm::length(light.edge_v))
               : std::max(0.0, light.radius);
}

bool bumpy(const Material& material) {
    const Material* part = &material;
    for (int depth = 0; part != nullptr && depth < 64; ++depth, part = part->other.get()) {
        if (part->normal_texture || part->bump_texture)
            return true;
    }
    return false;
}

/// Whether it shows only images of things that are in front of it.
bool reflects_only(const Model& model, const Representation& representation) {
    return std::all_of(
        representation.materials.begin(), representation.materials.end(), [&](uint32_t index) {
            const Material* part = &model.materials.at(index);
            for (int depth = 0; part != nullptr && depth < 64; ++depth, part = part->other.get()) {
                if (part->transmission > 0)
                    return false;
            }
            return !bumpy(model.materials.at(index));
        });
}

}  // namespace

RayShape shape_of(const Representation& mesh, const Representation* solid) {
    RayShape shape;
    if (mesh.summary.kind != Kind::Mesh)
        return shape;
    shape.convexity = measure::convexity_of(mesh.mesh());
    if (solid == nullptr || !shape.convexity.convex)
        return shape;
    const bool box = solid->summary.kind == Kind::Box;
    shape.inside = measure::inside(mesh.mesh(), solid->primitive(), box);
    shape.around = measure::around(mesh.mesh(), solid->primitive(), box);
    return shape;
}

RayNeed::RayNeed(const Model& model, const View& view, const Cut& cut,
                 const std::vector<Bound>& bounds)
    : model_(model),
      view_(view),
      cut_(cut),
      pyramid_(view),
      scene_(bounds.empty() ? Box3{} : bounds[0].box) {
    for (const uint32_t index : cut.chosen) {
        const CutNode& node = cut.nodes[index];
        const Representation& drawn = model.objects.at(node.object).representations.at(node.lod);
        if ((node.hidden & kCameraRays) != 0 || pyramid_.outside(bounds[index]))
            continue;
        const double away = distance(bounds[index], view.camera.position);
        const double share = imaged_share(imaged_share(model, drawn), view, bounds[index], away);
        if (share > kLeastImaged)
            mirrors_.push_back({index, bounds[index], away, std::min(1.0, share), false});
    }
}

void RayNeed::find_shapes(const ShapeOf& shape_of) {
    shapes_known_ = true;
    for (PictureMirror& mirror : mirrors_) {
        const CutNode& node = cut_.nodes[mirror.node];
        const Representation& drawn = model_.objects[node.object].representations[node.lod];
        if (!reflects_only(model_, drawn))
            continue;
        mirror.flat =
            std::holds_alternative<Primitive>(drawn.payload) ||
            (drawn.summary.kind == Kind::Mesh && shape_of(drawn, nullptr).convexity.flattens);
    }
}

RayNeed::ShadowEdge RayNeed::shadow(const Bound& bound,
                                    const std::function<double(const SweptBall&)>& clear_of) const {
    ShadowEdge least{kInfinity, kInfinity};
    if (model_.world.environment)  // light comes from everywhere
        return {};
    const glm::dvec3& eye = view_.camera.position;
    for (const Light& light : model_.lights) {
        if (!casts_shadows(light))
            continue;
        const ShadowReach reach =
            shadow_reach(light, bound, mirrored() ? nullptr : &pyramid_, scene_, eye);
        if (!reach.seen)
            continue;
        const bool sun = light.kind == LightKind::Sun;
        const double size = sun ? 0 : half_size(light);
        const double nearest = reach.away - bound.radius - size;
        if (!(nearest > 0))
            return {};
        const double farthest = reach.away + bound.radius + size;
        const double clear = clear_of(reach.sweep);
        const double behind = std::max(clear, reach.last + bound.radius);
        const double pixel = pixel_size(view_, reach.z);
        const double sharp = pixel / (1 + behind / nearest);
        // The width of the soft edge for each metre behind the thing
        const double softens = sun ? 2 * std::tan(0.5 * std::clamp(light.angle, 0.0, 3.0))
                                   : least_width(light, bound.center) / farthest;
        // An edge of this width, moved by k <= width: the square of the change is less than k^2 /
        // width
        const auto soft = [&](double way) {
            return std::sqrt(pixel * softens * way / view_.pixel_error) / (1 + way / nearest);
        };
        least.sharp = std::min(least.sharp, sharp);
        least.any = std::min(least.any, std::max(sharp, std::min(soft(clear), soft(behind))));
    }
    return least;
}

double RayNeed::image(const Bound& bound, const ShapeOf& shape_of) {
    if (!shapes_known_)
        find_shapes(shape_of);
    const double z = distance(bound, view_.camera.position);
    double least = kInfinity;
    for (const PictureMirror& mirror : mirrors_) {
        const double gap = std::max(0.0, distance(bound, mirror.bound));
        const double way = mirror.flat ? std::max(z, mirror.away + gap) : z;
        least = std::min(least, pixel_size(view_, way) / std::sqrt(mirror.share));
    }
    return least;
}

}  // namespace lodestone::choose
