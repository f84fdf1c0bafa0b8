// SPDX-License-Identifier: GPL-3.0-or-later
// Textured glTF files: made, read, and read as strangers would.
#pragma once

#include "base/random.h"
#include "scenes/gltf_text.h"
#include "scenes/small_models.h"

#include <gtest/gtest.h>

namespace lodestone::format::gltf_text {

/// width x height texels, all different; alpha too when it is asked for.
inline PicturePtr many_texels(int width, int height, ColorSpace space, bool alpha = false) {
    image::Image image;
    image.width = width;
    image.height = height;
    PcgRandom random(static_cast<uint64_t>(width), static_cast<uint64_t>(height));
    for (int i = 0; i < width * height; ++i) {
        for (int c = 0; c < 3; ++c)
            image.pixels.push_back(static_cast<float>(random.uniform()));
        image.pixels.push_back(alpha ? static_cast<float>(random.uniform()) : 1.0f);
    }
    return image::make_picture(image::png_bytes(image), space, "many");
}

/// glTF text of a quad with one material and one texture, whose picture is `picture`.
inline std::string with_material(const std::string& material, const std::string& picture,
                                 const std::string& rest = "") {
    return gltf(
        R"("materials":[)" + material +
        R"(],"textures":[{"source":0,"sampler":0}],"samplers":[{}],"images":[{"name":"board","uri":")" +
        picture + R"("}],)" + rest +
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],)" +
        kOneNode);
}

inline std::string data_uri(const Picture& picture) {
    return "data:image/png;base64," + base64(picture.bytes);
}

inline Material only_material(const std::string& bytes, Problems& problems) {
    return read(bytes, problems).materials.at(0);
}

inline Material only_material(const std::string& bytes) {
    Problems problems;
    Material material = only_material(bytes, problems);
    EXPECT_TRUE(problems.empty()) << problems[0].message;
    return material;
}

inline Model model_of(const Material& material, bool uvs = true) {
    Model model;
    Mesh mesh = shapes::quad(1, 1);
    if (uvs)
        mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    model.root = models::add_leaf(model, "quad", mesh, material);
    summarize_assemblies(model, bottom_up(model));
    return model;
}

inline Material back_of(const std::string& glb) {
    Problems problems;
    const Model back = read(glb, problems);
    EXPECT_TRUE(problems.empty()) << problems[0].message;
    return back.materials[back.objects.at(0).representations[0].materials.at(0)];
}

/// The file as a program reads it that does not know our extras.
inline std::string for_strangers(std::string glb) {
    for (size_t at = glb.find("\"lodestone\""); at != std::string::npos;
         at = glb.find("\"lodestone\""))
        glb.replace(at, 11, "\"some__one\"");
    return glb;
}

inline void expect_near(const glm::dvec3& found, const glm::dvec3& wanted, double tolerance) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i], wanted[i], tolerance) << i;
}

}  // namespace lodestone::format::gltf_text
