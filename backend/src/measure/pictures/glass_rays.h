// SPDX-License-Identifier: GPL-3.0-or-later
// GlassRays: rays of pictures that are followed through everything that refracts them.
#pragma once

#include "ray/mesh_scene.h"

#include <optional>

namespace lodestone::measure {

/// The unit normal at a hit, on the side of the viewer: interpolated from the vertices' normals
/// where the mesh has them.
glm::dvec3 normal_at(const Mesh& mesh, const ray::RayHit& hit, const glm::dvec3& viewer);

/// The rays of one mesh in its scene; nothing is clear without a skin that transmits.
class GlassRays {
public:
    /// Keeps references. `lift` is the distance behind a surface at which a ray starts anew, in
    /// metres.
    GlassRays(const Mesh& mesh, const ray::SkinPtr& skin, const ray::MeshScene& scene, double lift);

    /// The scene of everything that throws shadows.
    const ray::MeshScene& opaque() const { return rest_ ? *rest_ : scene_; }

    /// The first hit behind any glass; `along` becomes the direction of the ray as it gets there.
    ray::RayHit first_hit(glm::dvec3 from, glm::dvec3& along) const;

private:
    bool clear(uint32_t triangle) const;
    void bend(const ray::RayHit& hit, glm::dvec3& along) const;

    const Mesh& mesh_;
    const ray::SkinPtr& skin_;
    const ray::MeshScene& scene_;
    double lift_;
    /// The scene without the glass; empty where there is no glass.
    std::optional<ray::MeshScene> rest_;
};

}  // namespace lodestone::measure
