// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/maths.h"
#include "base/text.h"
#include "format/baked_textures.h"
#include "format/gltf/gltf_file.h"
#include "format/gltf/gltf_material.h"
#include "format/gltf/gltf_own_material.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::format {
namespace {

using tinygltf::Value;

// The largest number of a color that is written.
// Taste: a larger value keeps brighter lamps, which other readers may not.
constexpr double kBrightest = 1e6;

/// tinygltf leaves out numbers that are this near to a default. They are made the default, so that
/// the same numbers are written and read.
double plain(double value, double usual) {
    return std::abs(value - usual) < 1e-11 ? usual : value;
}

/// A power of two, so that dividing by it and multiplying again changes no bit; 1 for what is dim.
double strength_of(const glm::dvec3& emission) {
    const double largest = std::max({emission.x, emission.y, emission.z});
    return largest > 1 ? std::exp2(std::ceil(std::log2(largest))) : 1;
}

bool within_one(const glm::dvec3& scale) {
    return scale == limited(scale, 0, 1);
}

/// Two textures of the same file's bytes, whatever the numbers mean.
bool same_bytes(const Texture& a, const Texture& b) {
    return a.picture->hash == b.picture->hash ||
           (!a.picture->bytes.empty() && a.picture->bytes == b.picture->bytes);
}

void add_extension(tinygltf::Model& model, tinygltf::Material& material, const char* name,
                   Value::Object words) {
    use_extension(model, name);
    material.extensions[name] = Value(std::move(words));
}

}  // namespace

MaterialWriter::MaterialWriter(tinygltf::Model& model, bool embed)
    : model_(model),
      embed_(embed),
      pictures_(model, embed),
      reader_(model, no_folder_, name_, std::numeric_limits<uint32_t>::max()),
      textures_(model) {}

bool MaterialWriter::sayable(const Texture& texture, ColorSpace space) const {
    return texture.picture->space == space && texture.picture->format != PictureFormat::Exr &&
           texture.extension != TextureExtension::Clip && texture.offset == glm::dvec3(0.0) &&
           (!embed_ || !texture.picture->bytes.empty()) &&
           transform_of(texture.to_picture).has_value();
}

MaterialWriter::TextureLayer MaterialWriter::base_layer(const Material& material) {
    const bool opaque = material.alpha_mode == AlphaMode::Opaque;
    const Texture& color = material.base_color_texture;
    const Texture& alpha = opaque ? Texture{} : material.alpha_texture;
    TextureLayer out;
    out.factor = {limited(material.base_color, 0, 1), limited(material.alpha, 0, 1)};
    if (!color && !alpha)
        return out;
    // Colors brighter than their picture are said by a drawn one, or where none is drawn, nearly.
    const auto said = [&](const Texture& texture) { return !embed_ || within_one(texture.scale); };
    bool direct = color && color.channel == TextureChannel::Color && said(color) &&
                  sayable(color, ColorSpace::Srgb);
    if (direct && alpha)
        direct = alpha.channel == TextureChannel::Alpha && said(alpha) && alpha.offset.x == 0 &&
                 same_layout(color, alpha) && same_bytes(color, alpha);
    else if (direct)
        direct = opaque || color.picture->mean.w == 1;
    if (direct) {
        out.texture = color;
        out.factor = {limited(color.scale, 0, 1),
                      alpha ? limited(alpha.scale.x, 0, 1) : out.factor.w};
        return out;
    }
    Recipe recipe{};
    if (color)
        recipe = color_recipe(color);
    const bool covered = alpha && (!color || same_layout(color, alpha));
    if (covered)
        recipe[3] = {&alpha};
    return drawn(recipe, ColorSpace::Srgb, out,
                 {color ? glm::dvec3(1.0) : glm::dvec3(out.factor), covered ? 1 : out.factor.w});
}

MaterialWriter::TextureLayer MaterialWriter::roughness_layer(const Material& material) {
    const Texture& rough = material.roughness_texture;
    const Texture& metal = material.metallic_texture;
    TextureLayer out;
    out.factor = {1, limited(material.roughness, 0, 1), limited(material.metallic, 0, 1), 1};
    if (!rough && !metal)
        return out;
    const auto direct = [&](const Texture& texture, TextureChannel channel, double constant) {
        return texture ? texture.channel == channel && within_one(texture.scale) &&
                             sayable(texture, ColorSpace::Linear)
                       : constant == 0;
    };
    if (direct(rough, TextureChannel::Green, out.factor.y) &&
        direct(metal, TextureChannel::Blue, out.factor.z) &&
        (!rough || !metal || (same_layout(rough, metal) && same_bytes(rough, metal)))) {
        out.texture = rough ? rough : metal;
        out.factor = {1, rough ? rough.scale.x : 0, metal ? metal.scale.x : 0, 1};
        return out;
    }
    Recipe recipe{};
    const bool both = rough && metal && same_layout(rough, metal);
    if (rough)
        recipe[1] = {&rough};
    if (metal && (!rough || both))
        recipe[2] = {&metal};
    return drawn(recipe, ColorSpace::Linear, out,
                 {1, rough ? 1 : out.factor.y, recipe[2].texture ? 1 : out.factor.z, 1});
}

MaterialWriter::TextureLayer MaterialWriter::emission_layer(const Material& material) {
    const Texture& glow = material.emission_texture;
    TextureLayer out;
    out.factor = {limited(material.emission, 0, kBrightest), 1};
    if (!glow)
        return out;
    if (glow.channel == TextureChannel::Color && glow.scale == limited(glow.scale, 0, kBrightest) &&
        sayable(glow, ColorSpace::Srgb)) {
        out.texture = glow;
        out.factor = {glow.scale, 1};
        return out;
    }
    return drawn(color_recipe(glow), ColorSpace::Srgb, out, glm::dvec4(1.0), true);
}

