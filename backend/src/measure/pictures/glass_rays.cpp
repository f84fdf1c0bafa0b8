// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/pictures/glass_rays.h"

#include "measure/visible/visible_sampler.h"

#include <algorithm>
#include <cmath>

namespace lodestone::measure {

glm::dvec3 normal_at(const Mesh& mesh, const ray::RayHit& hit, const glm::dvec3& viewer) {
    const Triangle& t = mesh.triangles[hit.triangle];
    glm::dvec3 flat = area_vector(mesh, hit.triangle);
    if (glm::dot(flat, viewer) < 0)
        flat = -flat;
    glm::dvec3 normal = flat;
    if (!mesh.normals.empty()) {
        normal = (1 - hit.u - hit.v) * glm::dvec3(mesh.normals[t.x]) +
                 hit.u * glm::dvec3(mesh.normals[t.y]) + hit.v * glm::dvec3(mesh.normals[t.z]);
        if (glm::dot(normal, flat) < 0)
            normal = -normal;
    }
    const double length = glm::length(normal);
    return length > 0 && std::isfinite(length) ? normal / length : viewer;
}

GlassRays::GlassRays(const Mesh& mesh, const ray::SkinPtr& skin, const ray::MeshScene& scene,
                     double lift)
    : mesh_(mesh), skin_(skin), scene_(scene), lift_(lift) {
    if (!skin || !skin->transmits())
        return;
    std::vector<uint8_t> keep(mesh.triangles.size(), 0);
    for (uint32_t i = 0; i < keep.size(); ++i)
        keep[i] = clear(i) ? 0 : 1;
    if (std::find(keep.begin(), keep.end(), 0) != keep.end())
        rest_.emplace(subset(mesh, keep), skin);
}

ray::RayHit GlassRays::first_hit(glm::dvec3 from, glm::dvec3& along) const {
    // Surfaces of glass that a ray passes at most.
    // Taste: a larger value shows lamps behind more panes, for more rays through each.
    constexpr int kMostSurfaces = 8;
    ray::RayHit hit = scene_.first_hit(from, along);
    for (int i = 0; rest_ && hit.hit && clear(hit.triangle); ++i) {
        if (i == kMostSurfaces)
            return {};
        bend(hit, along);
        from = hit.point + lift_ * along;
        hit = scene_.first_hit(from, along);
    }
    return hit;
}

bool GlassRays::clear(uint32_t triangle) const {
    // Glass is clear where less than this share is covered and more than it is transmitted.
    // Taste: a larger value lets rays pass through frosted or colored glass, too.
    constexpr double kClear = 0.5;
    return skin_->opacity(mesh_, triangle, 1.0 / 3, 1.0 / 3) < kClear &&
           skin_->material(mesh_.slot(triangle)).transmission > kClear;
}

void GlassRays::bend(const ray::RayHit& hit, glm::dvec3& along) const {
    const bool enters = glm::dot(area_vector(mesh_, hit.triangle), along) < 0;
    const glm::dvec3 normal = normal_at(mesh_, hit, -along);
    const double ior = std::max(skin_->material(mesh_.slot(hit.triangle)).ior, 0.1);
    const glm::dvec3 inside = glm::refract(along, normal, enters ? 1 / ior : ior);
    // Where no light gets out, all of it is reflected.
    along = glm::dot(inside, inside) > 0.5 ? glm::normalize(inside)
                                           : glm::normalize(glm::reflect(along, normal));
}

}  // namespace lodestone::measure
