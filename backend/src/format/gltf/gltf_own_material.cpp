// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/gltf/gltf_own_material.h"

#include "base/error.h"
#include "base/maths.h"
#include "base/text.h"
#include "format/gltf/gltf_accessor.h"
#include "format/gltf/gltf_file.h"
#include "format/gltf/gltf_picture.h"

#include <tiny_gltf.h>

#include <bit>
#include <cmath>
#include <span>

namespace lodestone::format {
namespace {

using tinygltf::Value;

constexpr int kMostMixtures = 32;  // each nests the JSON one deeper
constexpr double kAny = 1e300;

struct NumberWord {
    const char* key;
    double Material::*field;
    double low;
    double high;
};

constexpr NumberWord kNumbers[] = {
    {"roughness", &Material::roughness, 0, 1},
    {"metallic", &Material::metallic, 0, 1},
    {"specular", &Material::specular, 0, kAny},
    {"alpha", &Material::alpha, 0, 1},
    {"alpha_cutoff", &Material::alpha_cutoff, -kAny, kAny},
    {"transmission", &Material::transmission, 0, 1},
    {"ior", &Material::ior, 1e-300, kAny},
    {"clearcoat", &Material::clearcoat, 0, 1},
    {"clearcoat_roughness", &Material::clearcoat_roughness, 0, 1},
    {"normal_strength", &Material::normal_strength, -kAny, kAny},
    {"bump_distance", &Material::bump_distance, -kAny, kAny},
    {"mix", &Material::mix, 0, 1},
};

constexpr std::pair<const char*, glm::dvec3 Material::*> kColorFields[] = {
    {"base_color", &Material::base_color}, {"emission", &Material::emission}};

constexpr std::pair<const char*, Texture Material::*> kTextureFields[] = {
    {"base_color_texture", &Material::base_color_texture},
    {"roughness_texture", &Material::roughness_texture},
    {"metallic_texture", &Material::metallic_texture},
    {"emission_texture", &Material::emission_texture},
    {"alpha_texture", &Material::alpha_texture},
    {"normal_texture", &Material::normal_texture},
    {"bump_texture", &Material::bump_texture},
    {"mix_texture", &Material::mix_texture},
};

bool same_bits(double a, double b) {
    return std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b);
}

Value list_of(std::span<const double> numbers) {
    Value::Array out;
    for (const double number : numbers)
        out.emplace_back(number);
    return Value(std::move(out));
}

bool finite(std::span<const double> numbers) {
    for (const double number : numbers) {
        if (!std::isfinite(number))
            return false;
    }
    return true;
}

std::span<const double> numbers_of(const glm::dvec3& v) {
    return {&v.x, 3};
}

bool sayable(const Texture& texture) {
    return texture && !texture.picture->bytes.empty() && finite(texture.to_picture) &&
           finite(numbers_of(texture.scale)) && finite(numbers_of(texture.offset));
}

Value words_of(const Texture& texture, GltfPictureWriter& pictures) {
    const Picture& picture = *texture.picture;
    Value::Object out{{"hash", Value(hex16(picture.hash))},
                      {"linear", Value(picture.space == ColorSpace::Linear)},
                      {"channel", Value(static_cast<int>(texture.channel))},
                      {"extension", Value(static_cast<int>(texture.extension))},
                      {"closest", Value(texture.interpolation == TextureInterpolation::Closest)},
                      {"to_picture", list_of(texture.to_picture)},
                      {"scale", list_of(numbers_of(texture.scale))},
                      {"offset", list_of(numbers_of(texture.offset))}};
    if (picture.format == PictureFormat::Exr) {  // glTF knows PNG and JPEG
        out["view"] = Value(pictures.view(picture));
        out["name"] = Value(valid_utf8(picture.name));
    } else {
        out["image"] = Value(pictures.image(picture));
    }
    return Value(std::move(out));
}

/// Of everything where the two differ.
Value::Object difference(const Material& material, const Material& seen,
                         GltfPictureWriter& pictures, int depth) {
    Value::Object out;
    for (const NumberWord& word : kNumbers) {
        const double number = material.*word.field;
        if (!same_bits(number, seen.*word.field) && number >= word.low && number <= word.high)
            out[word.key] = Value(number);
    }
    for (const auto& [key, field] : kColorFields) {
        const glm::dvec3& color = material.*field;
        bool same = true;
        for (int i = 0; i < 3; ++i)
            same = same && same_bits(color[i], (seen.*field)[i]);
        if (!same && finite(numbers_of(color)))
            out[key] = list_of(numbers_of(color));
    }
    for (const auto& [key, field] : kTextureFields) {
        const Texture& texture = material.*field;
        if (hash_of(texture) == hash_of(seen.*field))
            continue;
        if (sayable(texture))
            out[key] = words_of(texture, pictures);
        else if (!texture)
            out[key] = Value(false);
    }
    if (material.vertex_colors != seen.vertex_colors)
        out["vertex_colors"] = Value(material.vertex_colors);
    if (material.alpha_mode != seen.alpha_mode)
        out["alpha_mode"] = Value(static_cast<int>(material.alpha_mode));
    if (material.other && depth < kMostMixtures) {
        Value::Object other = difference(*material.other, Material{}, pictures, depth + 1);
        other["name"] = Value(valid_utf8(material.other->name));
        out["other"] = Value(std::move(other));
    }
    return out;
}

[[noreturn]] void refuse(const char* key) {
    fail(Status::BadFile, "'", key, "' makes no sense");
}

double number_in(const Value& value, const char* key, double low, double high) {
    const double number = value.IsNumber() ? value.GetNumberAsDouble() : std::nan("");
    if (!(number >= low && number <= high))
        refuse(key);
    return number;
}

template <size_t N>
void read_list(const Value& value, const char* key, double low, std::span<double, N> out) {
    if (!value.IsArray() || value.ArrayLen() != N)
        refuse(key);
    for (size_t i = 0; i < N; ++i)
        out[i] = number_in(value.Get(static_cast<int>(i)), key, low, kAny);
}

template <typename Enum>
Enum choice(const Value& value, const char* key, Enum last) {
    const double number = number_in(value, key, 0, static_cast<double>(last));
    return static_cast<Enum>(static_cast<int>(number));
}

bool truth(const Value& value, const char* key) {
    if (!value.IsBool())
        refuse(key);
    return value.Get<bool>();
}

std::string string_of(const Value& value) {
    return value.IsString() ? value.Get<std::string>() : std::string();
}

Texture texture_of(const Value& words, const char* key, GltfPictureReader& pictures) {
    Texture out;
    if (words.IsBool())
        return out;
    const ColorSpace space =
        truth(member(words, "linear"), key) ? ColorSpace::Linear : ColorSpace::Srgb;
    const auto index = [key](const Value& value) {
        return static_cast<int>(number_in(value, key, 0, 2147483647.0));
    };
    out.picture = words.Has("view") ? pictures.view(index(member(words, "view")), space,
                                                    string_of(member(words, "name")))
                                    : pictures.image(index(member(words, "image")), space);
    if (hex16(out.picture->hash) != string_of(member(words, "hash")))
        refuse(key);
    out.channel = choice(member(words, "channel"), key, TextureChannel::Luma);
    out.extension = choice(member(words, "extension"), key, TextureExtension::Mirror);
    out.interpolation = truth(member(words, "closest"), key) ? TextureInterpolation::Closest
                                                             : TextureInterpolation::Linear;
    read_list(member(words, "to_picture"), key, -kAny, std::span<double, 6>(out.to_picture));
    read_list(member(words, "scale"), key, -kAny, std::span<double, 3>(&out.scale.x, 3));
    read_list(member(words, "offset"), key, -kAny, std::span<double, 3>(&out.offset.x, 3));
    return out;
}

void add(const Value& words, GltfPictureReader& pictures, Material& material, int depth) {
    for (const NumberWord& word : kNumbers) {
        if (words.Has(word.key))
            material.*word.field = number_in(words.Get(word.key), word.key, word.low, word.high);
    }
    for (const auto& [key, field] : kColorFields) {
        if (words.Has(key))
            read_list(words.Get(key), key, 0, std::span<double, 3>(&(material.*field).x, 3));
    }
    for (const auto& [key, field] : kTextureFields) {
        if (words.Has(key))
            material.*field = texture_of(words.Get(key), key, pictures);
    }
    if (words.Has("vertex_colors"))
        material.vertex_colors = truth(words.Get("vertex_colors"), "vertex_colors");
    if (words.Has("alpha_mode"))
        material.alpha_mode = choice(words.Get("alpha_mode"), "alpha_mode", AlphaMode::Clip);
    if (words.Has("other")) {
        if (depth >= kMostMixtures)
            refuse("other");
        auto other = std::make_shared<Material>();
        add(words.Get("other"), pictures, *other, depth + 1);
        other->name = string_of(member(words.Get("other"), "name"));
        material.other = std::move(other);
    }
}

}  // namespace

Value extras_of_material(const Material& material, const Material& seen,
                         GltfPictureWriter& pictures) {
    Value::Object words = difference(material, seen, pictures, 0);
    if (words.empty())
        return {};
    words["of"] = Value(hex16(hash_of(seen)));
    return Value(Value::Object{{"lodestone", Value(std::move(words))}});
}

bool apply_material_extras(const Value& words, GltfPictureReader& pictures, Material& seen) {
    if (string_of(member(words, "of")) != hex16(hash_of(seen)))
        return false;
    try {
        Material whole = seen;
        add(words, pictures, whole, 0);
        seen = std::move(whole);
        return true;
    } catch (const Error&) {
        return false;
    }
}

}  // namespace lodestone::format
