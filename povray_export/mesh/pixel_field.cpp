// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/pixel_field.h"

#include "choose/criterion.h"
#include "geometry/closest_on_triangle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace lodestone::povray {
namespace {

/// The least radius, in parts of the distance, of a thing whose parts are looked at one by one.
/// Taste: the near side of others is less than an eighth finer than the far one.
constexpr double kNear = 1.0 / 16;

}  // namespace

PixelField::PixelField(const Model& model, const View& view) : view_(view) {
    if (view.modifiers.off_screen != OffScreen::Full && view.pixel_error > 0)
        off_screen_.emplace(model, view);
}

double PixelField::at(const Bound& bound, double z) const {
    return choose::pixel_size(view_, z) * (off_screen_ ? off_screen_->coarser(bound, z) : 1);
}

DetailBandsPtr PixelField::bands(const Mesh& mesh, const Affine& world, const Bound& all) const {
    if (all.radius < kNear * distance(all, view_.camera.position))
        return nullptr;
    const auto corner = [&](uint32_t vertex) { return world(glm::dvec3(mesh.positions[vertex])); };
    return std::make_shared<const DetailBands>(mesh, [&](const Bound& part,
                                                         std::span<const uint32_t> triangles) {
        const Bound bound = transformed(part, world);
        const glm::dvec3& eye = view_.camera.position;
        double z = distance(bound, eye);
        // Boxes of large triangles are nearer than these are.
        if (z < bound.radius) {
            z = std::numeric_limits<double>::infinity();
            for (const uint32_t i : triangles) {
                const Triangle& t = mesh.triangles[i];
                const glm::dvec3 point =
                    geometry::closest_on_triangle(eye, corner(t.x), corner(t.y), corner(t.z)).point;
                z = std::min(z, glm::length(point - eye));
            }
        }
        return at(bound, z);
    });
}

bool PixelField::only_shadows(const Bound& bound) const {
    return off_screen_ && off_screen_->only_shadows(bound);
}

}  // namespace lodestone::povray
