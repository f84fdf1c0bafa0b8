// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/object_traits.h"

#include "base/color.h"
#include "base/parallel.h"
#include "measure/visible/surface_inertia.h"

#include <algorithm>
#include <cmath>

namespace lodestone::group {
namespace {

// The next four are differences that keep things apart as much as twice the area does.
//
// Display-encoded colors, in each channel.
// Taste: a larger value groups by place more than by color.
constexpr double kColorApart = 0.25;
/// Sizes, in factors of two.
/// Taste: a larger value groups by place more than by size.
constexpr double kSizeApart = 2.0;
/// A principal variance's share of all three.
/// Taste: a larger value groups by place more than by shape.
constexpr double kShapeApart = 0.5;
/// A variance's share along fixed axes.
/// Taste: a larger value groups by place more than by orientation.
constexpr double kTurnedApart = 0.7;

double encoded(double linear) {
    return encode_srgb(std::clamp(linear, 0.0, 1.0));
}

glm::dvec4 look_of(const Material& material) {
    const double opacity = material.alpha_mode == AlphaMode::Opaque ? 1.0 : material.alpha;
    const glm::dvec3 color = material.base_color + material.emission;
    glm::dvec4 look(encoded(color.x), encoded(color.y), encoded(color.z),
                    std::clamp(opacity * (1 - material.transmission), 0.0, 1.0));
    if (material.other)
        look += std::clamp(material.mix, 0.0, 1.0) * (look_of(*material.other) - look);
    for (int i = 0; i < 4; ++i)
        look[i] = std::isfinite(look[i]) ? look[i] : 0.0;
    return look;
}

/// The mean look of a mesh's triangles, by area.
glm::dvec4 mean_look(const Mesh& mesh, const Model& model, const Representation& finest) {
    std::vector<glm::dvec4> looks;
    for (const uint32_t material : finest.materials)
        looks.push_back(look_of(model.materials.at(material)));
    if (looks.empty())
        looks.push_back(look_of(Material{}));
    std::vector<double> areas(looks.size(), 0.0);
    double sum = 0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const double area = glm::length(area_vector(mesh, t));
        if (!std::isfinite(area))
            continue;
        areas[std::min<size_t>(mesh.slot(t), areas.size() - 1)] += area;
        sum += area;
    }
    glm::dvec4 mean(0.0);
    for (size_t i = 0; i < looks.size(); ++i)
        mean += looks[i] * (sum > 0 ? areas[i] / sum : 1.0 / static_cast<double>(looks.size()));
    return mean;
}

/// Sets the traits by the bound alone.
void set_from_bound(ObjectTraits& traits) {
    const glm::dvec3 size = traits.bound.box.size();
    traits.area = 2 * half_area(traits.bound.box);
    traits.center = traits.bound.box.center();
    for (int i = 0; i < 3; ++i)
        traits.spread[i][i] = size[i] * size[i] / 12;
}

void set_leaf(ObjectTraits& traits, const Model& model, const Object& object) {
    const Representation& finest = object.representations[0];
    const auto* held = std::get_if<std::shared_ptr<const Mesh>>(&finest.payload);
    if (held != nullptr && *held) {
        traits.look = mean_look(**held, model, finest);
        const measure::SurfaceInertia inertia = measure::inertia_of_mesh(**held);
        if (!inertia.empty()) {
            traits.area = inertia.area;
            traits.center = inertia.center;
            traits.spread = inertia.moments / inertia.area;
            return;
        }
    } else if (!finest.materials.empty()) {
        for (const uint32_t material : finest.materials)
            traits.look += look_of(model.materials.at(material)) /
                           static_cast<double>(finest.materials.size());
    }
    set_from_bound(traits);
}

/// The spread of a placed object. It is exact but for non-uniform stretches.
glm::dmat3 placed(const glm::dmat3& spread, const glm::dmat3& linear) {
    return linear * spread * glm::transpose(linear);
}

/// The factor by which a transform enlarges areas, on average over directions.
double area_scale(const glm::dmat3& linear) {
    return std::pow(std::abs(glm::determinant(linear)), 2.0 / 3);
}

void set_group(ObjectTraits& traits, const Assembly& assembly,
               const std::vector<ObjectTraits>& all) {
    glm::dvec3 moment(0.0);
    double area = 0;
    for (const Placement& placement : assembly.placements) {
        const ObjectTraits& child = all[placement.object];
        const double own = child.area * area_scale(placement.transform.linear);
        if (!(own > 0) || !std::isfinite(own))
            continue;
        area += own;
        moment += own * placement.transform(child.center);
        traits.look += own * child.look;
    }
    if (!(area > 0)) {
        set_from_bound(traits);
        return;
    }
    traits.area = area;
    traits.center = moment / area;
    traits.look /= area;
    for (const Placement& placement : assembly.placements) {
        const ObjectTraits& child = all[placement.object];
        const double own = child.area * area_scale(placement.transform.linear);
        if (!(own > 0) || !std::isfinite(own))
            continue;
        const glm::dvec3 off = placement.transform(child.center) - traits.center;
        traits.spread += (own / area) * (placed(child.spread, placement.transform.linear) +
                                         glm::outerProduct(off, off));
    }
}

bool finite(const glm::dmat3& matrix) {
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            if (!std::isfinite(matrix[i][k]))
                return false;
        }
    }
    return true;
}

