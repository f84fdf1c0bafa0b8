// SPDX-License-Identifier: GPL-3.0-or-later
// Small models with known answers, shared by the tests.
#pragma once

#include "image/texture_sampler.h"
#include "model/model.h"
#include "povray_export/scene/povray_costs.h"
#include "scenes/small_meshes.h"

namespace lodestone::models {

/// Whether a stand-in of this kind is a solid: whatever is no mesh.
inline bool is_solid(Kind kind) {
    return kind != Kind::Mesh && kind != Kind::Assembly;
}

/// The model is drawn by POV-Ray from then on.
inline ObjectIndex add_leaf(Model& model, const std::string& uid, Mesh mesh, Material material = {},
                            ObjectRole role = ObjectRole::Automatic) {
    model.costs = povray::povray_costs();
    Object object;
    object.uid = object.name = uid;
    object.role = role;
    Representation finest;
    finest.materials = {static_cast<uint32_t>(model.materials.size())};
    model.materials.push_back(std::move(material));
    finest.payload = std::make_shared<const Mesh>(std::move(mesh));
    summarize(finest, model);
    object.representations.push_back(std::move(finest));
    model.objects.push_back(std::move(object));
    return static_cast<ObjectIndex>(model.objects.size() - 1);
}

inline Material colored(const std::string& name, const glm::dvec3& base_color,
                        double roughness = 0.5) {
    Material material;
    material.name = name;
    material.base_color = base_color;
    material.roughness = roughness;
    return material;
}

/// 2 x 2 texels: black and white, one of them half covered.
inline PicturePtr checker() {
    image::Image image;
    image.width = image.height = 2;
    image.pixels = {0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 0.5f, 0, 0, 0, 1};
    return image::make_picture(image::png_bytes(image), ColorSpace::Srgb, "checker");
}

inline Affine moved(double x, double y, double z) {
    Affine transform;
    transform.offset = {x, y, z};
    return transform;
}

inline ObjectIndex add_group(Model& model, const std::string& uid,
                             std::vector<Placement> placements) {
    Object object;
    object.uid = object.name = uid;
    Representation finest;
    finest.summary.kind = Kind::Assembly;
    auto assembly = std::make_shared<Assembly>();
    assembly->placements = std::move(placements);
    finest.payload = std::shared_ptr<const Assembly>(std::move(assembly));
    object.representations.push_back(std::move(finest));
    model.objects.push_back(std::move(object));
    return static_cast<ObjectIndex>(model.objects.size() - 1);
}

/// `count` balls of 1280 triangles in a row along x, 3 m apart, in pairs, in one group.
inline Model row_of_balls(int count) {
    Model model;
    const ObjectIndex ball = add_leaf(model, "ball", shapes::sphere(1, 3));
    const ObjectIndex pair =
        add_group(model, "pair", {{ball, moved(0, 0, 0), "left"}, {ball, moved(3, 0, 0), "right"}});
    std::vector<Placement> pairs;
    for (int i = 0; i < count / 2; ++i)
        pairs.push_back({pair, moved(6.0 * i, 0, 0), "pair " + std::to_string(i)});
    model.root = add_group(model, "row", std::move(pairs));
    summarize_assemblies(model, bottom_up(model));
    return model;
}

/// From so many metres in front of the origin, where a pixel covers 1/640 of the distance.
inline View view_from(double distance, double pixel_error = 1) {
    View view;
    view.camera.position = {0, -distance, 0};
    view.camera.direction = {0, 1, 0};
    view.camera.right = {1, 0, 0};
    view.camera.up = {0, 0, 0.5625};
    view.pixel_error = pixel_error;
    return view;
}

/// Adds a coarser level with a made-up error.
inline void add_level(Model& model, ObjectIndex object, double error, const Mesh& mesh) {
    Representation level;
    level.materials = {0};
    level.payload = std::make_shared<const Mesh>(mesh);
    summarize(level, model);
    level.summary.error = error;
    model.objects[object].representations.push_back(std::move(level));
}

}  // namespace lodestone::models
