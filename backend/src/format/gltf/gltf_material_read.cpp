// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/maths.h"
#include "format/gltf/gltf_accessor.h"
#include "format/gltf/gltf_material.h"
#include "format/gltf/gltf_own_material.h"
#include "image/texture_sampler.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

namespace lodestone::format {
namespace {

using tinygltf::Value;

// Law: the usual ior (KHR_materials_ior).
constexpr double kGltfIor = 1.5;

glm::dvec4 color_in(const std::vector<double>& numbers, double usual) {
    glm::dvec4 out(usual);
    for (size_t i = 0; i < std::min<size_t>(numbers.size(), 4); ++i)
        out[static_cast<int>(i)] = limited(numbers[i], 0, 1);
    return out;
}

/// A texture of the file, or only the mean of its picture.
struct FoundTexture {
    Texture texture;
    glm::dvec4 mean{1.0};
};

class MaterialReader {
public:
    MaterialReader(const tinygltf::Model& model, const tinygltf::Material& from,
                   GltfPictureReader& pictures, const std::string& name, Problems& problems)
        : model_(model), from_(from), pictures_(pictures), name_(name), problems_(problems) {}

    Material read() {
        out_.name = from_.name;
        read_alpha_mode();
        if (const Value* old = extension("KHR_materials_pbrSpecularGlossiness"); old != nullptr)
            read_glossiness(*old);
        else
            read_metallic_roughness();
        read_emission();
        read_normal();
        read_extensions();
        return std::move(out_);
    }

private:
    const Value* extension(const char* key) const {
        const auto found = from_.extensions.find(key);
        return found == from_.extensions.end() ? nullptr : &found->second;
    }

    void complain(Severity severity, const char* code, const std::string& message) {
        problems_.push_back(
            {name_, severity, code, text("material '", from_.name, "': ", message)});
    }

    template <typename Info>
    static TextureUse use_of(const Info& info) {
        return {info.index, info.texCoord, &info.extensions};
    }

    /// The use of a texture inside an extension: only its mean is read.
    static TextureUse use_in(const Value& value) {
        TextureUse use;
        const Value& index = member(value, "index");
        if (index.IsInt())
            use.texture = index.GetNumberAsInt();
        return use;
    }

    /// Gives nothing without a texture, or when it cannot be used (which is a problem).
    std::optional<FoundTexture> find(const TextureUse& use, ColorSpace space) {
        if (use.texture < 0)
            return std::nullopt;
        try {
            const TextureLayout layout = layout_of(model_, use);
            const PicturePtr picture = pictures_.image(layout.image, space);
            FoundTexture found{layout.texture, picture->mean};
            if (layout.coordinates != 0) {
                complain(Severity::Warning, "texture_averaged",
                         text("the texture '", picture->name,
                              "' uses a second set of texture coordinates; it counts as its mean"));
                return found;
            }
            if (!layout.one_wrap)
                complain(Severity::Warning, "texture_simplified",
                         text("the texture '", picture->name,
                              "' is repeated in one direction only; both are taken as the first"));
            found.texture.picture = picture;
            return found;
        } catch (const Error& e) {
            complain(Severity::Warning, "texture_missing", e.what());
            return std::nullopt;
        }
    }

    /// The mean of a texture's channel in an extension; 1 without one.
    double mean_in(const Value& value, const char* key, int channel) {
        const auto found = find(use_in(member(value, key)), ColorSpace::Linear);
        if (!found)
            return 1;
        complain(Severity::Info, "texture_averaged", text(key, " counts as its mean value"));
        return found->mean[channel];
    }

    void read_alpha_mode() {
        if (from_.alphaMode == "MASK")
            out_.alpha_mode = AlphaMode::Clip;
        else if (from_.alphaMode == "BLEND")
            out_.alpha_mode = AlphaMode::Blend;
        if (out_.alpha_mode == AlphaMode::Clip && std::isfinite(from_.alphaCutoff))
            out_.alpha_cutoff = from_.alphaCutoff;
    }

    void read_base(const glm::dvec4& factor, const TextureUse& use) {
        const auto found = find(use, ColorSpace::Srgb);
        const bool alpha = out_.alpha_mode != AlphaMode::Opaque;
        out_.base_color = glm::dvec3(factor);
        if (alpha)
            out_.alpha = factor.w;
        if (!found)
            return;
        if (found->texture && glm::dvec3(factor) != glm::dvec3(0.0)) {
            out_.base_color_texture = found->texture;
            out_.base_color_texture.scale = glm::dvec3(factor);
        }
        out_.base_color *= glm::dvec3(found->mean);
        if (!alpha || found->mean.w == 1 || factor.w == 0)
            return;
        out_.alpha *= found->mean.w;
        out_.alpha_texture = found->texture;
        out_.alpha_texture.channel = TextureChannel::Alpha;
        out_.alpha_texture.scale = glm::dvec3(factor.w);
    }