/// Objects that lie one below the other, at most.
/// Taste: a larger value may overflow the stack of a thread.
constexpr int kDeepestModel = 10000;

/// Adds an object after all below it, each once.
void add_below(const Model& model, ObjectIndex index, std::vector<uint8_t>& seen,
               std::vector<ObjectIndex>& order, int depth) {
    if (seen[index] != 0)
        return;
    if (depth > kDeepestModel)
        fail(Status::InvalidArgument, "'", model.objects[index].name, "' is too deep in groups");
    seen[index] = 1;
    const Object& object = model.objects[index];
    if (object.group()) {
        for (const Placement& placement : object.representations[0].assembly().placements)
            add_below(model, placement.object, seen, order, depth + 1);
    }
    order.push_back(index);
}

}  // namespace

std::vector<ObjectTraits> traits_of(const Model& model, std::span<const ObjectIndex> groups,
                                    const Job& job) {
    std::vector<ObjectIndex> order;
    std::vector<uint8_t> seen(model.objects.size(), 0);
    for (const ObjectIndex group : groups)
        add_below(model, group, seen, order, 0);
    std::vector<ObjectTraits> all(model.objects.size());
    for (const ObjectIndex index : order) {
        const Object& object = model.objects[index];
        ObjectTraits& traits = all[index];
        traits.environment = object.role == ObjectRole::Environment;
        traits.never = object.deforms;
        if (object.representations.empty())
            continue;
        if (!object.group()) {
            traits.bound = object.bound();
            continue;
        }
        for (const Placement& placement : object.representations[0].assembly().placements) {
            const ObjectTraits& child = all[placement.object];
            traits.environment = traits.environment || child.environment;
            traits.never = traits.never || child.never || placement.hidden != 0;
            if (!child.bound.empty())
                traits.bound = merged(traits.bound, transformed(child.bound, placement.transform));
        }
    }
    std::vector<ObjectIndex> leaves;
    std::copy_if(order.begin(), order.end(), std::back_inserter(leaves), [&](ObjectIndex index) {
        return !model.objects[index].representations.empty() && !model.objects[index].group();
    });
    parallel_for(leaves.size(), [&](size_t i) {
        job.check();
        set_leaf(all[leaves[i]], model, model.objects[leaves[i]]);
    });
    for (const ObjectIndex index : order) {
        const Object& object = model.objects[index];
        if (object.group())
            set_group(all[index], object.representations[0].assembly(), all);
    }
    return all;
}

GroupingItem item_of(const ObjectTraits& traits, const Placement& placement) {
    GroupingItem item;
    item.box = transformed(traits.bound, placement.transform).box;
    const glm::dmat3 spread = placed(traits.spread, placement.transform.linear);
    const double total = trace(spread);
    const double size = std::sqrt(total);
    item.weight = size > 0 && std::isfinite(size) ? size : 1e-300;
    for (size_t i = 0; i < 4; ++i)
        item.features[i] = traits.look[static_cast<int>(i)] / kColorApart;
    if (!(total > 0) || !finite(spread))
        return item;
    const glm::dmat3 shares = spread / total;
    item.features[4] = std::log2(size) / kSizeApart;
    const SymmetricEigen eigen = eigen_symmetric(shares);
    size_t at = 5;
    for (int i = 0; i < 3; ++i)
        item.features[at++] = eigen.values[i] / kShapeApart;
    // An entry off the diagonal stands for two.
    // Law: the square root of 2.
    constexpr double kBothSides = 1.4142135623730951;
    for (int i = 0; i < 3; ++i) {
        for (int k = i; k < 3; ++k)
            item.features[at++] = shares[i][k] / kTurnedApart * (i == k ? 1.0 : kBothSides);
    }
    return item;
}

}  // namespace lodestone::group
