// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/gltf/gltf_texture.h"

#include "base/error.h"
#include "format/gltf/gltf_accessor.h"

#include <glm/geometric.hpp>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>

namespace lodestone::format {
namespace {

TextureExtension extension_of(int wrap) {
    switch (wrap) {
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return TextureExtension::Extend;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return TextureExtension::Mirror;
        default:
            return TextureExtension::Repeat;
    }
}

int wrap_of(TextureExtension extension) {
    switch (extension) {
        case TextureExtension::Mirror:
            return TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
        case TextureExtension::Extend:
        case TextureExtension::Clip:
            return TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
        case TextureExtension::Repeat:
            break;
    }
    return TINYGLTF_TEXTURE_WRAP_REPEAT;
}

glm::dvec2 pair_of(const tinygltf::Value& value, const glm::dvec2& usual) {
    if (!value.IsArray() || value.ArrayLen() != 2)
        return usual;
    const glm::dvec2 found(number_of(value.Get(0), std::nan("")),
                           number_of(value.Get(1), std::nan("")));
    return std::isfinite(found.x) && std::isfinite(found.y) ? found : usual;
}

tinygltf::Value value_of(const glm::dvec2& pair) {
    return tinygltf::Value(
        tinygltf::Value::Array{tinygltf::Value(pair.x), tinygltf::Value(pair.y)});
}

}  // namespace

TextureLayout layout_of(const tinygltf::Model& model, const TextureUse& use) {
    if (use.texture < 0 || static_cast<size_t>(use.texture) >= model.textures.size())
        fail(Status::BadFile, "texture ", use.texture, " of ", model.textures.size());
    const tinygltf::Texture& from = model.textures[static_cast<size_t>(use.texture)];
    TextureLayout out;
    out.image = from.source;
    out.coordinates = use.coordinates;
    if (from.sampler >= 0 && static_cast<size_t>(from.sampler) < model.samplers.size()) {
        const tinygltf::Sampler& sampler = model.samplers[static_cast<size_t>(from.sampler)];
        out.texture.extension = extension_of(sampler.wrapS);
        out.one_wrap = extension_of(sampler.wrapT) == out.texture.extension;
        if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST)
            out.texture.interpolation = TextureInterpolation::Closest;
    }
    if (use.extensions == nullptr)
        return out;
    const auto found = use.extensions->find(kTextureTransform);
    if (found == use.extensions->end())
        return out;
    const tinygltf::Value& from_extension = found->second;
    const tinygltf::Value& coordinates = member(from_extension, "texCoord");
    if (coordinates.IsInt())
        out.coordinates = coordinates.GetNumberAsInt();
    TextureTransform transform;
    transform.offset = pair_of(member(from_extension, "offset"), transform.offset);
    transform.scale = pair_of(member(from_extension, "scale"), transform.scale);
    transform.rotation = number_of(member(from_extension, "rotation"), 0);
    const std::array<double, 6> moved = to_picture_of(transform);
    if (std::all_of(moved.begin(), moved.end(), [](double x) { return std::isfinite(x); }))
        out.texture.to_picture = moved;
    return out;
}

// glTF, v down:  u' =  c sx u + s sy v + ox
//                v' = -s sx u + c sy v + oy
// Ours, v up: v = 1 - w for mesh and picture alike.
std::array<double, 6> to_picture_of(const TextureTransform& transform) {
    const double c = std::cos(transform.rotation);
    const double s = std::sin(transform.rotation);
    const glm::dvec2& scale = transform.scale;
    return {c * scale.x, -s * scale.y, transform.offset.x + s * scale.y,
            s * scale.x, c * scale.y,  1 - transform.offset.y - c * scale.y};
}

std::optional<TextureTransform> transform_of(const std::array<double, 6>& m) {
    // The most by which the cosine of the two directions may differ from 0.
    // Taste: a larger value takes more shears for turns, and is off by as much.
    constexpr double kTolerance = 1e-6;
    const glm::dvec2 first(m[0], m[3]);
    const glm::dvec2 second(m[1], m[4]);
    const double lengths = glm::length(first) * glm::length(second);
    if (!std::all_of(m.begin(), m.end(), [](double x) { return std::isfinite(x); }) ||
        !(std::abs(glm::dot(first, second)) <= kTolerance * lengths))
        return std::nullopt;
    TextureTransform out;
    double c = 1;
    double s = 0;
    // Without a turn all is exact, mirrored or not.
    if (m[1] != 0 || m[3] != 0) {
        const double length = glm::length(first);
        if (length > 0) {
            c = first.x / length;
            s = first.y / length;
        } else {
            c = second.y / glm::length(second);
            s = -second.x / glm::length(second);
        }
        out.rotation = std::atan2(s, c);
    }
    out.scale = {c * m[0] + s * m[3], c * m[4] - s * m[1]};
    out.offset = {m[2] - s * out.scale.y, 1 - m[5] - c * out.scale.y};
    return out;
}

int TextureWriter::texture(int image, const Texture& texture) {
    const auto [sampler, new_sampler] = samplers_.try_emplace(
        {texture.extension, texture.interpolation}, static_cast<int>(model_.samplers.size()));
    if (new_sampler) {
        tinygltf::Sampler out;
        out.wrapS = out.wrapT = wrap_of(texture.extension);
        const bool closest = texture.interpolation == TextureInterpolation::Closest;
        out.magFilter = closest ? TINYGLTF_TEXTURE_FILTER_NEAREST : TINYGLTF_TEXTURE_FILTER_LINEAR;
        out.minFilter = closest ? TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR
                                : TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
        model_.samplers.push_back(std::move(out));
    }
    const auto [known, fresh] =
        textures_.try_emplace({image, sampler->second}, static_cast<int>(model_.textures.size()));
    if (fresh) {
        tinygltf::Texture out;
        out.source = image;
        out.sampler = sampler->second;
        model_.textures.push_back(std::move(out));
    }
    return known->second;
}

std::optional<tinygltf::Value> TextureWriter::transform(const Texture& texture) {
    if (texture.to_picture == Texture{}.to_picture)
        return std::nullopt;
    const TextureTransform transform = transform_of(texture.to_picture).value();
    use_extension(model_, kTextureTransform);
    return tinygltf::Value(
        tinygltf::Value::Object{{"offset", value_of(transform.offset)},
                                {"rotation", tinygltf::Value(transform.rotation)},
                                {"scale", value_of(transform.scale)}});
}

void use_extension(tinygltf::Model& model, const char* name) {
    auto& used = model.extensionsUsed;
    if (std::find(used.begin(), used.end(), name) == used.end())
        used.emplace_back(name);
}

double number_of(const tinygltf::Value& value, double usual) {
    const double found = value.IsNumber() ? value.GetNumberAsDouble() : usual;
    return std::isfinite(found) ? found : usual;
}

}  // namespace lodestone::format