    void read_metallic_roughness() {
        const tinygltf::PbrMetallicRoughness& pbr = from_.pbrMetallicRoughness;
        read_base(color_in(pbr.baseColorFactor, 1), use_of(pbr.baseColorTexture));
        out_.roughness = limited(pbr.roughnessFactor, 0, 1);
        out_.metallic = limited(pbr.metallicFactor, 0, 1);
        if (out_.roughness == 0 && out_.metallic == 0)
            return;
        const auto found = find(use_of(pbr.metallicRoughnessTexture), ColorSpace::Linear);
        if (!found)
            return;
        const auto take = [&](TextureChannel channel, double mean, Texture& texture,
                              double& value) {
            if (value != 0) {
                texture = found->texture;
                texture.channel = channel;
                texture.scale = glm::dvec3(value);
            }
            value *= mean;
        };
        take(TextureChannel::Green, found->mean.y, out_.roughness_texture, out_.roughness);
        take(TextureChannel::Blue, found->mean.z, out_.metallic_texture, out_.metallic);
    }

    /// An older extension, still common: its diffuse part on a rough dielectric.
    void read_glossiness(const Value& value) {
        const Value& factor = member(value, "diffuseFactor");
        std::vector<double> diffuse;
        for (int i = 0; i < static_cast<int>(std::min<size_t>(factor.ArrayLen(), 4)); ++i)
            diffuse.push_back(number_of(factor.Get(i), 1));
        const Value& texture = member(value, "diffuseTexture");
        TextureUse use = use_in(texture);
        const Value& coordinates = member(texture, "texCoord");
        use.coordinates = coordinates.IsInt() ? coordinates.GetNumberAsInt() : 0;
        std::map<std::string, Value> extensions;
        const Value& transform = member(member(texture, "extensions"), kTextureTransform);
        if (transform.IsObject())
            extensions[kTextureTransform] = transform;
        use.extensions = &extensions;
        read_base(color_in(diffuse, 1), use);
        out_.roughness = 1 - limited(number_of(member(value, "glossinessFactor"), 1), 0, 1);
        complain(Severity::Warning, "material_simplified",
                 "KHR_materials_pbrSpecularGlossiness: only its diffuse color and glossiness are "
                 "used");
    }

    void read_emission() {
        double strength = 1;
        if (const Value* value = extension("KHR_materials_emissive_strength"); value != nullptr)
            strength = number_of(member(*value, "emissiveStrength"), 1);
        glm::dvec3 factor(0.0);
        for (size_t i = 0; i < std::min<size_t>(from_.emissiveFactor.size(), 3); ++i)
            factor[static_cast<int>(i)] = limited(from_.emissiveFactor[i] * strength, 0, 1e6);
        out_.emission = factor;
        if (factor == glm::dvec3(0.0))
            return;
        if (const auto found = find(use_of(from_.emissiveTexture), ColorSpace::Srgb)) {
            out_.emission *= glm::dvec3(found->mean);
            out_.emission_texture = found->texture;
            if (found->texture)
                out_.emission_texture.scale = factor;
        }
    }

    void read_normal() {
        const auto found = find(use_of(from_.normalTexture), ColorSpace::Linear);
        if (!found || !found->texture)
            return;
        out_.normal_texture = found->texture;
        out_.normal_strength = limited(from_.normalTexture.scale, -1000, 1000);
    }

