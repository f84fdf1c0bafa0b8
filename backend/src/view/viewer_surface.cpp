// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/viewer_surface.h"

#include "base/parallel.h"
#include "model/primitive.h"
#include "view/shown_mesh.h"

#include <algorithm>
#include <cmath>

namespace lodestone::view {
namespace {

uint32_t level_within(const Object& object, uint32_t lod, uint64_t limit, uint64_t& triangles) {
    for (size_t i = lod; i < object.representations.size(); ++i) {
        const RepresentationSummary& summary = object.representations[i].summary;
        triangles = shown_triangles(summary);
        if (summary.kind != Kind::Assembly && triangles <= limit)
            return static_cast<uint32_t>(i);
    }
    triangles = kBoxTriangles;
    return kBoxOnly;
}

Mesh box_of(const Bound& bound) {
    Primitive box;
    if (!bound.box.empty()) {
        box.center = bound.box.center();
        box.half_size = 0.5 * bound.box.size();
    }
    return tessellate_box(box);
}

Mesh shown(const Object& object, uint32_t lod) {
    if (lod == kBoxOnly)
        return box_of(object.bound());
    return shown_mesh(object.representations.at(lod));
}

}  // namespace

std::vector<uint32_t> surface_levels(const Model& model, const choose::Cut& cut,
                                     uint64_t most_triangles) {
    std::vector<uint32_t> levels(cut.chosen.size());
    for (uint64_t limit = std::max(most_triangles, kBoxTriangles);; limit /= 2) {
        uint64_t total = 0;
        for (size_t i = 0; i < levels.size(); ++i) {
            const choose::CutNode& node = cut.nodes.at(cut.chosen[i]);
            uint64_t triangles = 0;
            levels[i] = level_within(model.objects.at(node.object), node.lod, limit, triangles);
            total += triangles;
        }
        if (total <= most_triangles || limit <= kBoxTriangles)
            return levels;
    }
}

ViewerSurface surface_of(const Model& model, const choose::Cut& cut,
                         const std::vector<uint32_t>& levels, const Job& job) {
    if (levels.size() != cut.chosen.size())
        fail(Status::InvalidArgument, levels.size(), " levels for ", cut.chosen.size(),
             " chosen occurrences");
    std::vector<std::vector<glm::vec3>> parts(levels.size());
    parallel_for(levels.size(), [&](size_t i) {
        job.check();
        const choose::CutNode& node = cut.nodes.at(cut.chosen[i]);
        if ((node.hidden & kCameraRays) != 0)
            return;
        const Affine& world = cut.world(node);
        const Mesh mesh = shown(model.objects.at(node.object), levels[i]);
        parts[i].reserve(3 * mesh.triangles.size());
        for (const Triangle& triangle : mesh.triangles) {
            for (int corner = 0; corner < 3; ++corner)
                parts[i].emplace_back(world(glm::dvec3(mesh.positions.at(triangle[corner]))));
        }
    });
    ViewerSurface surface;
    size_t corners = 0;
    for (const std::vector<glm::vec3>& part : parts)
        corners += part.size();
    surface.corners.reserve(corners);
    surface.owners.reserve(corners / 3);
    for (size_t i = 0; i < parts.size(); ++i) {
        surface.corners.insert(surface.corners.end(), parts[i].begin(), parts[i].end());
        surface.owners.insert(surface.owners.end(), parts[i].size() / 3, static_cast<uint32_t>(i));
        parts[i] = {};
    }
    return surface;
}

double shade_of(const glm::vec3* corners) {
    const glm::dvec3 light = glm::normalize(glm::dvec3(0.35, -0.25, 0.9));
    const glm::dvec3 normal = glm::cross(glm::dvec3(corners[1]) - glm::dvec3(corners[0]),
                                         glm::dvec3(corners[2]) - glm::dvec3(corners[0]));
    const double length = glm::length(normal);
    if (!(length > 0) || !std::isfinite(length))
        return 1;
    return 0.55 + 0.45 * std::abs(glm::dot(normal, light) / length);
}

}  // namespace lodestone::view
