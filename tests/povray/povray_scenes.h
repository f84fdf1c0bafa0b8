// SPDX-License-Identifier: GPL-3.0-or-later
// Small models, views and a picture reader shared by the POV-Ray tests.
#pragma once

#include "base/files.h"
#include "image/texture_sampler.h"
#include "povray_export/run/povray_runner.h"
#include "povray_export/scene/povray_costs.h"
#include "povray_export/scene/scene_writer.h"
#include "scenes/small_meshes.h"
#include "scratch.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <numbers>

namespace lodestone::povray::scenes {

inline bool have_povray() {
    try {
        find_program();
        return true;
    } catch (const Error&) {
        return false;
    }
}

/// A picture of linear colors (data) or sRGB ones, top row first.
inline PicturePtr picture(int width, const std::vector<glm::vec4>& texels,
                          ColorSpace space = ColorSpace::Linear) {
    image::Image image;
    image.width = width;
    image.height = static_cast<int>(texels.size()) / width;
    for (const glm::vec4& texel : texels) {
        for (int i = 0; i < 4; ++i)
            image.pixels.push_back(texel[i]);
    }
    return image::make_picture(image::png_bytes(image), space, "picture");
}

/// 2 x 2: red, green; blue, yellow.
inline Texture checker(ColorSpace space = ColorSpace::Linear) {
    Texture texture;
    texture.picture =
        picture(2, {{.8, 0, 0, 1}, {0, .6, 0, 1}, {0, 0, .9, 1}, {.7, .5, 0, 1}}, space);
    return texture;
}

/// Matte, its base color a texture.
inline Material textured(const Texture& texture) {
    Material material;
    material.specular = 0;
    material.base_color_texture = texture;
    if (texture)
        material.base_color = image::color_of(texture, texture.picture->mean);
    return material;
}

/// A model whose root places what is added to it.
class Builder {
public:
    Builder() {
        Object root;
        root.uid = root.name = "root";
        model.objects.push_back(root);
        model.root = 0;
        model.world.color = glm::dvec3(0.0);
    }

    uint32_t material(const Material& material) {
        model.materials.push_back(material);
        return static_cast<uint32_t>(model.materials.size() - 1);
    }
    uint32_t matte(const glm::dvec3& color) {
        Material material;
        material.base_color = color;
        material.specular = 0;
        return this->material(material);
    }

    ObjectIndex mesh(Mesh mesh, std::vector<uint32_t> materials = {}) {
        return add(Kind::Mesh, std::make_shared<const Mesh>(std::move(mesh)), std::move(materials));
    }
    ObjectIndex primitive(Kind kind, const Primitive& primitive,
                          std::vector<uint32_t> materials = {}) {
        return add(kind, primitive, std::move(materials));
    }

    void place(ObjectIndex object, const Affine& transform = {}, const std::string& name = "it",
               RayMask hidden = 0) {
        placements_.push_back({object, transform, name, hidden});
    }
    void place_at(ObjectIndex object, const glm::dvec3& offset) {
        place(object, {glm::dmat3(1.0), offset});
    }

    const Model& finish() {
        Representation root;
        root.summary.kind = Kind::Assembly;
        root.payload = std::make_shared<const Assembly>(Assembly{placements_});
        model.objects[0].representations = {root};
        summarize_assemblies(model, bottom_up(model));
        return model;
    }

    Model model;

private:
    ObjectIndex add(Kind kind, Payload payload, std::vector<uint32_t> materials) {
        Object object;
        object.uid = object.name = text("object", model.objects.size());
        Representation finest;
        finest.summary.kind = kind;
        finest.payload = std::move(payload);
        finest.materials = std::move(materials);
        model.costs = povray_costs();
        summarize(finest, model);
        object.representations = {finest};
        model.objects.push_back(object);
        return static_cast<ObjectIndex>(model.objects.size() - 1);
    }

    std::vector<Placement> placements_;
};

/// Looks down at the origin from z = 10; a square metre is 32 pixels wide.
inline View above(int width = 64, int height = 64) {
    View view;
    view.width = width;
    view.height = height;
    view.camera.orthographic = true;
    view.camera.position = {0, 0, 10};
    view.camera.right = {width / 32.0, 0, 0};
    view.camera.up = {0, height / 32.0, 0};
    return view;
}

/// A sphere with uvs that have a seam in every triangle, and two materials.
inline Mesh rich_sphere(int subdivisions) {
    Mesh mesh = shapes::sphere(1, subdivisions);
    for (const glm::vec3& position : mesh.positions)
        mesh.uvs.emplace_back(position.x, position.y);
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        mesh.slots.push_back(static_cast<uint16_t>(i % 2));
    return mesh;
}

inline Light sun(double power, const glm::dvec3& direction = {0, 0, -1}) {
    Light light;
    light.power = power;
    light.direction = direction;
    return light;
}

struct Image {
    int width = 0;
    int height = 0;
    std::vector<double> values;  // RGB, linear, 0...1, top row first

    glm::dvec3 at(int x, int y) const {
        const size_t i =
            3 * (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x));
        return {values.at(i), values.at(i + 1), values.at(i + 2)};
    }
};

/// A 16-bit PPM.
inline Image read_ppm(const std::filesystem::path& path) {
    const std::string bytes = read_file(path);
    size_t at = 2;
    int header[3] = {};
    for (int& number : header) {
        while (bytes.at(at) == '#' || std::isspace(static_cast<unsigned char>(bytes.at(at))) != 0)
            at = bytes.at(at) == '#' ? bytes.find('\n', at) : at + 1;
        at = static_cast<size_t>(
            std::from_chars(bytes.data() + at, bytes.data() + bytes.size(), number).ptr -
            bytes.data());
    }
    Image image{header[0], header[1], {}};
    for (++at; at + 1 < bytes.size(); at += 2) {
        const auto high = static_cast<unsigned char>(bytes[at]);
        const auto low = static_cast<unsigned char>(bytes[at + 1]);
        image.values.push_back((high * 256 + low) / 65535.0);
    }
    EXPECT_EQ(image.values.size(), static_cast<size_t>(image.width) * image.height * 3);
    return image;
}

inline ExportReport write(const Model& model, const View& view, const ExportOptions& options,
                          Problems& problems) {
    const choose::Cut cut = choose::choose_cut(model, view);
    return export_scene(model, cut, view, options, problems);
}

/// Exports and renders.
inline Image render(const Model& model, const View& view, ExportOptions options,
                    RunReport* report = nullptr) {
    Problems problems;
    write(model, view, options, problems);
    EXPECT_TRUE(problems.empty());
    RunOptions how;
    how.folder = options.folder;
    how.output = OutputFormat::Ppm;
    how.threads = 1;
    const RunReport done = render_scene(how);
    if (report != nullptr)
        *report = done;
    return read_ppm(done.picture);
}

}  // namespace lodestone::povray::scenes