    void read_extensions() {
        if (const Value* value = extension("KHR_materials_transmission"); value != nullptr)
            out_.transmission = limited(number_of(member(*value, "transmissionFactor"), 0), 0, 1) *
                                mean_in(*value, "transmissionTexture", 0);
        double facing = 1;  // the reflectance of the ior, over that of an ior of 1.5
        if (out_.transmission > 0)
            out_.ior = kGltfIor;
        if (const Value* value = extension("KHR_materials_ior"); value != nullptr) {
            const double ior = number_of(member(*value, "ior"), kGltfIor);
            out_.ior = ior >= 1 ? std::min(ior, 100.0) : kGltfIor;
            // A surface that refracts reflects by its own index, any other by `specular`.
            const double ratio = (out_.ior - 1) / (out_.ior + 1);
            facing = out_.transmission > 0 ? 1 : ratio * ratio / 0.04;
        }
        if (const Value* value = extension("KHR_materials_specular"); value != nullptr) {
            const Value& color = member(*value, "specularColorFactor");
            double tint = color.ArrayLen() == 3 ? 0 : 1;
            for (int i = 0; i < 3 && color.ArrayLen() == 3; ++i)
                tint = std::max(tint, limited(number_of(color.Get(i), 1), 0, 100));
            facing *= tint * limited(number_of(member(*value, "specularFactor"), 1), 0, 1) *
                      mean_in(*value, "specularTexture", 3);
        }
        out_.specular = limited(0.5 * facing, 0, 1);
        if (const Value* value = extension("KHR_materials_clearcoat"); value != nullptr) {
            out_.clearcoat = limited(number_of(member(*value, "clearcoatFactor"), 0), 0, 1) *
                             mean_in(*value, "clearcoatTexture", 0);
            if (out_.clearcoat > 0)
                out_.clearcoat_roughness =
                    limited(number_of(member(*value, "clearcoatRoughnessFactor"), 0), 0, 1) *
                    mean_in(*value, "clearcoatRoughnessTexture", 1);
        }
        if (extension("KHR_materials_unlit") != nullptr)
            shine();
        name_the_rest();
    }

    /// Unlit: it sends out its base color, and reflects nothing.
    void shine() {
        out_.emission = out_.base_color;
        out_.emission_texture = out_.base_color_texture;
        out_.base_color = glm::dvec3(0.0);
        out_.base_color_texture = Texture{};
        out_.normal_texture = out_.roughness_texture = out_.metallic_texture = Texture{};
        out_.roughness = 1;
        out_.metallic = out_.specular = out_.transmission = out_.clearcoat = 0;
    }

    void name_the_rest() {
        constexpr std::array<std::string_view, 7> kKnown{
            "KHR_materials_clearcoat", "KHR_materials_emissive_strength",
            "KHR_materials_ior",       "KHR_materials_pbrSpecularGlossiness",
            "KHR_materials_specular",  "KHR_materials_transmission",
            "KHR_materials_unlit"};
        for (const auto& [key, value] : from_.extensions) {
            if (key.starts_with("KHR_materials_") &&
                std::find(kKnown.begin(), kKnown.end(), key) == kKnown.end())
                complain(Severity::Info, "material_simplified",
                         text(key.substr(0, 100), " is not used"));
        }
    }

    const tinygltf::Model& model_;
    const tinygltf::Material& from_;
    GltfPictureReader& pictures_;
    const std::string& name_;
    Problems& problems_;
    Material out_;
};

}  // namespace

Material material_seen(const tinygltf::Model& model, const tinygltf::Material& from,
                       GltfPictureReader& pictures, const std::string& name, Problems& problems) {
    return MaterialReader(model, from, pictures, name, problems).read();
}

std::vector<Material> read_materials(const tinygltf::Model& model, GltfPictureReader& pictures,
                                     const std::string& name, Problems& problems) {
    std::vector<Material> materials;
    materials.reserve(model.materials.size() + 2);
    for (const tinygltf::Material& from : model.materials) {
        materials.push_back(material_seen(model, from, pictures, name, problems));
        const Value& ours = member(from.extras, "lodestone");
        if (ours.Has("of"))
            apply_material_extras(ours, pictures, materials.back());
    }
    std::set<size_t> unlit;
    for (const tinygltf::Mesh& mesh : model.meshes) {
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
            const auto material = static_cast<size_t>(primitive.material);  // none: the largest
            if (material >= materials.size() || !primitive.attributes.contains("COLOR_0"))
                continue;
            materials[material].vertex_colors = true;
            if (model.materials[material].extensions.contains("KHR_materials_unlit") &&
                unlit.insert(material).second)
                problems.push_back({name, Severity::Warning, "material_simplified",
                                    text("material '", materials[material].name,
                                         "' is unlit: its vertex colors are not used")});
        }
    }
    Material standard;  // glTF's default is a white metal; nobody means that
    standard.name = "Default";
    materials.push_back(standard);
    standard.base_color = glm::dvec3(1.0);
    standard.vertex_colors = true;
    standard.name = "Vertex colors";
    materials.push_back(std::move(standard));
    return materials;
}

}  // namespace lodestone::format
