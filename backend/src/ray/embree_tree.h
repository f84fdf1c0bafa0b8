// SPDX-License-Identifier: GPL-3.0-or-later
// EmbreeTree: Embree's tree over one mesh, in the tree's own frame; no other file pair sees Embree.
#pragma once

#include "ray/mesh_cover.h"
#include "ray/mesh_scene.h"

#include <string>
#include <vector>

namespace lodestone::ray {

/// The reason why there is no Embree; empty when Embree 3.13 was found and passed its test of known
/// answers. The library is looked for once per process.
const std::string& why_no_embree();
/// Throws Error(RaysUnavailable) with that reason when there is one.
void require_embree();

/// The tree of one mesh. Const methods may be called from any thread.
class EmbreeTree {
public:
    /// `positions` lie in the unit sphere or are not finite, and have one element more than the
    /// mesh has vertices: Embree loads 16 bytes at a time. With a cover, hits where nothing is do
    /// not count. All three must outlive the tree. Throws Error(RaysUnavailable) or std::bad_alloc.
    EmbreeTree(const std::vector<glm::vec3>& positions, const std::vector<Triangle>& triangles,
               const MeshCover* cover);
    ~EmbreeTree();
    EmbreeTree(const EmbreeTree&) = delete;
    EmbreeTree& operator=(const EmbreeTree&) = delete;

    /// The first hit of a ray.
    struct EmbreeHit {
        uint32_t triangle = kNoTriangle;  // the lowest of equally near ones
        double u = 0;
        double v = 0;
        double t = 0;
    };
    /// The first hit within `far`, and whether there is any. Directions have unit length.
    EmbreeHit first_hit(const glm::dvec3& origin, const glm::dvec3& direction, double far) const;
    bool occluded(const glm::dvec3& origin, const glm::dvec3& direction, double far) const;
    /// Some triangle that blocks a ray without end; kNoTriangle: none does.
    uint32_t blocker(const glm::dvec3& origin, const glm::dvec3& direction) const;
    /// Lists crossings like MeshScene::list_crossings(), with `t` in the tree's own frame.
    void list_crossings(const glm::dvec3& origin, const glm::dvec3& direction, double far,
                        size_t most, const EndsRay& ends, std::vector<RayCrossing>& out) const;

private:
    void* scene_;
};

}  // namespace lodestone::ray
