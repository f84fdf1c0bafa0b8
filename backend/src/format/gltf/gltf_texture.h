// SPDX-License-Identifier: GPL-3.0-or-later
// glTF textures <-> Texture: samplers, KHR_texture_transform, v down <-> v up.
#pragma once

#include "model/texture.h"

#include <map>
#include <optional>
#include <string>
#include <tuple>

namespace tinygltf {
class Model;
class Value;
}  // namespace tinygltf

namespace lodestone::format {

inline constexpr const char* kTextureTransform = "KHR_texture_transform";

/// Where a material names a texture.
struct TextureUse {
    int texture = -1;  // index
    int coordinates = 0;
    const std::map<std::string, tinygltf::Value>* extensions = nullptr;
};

/// How a texture of the file is laid on; `extension` and the like of a Texture.
struct TextureLayout {
    int image = -1;
    int coordinates = 0;   // the set of texture coordinates
    Texture texture;       // without a picture
    bool one_wrap = true;  // s and t are wrapped alike; else s counts
};

/// Throws Error(BadFile) for an index out of range; numbers that make no sense count as absent.
TextureLayout layout_of(const tinygltf::Model& model, const TextureUse& use);

/// offset, rotation and scale of KHR_texture_transform.
struct TextureTransform {
    glm::dvec2 offset{0.0};
    double rotation = 0;
    glm::dvec2 scale{1.0};
};

/// row-major 2x3 of v up, for texture coordinates that are ours.
std::array<double, 6> to_picture_of(const TextureTransform& transform);
/// Nothing for one that shears, or is not finite.
std::optional<TextureTransform> transform_of(const std::array<double, 6>& to_picture);

/// Adds each sampler and texture once.
class TextureWriter {
public:
    explicit TextureWriter(tinygltf::Model& model) : model_(model) {}

    /// The index of a texture that shows `image` as `texture` does.
    int texture(int image, const Texture& texture);
    /// The extension that moves it; nothing when it is not moved. `texture` must not shear.
    std::optional<tinygltf::Value> transform(const Texture& texture);

private:
    tinygltf::Model& model_;
    std::map<std::pair<TextureExtension, TextureInterpolation>, int> samplers_;
    std::map<std::pair<int, int>, int> textures_;  // image and sampler
};

/// Adds a name to extensionsUsed.
void use_extension(tinygltf::Model& model, const char* name);

/// A finite number, or `usual`.
double number_of(const tinygltf::Value& value, double usual);

}  // namespace lodestone::format
