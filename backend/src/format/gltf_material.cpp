// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/gltf_material.h"

#include "format/gltf_accessor.h"
#include "format/texture.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace lodestone::format {
namespace {

constexpr const char* kStrength = "KHR_materials_emissive_strength";

double limited(double value, double low, double high) {
    return value >= low ? std::min(value, high) : low;  // not a number: low
}

class Textures {
public:
    Textures(const tinygltf::Model& model, const std::string& name, Problems& problems)
        : model_(model), name_(name), problems_(problems) {}

    /// Nothing without a texture, or when it cannot be used (a problem then).
    std::optional<glm::dvec3> mean(int texture, bool color, const std::string& material) {
        if (texture < 0)
            return std::nullopt;
        try {
            if (static_cast<size_t>(texture) >= model_.textures.size())
                fail(Status::BadFile, "texture ", texture, " of ", model_.textures.size());
            const int source = model_.textures[static_cast<size_t>(texture)].source;
            const auto known = means_.find({source, color});
            const glm::dvec3 found =
                known != means_.end()
                    ? known->second
                    : means_.emplace(std::pair{source, color}, read(source, color)).first->second;
            problems_.push_back(
                {name_, Severity::Info, "texture_averaged",
                 text("material '", material, "': a texture counts as its mean value")});
            return found;
        } catch (const Error& e) {
            problems_.push_back({name_, Severity::Warning, "texture_missing",
                                 text("material '", material, "': ", e.what())});
            return std::nullopt;
        }
    }

private:
    glm::dvec3 read(int source, bool color) const {
        if (source < 0 || static_cast<size_t>(source) >= model_.images.size())
            fail(Status::BadFile, "picture ", source, " of ", model_.images.size());
        const tinygltf::Image& picture = model_.images[static_cast<size_t>(source)];
        const std::string label =
            picture.uri.empty() ? text("picture ", source, " of ", name_) : picture.uri;
        if (picture.bufferView >= 0)
            return mean_of(image::read(view_bytes(model_, picture.bufferView), label), color);
        if (picture.image.empty())
            fail(Status::Io, "'", label, "' is not inside the folder of the model");
        const std::string_view bytes(reinterpret_cast<const char*>(picture.image.data()),
                                     picture.image.size());
        return mean_of(image::read(bytes, label), color);
    }

    const tinygltf::Model& model_;
    const std::string& name_;
    Problems& problems_;
    std::map<std::pair<int, bool>, glm::dvec3> means_;
};

}  // namespace

std::vector<Material> read_materials(const tinygltf::Model& model, const std::string& name,
                                     Problems& problems) {
    std::vector<Material> materials;
    Textures textures(model, name, problems);
    for (const tinygltf::Material& from : model.materials) {
        Material material;
        material.name = from.name;
        const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
        const auto base = textures.mean(pbr.baseColorTexture.index, true, from.name);
        const auto rough = textures.mean(pbr.metallicRoughnessTexture.index, false, from.name);
        const auto glow = textures.mean(from.emissiveTexture.index, true, from.name);
        double strength = 1;
        const auto extension = from.extensions.find(kStrength);
        if (extension != from.extensions.end()) {
            const tinygltf::Value& value = member(extension->second, "emissiveStrength");
            strength = value.IsNumber() ? value.GetNumberAsDouble() : 1;
        }
        for (int i = 0; i < 3; ++i) {
            const auto at = static_cast<size_t>(i);
            if (at < pbr.baseColorFactor.size())
                material.base_color[i] = limited(pbr.baseColorFactor[at], 0, 1);
            if (at < from.emissiveFactor.size())
                material.emission[i] = limited(from.emissiveFactor[at] * strength, 0, 1e6);
        }
        material.roughness = limited(pbr.roughnessFactor, 0, 1);
        material.metallic = limited(pbr.metallicFactor, 0, 1);
        if (base)
            material.base_color *= *base;
        if (glow)
            material.emission *= *glow;
        if (rough) {
            material.roughness *= rough->y;  // green and blue, as glTF packs them
            material.metallic *= rough->z;
        }
        const tinygltf::Value& specular = member(member(from.extras, "lodestone"), "specular");
        if (specular.IsNumber())
            material.specular = limited(specular.GetNumberAsDouble(), 0, 1);
        materials.push_back(std::move(material));
    }
    Material standard;  // glTF's default is a white metal; nobody means that
    standard.name = "Default";
    materials.push_back(standard);
    return materials;
}

int add_material(tinygltf::Model& model, const Material& material) {
    tinygltf::Material out;
    out.name = valid_utf8(material.name);
    double largest = 0;
    for (int i = 0; i < 3; ++i)
        largest = std::max(largest, limited(material.emission[i], 0, 1e6));
    // A power of two, so that the product has the same bits again.
    const double strength = largest > 1 ? std::exp2(std::ceil(std::log2(largest))) : 1;
    out.pbrMetallicRoughness.baseColorFactor.assign(4, 1.0);
    out.emissiveFactor.assign(3, 0.0);
    for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<size_t>(i);
        out.pbrMetallicRoughness.baseColorFactor[at] = limited(material.base_color[i], 0, 1);
        out.emissiveFactor[at] = limited(material.emission[i], 0, 1e6) / strength;
    }
    out.pbrMetallicRoughness.metallicFactor = limited(material.metallic, 0, 1);
    out.pbrMetallicRoughness.roughnessFactor = limited(material.roughness, 0, 1);
    if (strength > 1) {
        out.extensions[kStrength] = tinygltf::Value(
            tinygltf::Value::Object{{"emissiveStrength", tinygltf::Value(strength)}});
        auto& used = model.extensionsUsed;
        if (std::find(used.begin(), used.end(), kStrength) == used.end())
            used.emplace_back(kStrength);
    }
    if (material.specular != 0.5) {
        tinygltf::Value::Object ours{
            {"specular", tinygltf::Value(limited(material.specular, 0, 1))}};
        out.extras = tinygltf::Value(
            tinygltf::Value::Object{{"lodestone", tinygltf::Value(std::move(ours))}});
    }
    model.materials.push_back(std::move(out));
    return static_cast<int>(model.materials.size() - 1);
}

std::string valid_utf8(const std::string& name) {
    std::string out;
    for (size_t i = 0; i < name.size();) {
        const auto lead = static_cast<unsigned char>(name[i]);
        const size_t length = lead < 0x80   ? 1
                              : lead < 0xc2 ? 0
                              : lead < 0xe0 ? 2
                              : lead < 0xf0 ? 3
                              : lead < 0xf5 ? 4
                                            : 0;
        bool valid = length > 0 && i + length <= name.size();
        uint32_t code = length > 1 ? lead & (0x7fu >> length) : lead;
        for (size_t k = 1; valid && k < length; ++k) {
            const auto next = static_cast<unsigned char>(name[i + k]);
            valid = (next & 0xc0u) == 0x80;
            code = (code << 6u) | (next & 0x3fu);
        }
        // Overlong forms, surrogates and numbers above the last.
        valid = valid && !(length == 3 && (code < 0x800 || (code >= 0xd800 && code < 0xe000))) &&
                !(length == 4 && (code < 0x10000 || code > 0x10ffff));
        if (valid)
            out.append(name, i, length);
        else
            out += "\xef\xbf\xbd";
        i += valid ? length : 1;
    }
    return out;
}

}  // namespace lodestone::format
