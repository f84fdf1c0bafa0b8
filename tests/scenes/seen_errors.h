// SPDX-License-Identifier: GPL-3.0-or-later
// Seen errors: how far a level is from the finest where an eye sees it from as near as it is used.
#pragma once

#include "base/parallel.h"
#include "hierarchy/flattened_group.h"
#include "hierarchy/run/stand_in_surroundings.h"
#include "measure/pictures/cube_views.h"
#include "ray/mesh_scene.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace lodestone::seen {

/// A picture of so many pixels is as wide as it is far from the eye.
inline constexpr double kPixelAt1m = 1.0 / 1000;
inline constexpr double kQuantile = 0.999;

/// A level, or the finest: a group's with everything below it.
struct Surface {
    Mesh mesh;
    std::vector<Material> materials;
    double error = 0;  // of what it is made of
    ray::SkinPtr skin;
    std::unique_ptr<ray::MeshScene> scene;
};

struct Eye {
    glm::dvec3 position;
    glm::dvec3 forward, right, up;
    double reach = 1;  // the tangent of half of the picture's angle
};

struct Seen {
    double quantile = 0;  // metres
    double largest = 0;
    double share = 0;  // of pixels that are farther off than the error
    size_t pixels = 0;
};

/// The eye in a direction from the middle of the bound, at a distance from the bound as the cut
/// counts it.
inline Eye eye_at(const Bound& bound, const glm::dvec3& direction, double z) {
    double near = 0;
    double far = 2 * bound.radius + 2 * z;
    for (int i = 0; i < 60; ++i) {
        const double middle = (near + far) / 2;
        (distance(bound, bound.center + middle * direction) < z ? near : far) = middle;
    }
    Eye eye;
    eye.position = bound.center + far * direction;
    eye.forward = -direction;
    const glm::dvec3 side = std::abs(direction.z) > 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    eye.right = glm::normalize(glm::cross(eye.forward, side));
    eye.up = glm::cross(eye.right, eye.forward);
    const double sine = std::min(0.9, bound.radius / std::max(far, 1e-12));
    eye.reach = sine / std::sqrt(1 - sine * sine);
    return eye;
}

inline glm::dvec3 ray_of(const Eye& eye, int side, int column, int row) {
    const double x = (2 * (column + 0.5) / side - 1) * eye.reach;
    const double y = (1 - 2 * (row + 0.5) / side) * eye.reach;
    return eye.forward + x * eye.right + y * eye.up;
}

/// How far what a pixel shows is from the other surface; below 0: it shows nothing. Exact above
/// `enough`.
inline std::vector<double> distances(const Eye& eye, const Surface& seen, const Surface& other,
                                     int side, double enough) {
    std::vector<double> out(static_cast<size_t>(side) * static_cast<size_t>(side), -1);
    parallel_for(static_cast<size_t>(side), [&](size_t row) {
        const ray::FlushDenormals burst;
        uint32_t last = ray::kNoTriangle;
        for (int column = 0; column < side; ++column) {
            const ray::RayHit hit = seen.scene->first_hit(
                eye.position, ray_of(eye, side, column, static_cast<int>(row)));
            if (!hit.hit)
                continue;
            const ray::ClosestPoint closest = other.scene->closest_point(
                hit.point, std::numeric_limits<double>::infinity(), last, enough);
            last = closest.triangle;
            out[row * static_cast<size_t>(side) + static_cast<size_t>(column)] = closest.distance;
        }
    });
    return out;
}

inline Seen seen_from(const Eye& eye, const Surface& finest, const Surface& level, int side,
                      double error) {
    const std::vector<double> there = distances(eye, finest, level, side, error);
    const std::vector<double> back = distances(eye, level, finest, side, error);
    std::vector<double> far;
    for (size_t i = 0; i < there.size(); ++i) {
        const double pixel = std::max(there[i], back[i]);
        if (pixel >= 0)
            far.push_back(pixel);
    }
    Seen out;
    out.pixels = far.size();
    if (far.empty())
        return out;
    std::sort(far.begin(), far.end());
    const auto at = static_cast<size_t>(kQuantile * static_cast<double>(far.size() - 1));
    out.quantile = far[at];
    out.largest = far.back();
    const auto above = std::upper_bound(far.begin(), far.end(), error);
    out.share = static_cast<double>(far.end() - above) / static_cast<double>(far.size());
    return out;
}

/// The pixels that tell a quantile.
inline constexpr double kEnoughPixels = 2000;

/// What is seen from the worst of all directions, at the nearest place from which a pixel is as
/// large as the error, in pictures of `side` pixels and up to four times as many, where a thing is
/// thin.
inline Seen seen_worst(const Bound& bound, const Surface& finest, const Surface& level, int side,
                       double error, size_t* direction = nullptr) {
    const std::vector<glm::dvec3> all = measure::cube_directions();
    Seen out;
    for (size_t i = 0; i < all.size(); ++i) {
        const Eye eye = eye_at(bound, all[i], error / kPixelAt1m);
        Seen seen = seen_from(eye, finest, level, side, error);
        const double more =
            std::sqrt(kEnoughPixels / static_cast<double>(std::max<size_t>(1, seen.pixels)));
        if (seen.pixels > 0 && more > 1)
            seen = seen_from(eye, finest, level,
                             static_cast<int>(std::ceil(std::min(more, 4.0) * side)), error);
        if (i > 0 && !(seen.quantile > out.quantile))
            continue;
        out = seen;
        if (direction != nullptr)
            *direction = i;
    }
    return out;
}

/// Makes the surfaces of a model's objects. The model must last.
class Surfaces {
public:
    Surfaces(const Model& model, hierarchy::MeshSource source)
        : model_(model), source_(std::move(source)), uses_(hierarchy::uses_of(model)) {}

    /// A group of more than `most` triangles is made of children with a small error.
    Surface finest(ObjectIndex index, uint64_t most) {
        const Object& object = model_.objects[index];
        const Representation& finest = object.representations[0];
        if (!object.group())
            return made_of(*source_(finest), finest);
        hierarchy::OpenedGroup group(model_, index, uses_);
        const double error =
            object.representations.size() > 1 ? object.representations[1].summary.error : 0;
        const double within = finest.summary.cost.triangles > most ? error / 16 : 0;
        hierarchy::FlattenedGroup flat = hierarchy::flatten_group(group, within, source_, {});
        Surface out;
        out.mesh = std::move(flat.mesh);
        out.materials = std::move(flat.materials);
        out.error = flat.child_error;
        ready(out);
        return out;
    }

    Surface level(ObjectIndex index, size_t lod) {
        constexpr int kSubdivisions = 4;  // of an ellipsoid: 5,120 triangles
        const Representation& level = model_.objects[index].representations[lod];
        return made_of(
            level.summary.kind == Kind::Mesh ? *source_(level) : tessellated(level, kSubdivisions),
            level);
    }

private:
    Surface made_of(Mesh mesh, const Representation& level) {
        Surface out;
        out.mesh = std::move(mesh);
        for (const uint32_t material : level.materials)
            out.materials.push_back(model_.materials[material]);
        ready(out);
        return out;
    }

    void ready(Surface& surface) {
        if (surface.materials.empty())
            surface.materials.emplace_back();
        surface.skin = std::make_shared<const ray::MeshSkin>(surface.materials, texels_);
        surface.scene = std::make_unique<ray::MeshScene>(surface.mesh, surface.skin);
    }

    const Model& model_;
    hierarchy::MeshSource source_;
    std::vector<uint64_t> uses_;
    image::TexelCache texels_;
};

}  // namespace lodestone::seen
