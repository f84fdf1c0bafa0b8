// SPDX-License-Identifier: GPL-3.0-or-later
// GlassRays: follows rays of pictures through what refracts them.
#pragma once

#include "ray/mesh_scene.h"

#include <optional>

namespace lodestone::measure {

/// Unit, towards the viewer: of the vertices' normals where the mesh has them.
glm::dvec3 normal_at(const Mesh& mesh, const ray::RayHit& hit, const glm::dvec3& viewer);

/// Of one mesh in its scene; nothing is clear without a skin that transmits.
class GlassRays {
public:
    /// Keeps references. `lift`: how far behind a surface a ray starts anew, metres.
    GlassRays(const Mesh& mesh, const ray::SkinPtr& skin, const ray::MeshScene& scene, double lift);

    /// What throws shadows.
    const ray::MeshScene& opaque() const { return rest_ ? *rest_ : scene_; }

    /// The first thing that is met behind any glass; `along` becomes the direction of the ray as it
    /// gets there.
    ray::RayHit first_hit(glm::dvec3 from, glm::dvec3& along) const;

private:
    bool clear(uint32_t triangle) const;
    void bend(const ray::RayHit& hit, glm::dvec3& along) const;

    const Mesh& mesh_;
    const ray::SkinPtr& skin_;
    const ray::MeshScene& scene_;
    double lift_;
    std::optional<ray::MeshScene> rest_;  // without the glass; none where there is none
};

}  // namespace lodestone::measure
