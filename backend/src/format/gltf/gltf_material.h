// SPDX-License-Identifier: GPL-3.0-or-later
// glTF materials <-> Material.
#pragma once

#include "base/error.h"
#include "format/baked_textures.h"
#include "format/gltf/gltf_picture.h"
#include "format/gltf/gltf_texture.h"
#include "model/material.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
struct Material;
}  // namespace tinygltf

namespace lodestone::format {

/// The material that the words of glTF describe (not our extras): metallic-roughness, pictures,
/// alpha modes and KHR_materials_ clearcoat, emissive_strength, ior, specular, transmission, unlit,
/// pbrSpecularGlossiness (its diffuse part). A texture that cannot be used, or only as its mean, is
/// a problem; every other extension is a problem that names it.
Material material_seen(const tinygltf::Model& model, const tinygltf::Material& from,
                       GltfPictureReader& pictures, const std::string& name, Problems& problems);

/// All materials of the file, our extras included; then two for primitives without one, the second
/// for those with vertex colors. vertex_colors is set where a primitive of the material has
/// COLOR_0: glTF always multiplies by them.
std::vector<Material> read_materials(const tinygltf::Model& model, GltfPictureReader& pictures,
                                     const std::string& name, Problems& problems);

/// Adds materials, their textures, samplers and pictures.
class MaterialWriter {
public:
    /// `embed`: pictures go into the file. A texture that glTF has no words for is drawn into a new
    /// picture, and the extras keep what is still missing. Else the store's pictures are named, and
    /// a texture that glTF has no words for counts as its mean.
    MaterialWriter(tinygltf::Model& model, bool embed);
    MaterialWriter(const MaterialWriter&) = delete;
    MaterialWriter& operator=(const MaterialWriter&) = delete;

    /// Adds a material and returns its index. `uvs`: whether the mesh has them; without them no
    /// texture is shown, as glTF asks. Colors and numbers are clamped to the range glTF allows.
    int add(const Material& material, bool uvs);

private:
    /// A texture that glTF has words for, and the factor of its values.
    struct TextureLayer {
        Texture texture;
        glm::dvec4 factor{1.0};
    };

    TextureLayer base_layer(const Material& material);
    TextureLayer roughness_layer(const Material& material);
    TextureLayer emission_layer(const Material& material);
    TextureLayer normal_layer(const Material& material);
    /// The recipe drawn into a new picture whose values are to be multiplied by `factor`; where
    /// that fails, `otherwise`.
    TextureLayer drawn(const Recipe& recipe, ColorSpace space, const TextureLayer& otherwise,
                       const glm::dvec4& factor, bool bright = false);
    void add_reflection(const Material& material, tinygltf::Material& out);
    bool sayable(const Texture& texture, ColorSpace space) const;
    template <typename Info>
    void lay(const Texture& texture, Info& info);

    tinygltf::Model& model_;
    bool embed_;
    std::string name_ = "GLB";
    std::filesystem::path no_folder_;
    GltfPictureWriter pictures_;
    GltfPictureReader reader_;
    TextureWriter textures_;
    std::map<Hash, std::optional<BakedTexture>> drawn_;  // by what went into it
};

}  // namespace lodestone::format
