// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of what a cut draws, by rays: parallel ones, under a sun with shadows and an even sky.
#pragma once

#include "base/parallel.h"
#include "choose/cut.h"
#include "image/image.h"
#include "measure/pictures/glass_rays.h"
#include "ray/mesh_scene.h"
#include "segment/store.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <map>
#include <memory>
#include <vector>

namespace lodestone::bench {

/// All that a cut draws as one mesh, and its materials by slot.
struct DrawnMesh {
    Mesh mesh;
    std::vector<Material> materials;
};

inline DrawnMesh drawn_mesh(const Model& model, const choose::Cut& cut,
                            const segment::Store& store) {
    DrawnMesh out;
    std::map<uint32_t, uint16_t> slots;  // by material of the model
    std::map<const Representation*, Mesh> parts;
    for (const uint32_t index : cut.chosen) {
        const choose::CutNode& node = cut.nodes[index];
        const Representation& drawn = model.objects[node.object].representations[node.lod];
        auto known = parts.find(&drawn);
        if (known == parts.end()) {
            Representation loaded = drawn;
            if (!loaded.resident())
                store.load(loaded);
            Mesh part = tessellated(loaded);
            part.slots.resize(part.triangles.size(), 0);
            part.colors.resize(part.positions.size(), glm::vec4(1.0f));
            for (uint16_t& slot : part.slots) {
                const uint32_t material = drawn.materials.at(slot);
                const auto [at, fresh] =
                    slots.try_emplace(material, static_cast<uint16_t>(out.materials.size()));
                if (fresh)
                    out.materials.push_back(model.materials[material]);
                slot = at->second;
            }
            known = parts.emplace(&drawn, std::move(part)).first;
        }
        append(out.mesh, known->second, cut.world(node));
    }
    return out;
}

/// A square picture around a bound: linear light, associated alpha.
inline image::Image picture_of(const DrawnMesh& drawn, const Bound& bound, const Camera& camera,
                               int side) {
    constexpr int kAcross = 8;  // samples along a side of a pixel
    constexpr double kSky = 0.25;
    const glm::dvec3 sun = glm::normalize(glm::dvec3(-0.5, -0.7, 0.8));
    image::TexelCache texels;
    const auto skin = std::make_shared<const ray::MeshSkin>(drawn.materials, texels);
    const ray::MeshScene scene(drawn.mesh, skin);
    const glm::dvec3 right = glm::normalize(camera.right);
    const glm::dvec3 up = glm::normalize(camera.up);
    const double step = 2 * bound.radius / side / kAcross;
    image::Image out{
        side, side, true,
        std::vector<float>(size_t{4} * static_cast<size_t>(side) * static_cast<size_t>(side))};
    parallel_for(static_cast<size_t>(side), [&](size_t row) {
        for (int i = 0; i < side * kAcross * kAcross; ++i) {
            const int column = i / (kAcross * kAcross);
            const int sample = i % (kAcross * kAcross);
            const double x = column * kAcross + sample % kAcross + 0.5 - 0.5 * side * kAcross;
            const double y = 0.5 * side * kAcross -
                             (static_cast<double>(row) * kAcross + sample / kAcross + 0.5);
            const ray::RayHit hit = scene.first_hit(
                bound.center + step * (x * right + y * up) - 3 * bound.radius * camera.direction,
                camera.direction);
            if (!hit.hit)
                continue;
            const glm::dvec3 normal = measure::normal_at(drawn.mesh, hit, -camera.direction);
            double light = kSky;
            const double facing = glm::dot(normal, sun);
            if (facing > 0 && !scene.occluded(hit.point + 1e-6 * bound.radius * normal, sun))
                light += (1 - kSky) * facing;
            const glm::dvec3 color = skin->at(drawn.mesh, hit.triangle, hit.u, hit.v).color * light;
            float* const pixel =
                &out.pixels[4 * (row * static_cast<size_t>(side) + static_cast<size_t>(column))];
            for (int k = 0; k < 3; ++k)
                pixel[k] += static_cast<float>(color[k] / (kAcross * kAcross));
            pixel[3] += 1.0f / (kAcross * kAcross);
        }
    });
    return out;
}

/// The mean of what a picture shows over black, display-encoded, in 255ths, over the pixels that
/// `covered` covers.
inline double mean_shown(const image::Image& picture, const image::Image& covered) {
    double sum = 0;
    double count = 0;
    for (size_t i = 0; i < picture.size(); ++i) {
        if (!(covered.pixels[4 * i + 3] > 1.0f / 255))
            continue;
        ++count;
        for (size_t k = 0; k < 3; ++k) {
            const double linear = picture.pixels[4 * i + k];
            sum +=
                (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055) /
                3;
        }
    }
    return count > 0 ? 255 * sum / count : 0;
}

}  // namespace lodestone::bench
