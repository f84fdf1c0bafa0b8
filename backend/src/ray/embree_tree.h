// SPDX-License-Identifier: GPL-3.0-or-later
// Embree's tree over one mesh, in the tree's own frame: the only file pair that sees Embree.
#pragma once

#include "ray/mesh_cover.h"
#include "ray/mesh_scene.h"

#include <string>

namespace lodestone::ray {

/// Empty when Embree 3.13 was found and passed its test of known answers, else why not. It is
/// looked for once per process.
const std::string& why_no_embree();
/// Throws Error(RaysUnavailable) with the reason when there is one.
void require_embree();

class EmbreeTree {
public:
    /// `positions` lie in the unit sphere or are not finite, and have one element more than there
    /// are: Embree loads 16 bytes at a time. With a cover, hits where nothing is do not count. All
    /// must outlive the tree. Throws Error(RaysUnavailable) or std::bad_alloc.
    EmbreeTree(const std::vector<glm::vec3>& positions, const std::vector<Triangle>& triangles,
               const MeshCover* cover);
    ~EmbreeTree();
    EmbreeTree(const EmbreeTree&) = delete;
    EmbreeTree& operator=(const EmbreeTree&) = delete;

    struct EmbreeHit {
        uint32_t triangle = kNoTriangle;  // among equally near ones the lowest
        double u = 0;
        double v = 0;
        double t = 0;
    };
    /// Directions have unit length.
    EmbreeHit first_hit(const glm::dvec3& origin, const glm::dvec3& direction, double far) const;
    bool occluded(const glm::dvec3& origin, const glm::dvec3& direction, double far) const;
    /// Some triangle that blocks a ray without end.
    uint32_t blocker(const glm::dvec3& origin, const glm::dvec3& direction) const;
    /// As MeshScene::list_crossed.
    size_t list_crossed(const glm::dvec3& origin, const glm::dvec3& direction, double far,
                        std::span<uint32_t> list) const;

private:
    void* scene_;
};

}  // namespace lodestone::ray