MaterialWriter::TextureLayer MaterialWriter::normal_layer(const Material& material) {
    const Texture& normal = material.normal_texture;
    TextureLayer out;
    if (!normal)
        return out;
    if (normal.channel == TextureChannel::Color && normal.scale == glm::dvec3(1.0) &&
        sayable(normal, ColorSpace::Linear)) {
        out.texture = normal;
        return out;
    }
    return drawn(color_recipe(normal), ColorSpace::Linear, out, glm::dvec4(1.0));
}

MaterialWriter::TextureLayer MaterialWriter::drawn(const Recipe& recipe, ColorSpace space,
                                                   const TextureLayer& otherwise,
                                                   const glm::dvec4& factor, bool bright) {
    if (!embed_)
        return otherwise;
    const auto [known, fresh] = drawn_.try_emplace(hash_of(recipe, space));
    if (fresh) {
        known->second = bake_recipe(recipe, space, bright);
        if (known->second && !transform_of(known->second->texture.to_picture))
            known->second.reset();
    }
    if (!known->second)
        return otherwise;
    const double limit = known->second->limit;
    return {known->second->texture, {glm::dvec3(factor) * limit, factor.w}};
}

template <typename Info>
void MaterialWriter::lay(const Texture& texture, Info& info) {
    if (!texture)
        return;
    const int image = pictures_.image(*texture.picture);
    reader_.remember_picture(image, texture.picture);
    info.index = textures_.texture(image, texture);
    if (auto transform = textures_.transform(texture))
        info.extensions[kTextureTransform] = std::move(*transform);
}

int MaterialWriter::add(const Material& material, bool uvs) {
    Material bare;
    if (!uvs) {
        bare = material;
        for_own_textures(bare, [](Texture& texture) { texture = Texture{}; });
    }
    const Material& shown = uvs ? material : bare;
    tinygltf::Material out;
    out.name = valid_utf8(material.name);
    out.alphaMode = material.alpha_mode == AlphaMode::Blend  ? "BLEND"
                    : material.alpha_mode == AlphaMode::Clip ? "MASK"
                                                             : "OPAQUE";
    if (material.alpha_mode == AlphaMode::Clip)
        out.alphaCutoff = plain(limited(material.alpha_cutoff, 0, kBrightest), 0.5);
    tinygltf::PbrMetallicRoughness& pbr = out.pbrMetallicRoughness;
    const TextureLayer base = base_layer(shown);
    lay(base.texture, pbr.baseColorTexture);
    const TextureLayer rough = roughness_layer(shown);
    lay(rough.texture, pbr.metallicRoughnessTexture);
    const TextureLayer glow = emission_layer(shown);
    lay(glow.texture, out.emissiveTexture);
    const TextureLayer normal = normal_layer(shown);
    lay(normal.texture, out.normalTexture);
    const glm::dvec3 emission(glow.factor);
    const double strength = strength_of(emission);
    pbr.baseColorFactor.resize(4);
    out.emissiveFactor.resize(3);
    for (int i = 0; i < 4; ++i)
        pbr.baseColorFactor[static_cast<size_t>(i)] = plain(base.factor[i], 1);
    for (int i = 0; i < 3; ++i)
        out.emissiveFactor[static_cast<size_t>(i)] = plain(emission[i] / strength, 0);
    pbr.roughnessFactor = plain(rough.factor.y, 1);
    pbr.metallicFactor = plain(rough.factor.z, 1);
    if (normal.texture)
        out.normalTexture.scale = plain(limited(material.normal_strength, -1000, 1000), 1);
    if (strength > 1)
        add_extension(model_, out, "KHR_materials_emissive_strength",
                      {{"emissiveStrength", Value(strength)}});
    add_reflection(material, out);
    if (embed_) {
        Problems unheard;
        const Material seen = material_seen(model_, out, reader_, name_, unheard);
        out.extras = extras_of_material(material, seen, pictures_);
    }
    model_.materials.push_back(std::move(out));
    return static_cast<int>(model_.materials.size() - 1);
}

void MaterialWriter::add_reflection(const Material& material, tinygltf::Material& out) {
    const double transmission = limited(material.transmission, 0, 1);
    if (transmission > 0) {
        add_extension(model_, out, "KHR_materials_transmission",
                      {{"transmissionFactor", Value(transmission)}});
        // Without transmission glTF would have the index change what `specular` says.
        if (material.ior >= 1 && material.ior <= 100)
            add_extension(model_, out, "KHR_materials_ior", {{"ior", Value(material.ior)}});
    }
    const double specular = 2 * limited(material.specular, 0, 1);
    if (specular != 1) {
        const Value tint(std::max(specular, 1.0));
        Value::Object words{{"specularFactor", Value(std::min(specular, 1.0))}};
        if (specular > 1)
            words["specularColorFactor"] = Value(Value::Array{tint, tint, tint});
        add_extension(model_, out, "KHR_materials_specular", std::move(words));
    }
    const double coat = limited(material.clearcoat, 0, 1);
    if (coat > 0)
        add_extension(
            model_, out, "KHR_materials_clearcoat",
            {{"clearcoatFactor", Value(coat)},
             {"clearcoatRoughnessFactor", Value(limited(material.clearcoat_roughness, 0, 1))}});
}

}  // namespace lodestone::format
