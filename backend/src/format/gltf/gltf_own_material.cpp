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

// The most mixtures one in another.
// Taste: each nests the JSON one deeper, of which gltf_file.cpp reads 64.
constexpr int kMostMixtures = 32;
// The largest number of a list (a color, a texture's mapping) that is believed.
// Taste: nearly any double; a larger value lets products of such numbers overflow sooner.
constexpr double kAny = 1e300;

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

/// Writes every field where two materials differ.
class MaterialDifference {
public:
    MaterialDifference(const Material& material, const Material& seen, GltfPictureWriter& pictures,
                       int depth = 0)
        : material_(material), seen_(seen), pictures_(pictures), depth_(depth) {}

    Value::Object words() {
        for_each_field([this](const auto& field) {
            say(field, material_.*field.member, seen_.*field.member);
        });
        return std::move(out_);
    }

private:
    void say(const MaterialField<double>& field, double number, double seen) {
        if (!same_bits(number, seen) && number >= field.believed.low &&
            number <= field.believed.high)
            out_[field.key] = Value(number);
    }
    void say(const MaterialField<glm::dvec3>& field, const glm::dvec3& color,
             const glm::dvec3& seen) {
        bool same = true;
        for (int i = 0; i < 3; ++i)
            same = same && same_bits(color[i], seen[i]);
        if (!same && finite(numbers_of(color)))
            out_[field.key] = list_of(numbers_of(color));
    }
    void say(const MaterialField<Texture>& field, const Texture& texture, const Texture& seen) {
        if (hash_of(texture) == hash_of(seen))
            return;
        if (sayable(texture))
            out_[field.key] = words_of(texture, pictures_);
        else if (!texture)
            out_[field.key] = Value(false);
    }
    void say(const MaterialField<bool>& field, bool truth, bool seen) {
        if (truth != seen)
            out_[field.key] = Value(truth);
    }
    void say(const MaterialField<AlphaMode>& field, AlphaMode mode, AlphaMode seen) {
        if (mode != seen)
            out_[field.key] = Value(static_cast<int>(mode));
    }
    /// glTF has no words for mixtures: what is seen has no other.
    void say(const MaterialField<std::shared_ptr<const Material>>& field,
             const std::shared_ptr<const Material>& other, const std::shared_ptr<const Material>&) {
        if (!other || depth_ >= kMostMixtures)
            return;
        const Material standard;
        Value::Object words = MaterialDifference(*other, standard, pictures_, depth_ + 1).words();
        words["name"] = Value(valid_utf8(other->name));
        out_[field.key] = Value(std::move(words));
    }

    const Material& material_;
    const Material& seen_;
    GltfPictureWriter& pictures_;
    int depth_;
    Value::Object out_;
};

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

/// Adds the fields that the words of a file have.
class MaterialAddition {
public:
    MaterialAddition(const Value& words, GltfPictureReader& pictures, int depth = 0)
        : words_(words), pictures_(pictures), depth_(depth) {}

    void add_to(Material& material) const {
        for_each_field([&](const auto& field) {
            if (words_.Has(field.key))
                read(field, words_.Get(field.key), material.*field.member);
        });
    }

private:
    static void read(const MaterialField<double>& field, const Value& value, double& number) {
        number = number_in(value, field.key, field.believed.low, field.believed.high);
    }
    static void read(const MaterialField<glm::dvec3>& field, const Value& value,
                     glm::dvec3& color) {
        read_list(value, field.key, field.believed.low, std::span<double, 3>(&color.x, 3));
    }
    void read(const MaterialField<Texture>& field, const Value& value, Texture& texture) const {
        texture = texture_of(value, field.key, pictures_);
    }
    static void read(const MaterialField<bool>& field, const Value& value, bool& out) {
        out = truth(value, field.key);
    }
    static void read(const MaterialField<AlphaMode>& field, const Value& value, AlphaMode& mode) {
        mode = choice(value, field.key, AlphaMode::Clip);
    }
    void read(const MaterialField<std::shared_ptr<const Material>>& field, const Value& value,
              std::shared_ptr<const Material>& out) const {
        if (depth_ >= kMostMixtures)
            refuse(field.key);
        auto other = std::make_shared<Material>();
        MaterialAddition(value, pictures_, depth_ + 1).add_to(*other);
        other->name = string_of(member(value, "name"));
        out = std::move(other);
    }

    const Value& words_;
    GltfPictureReader& pictures_;
    int depth_;
};

}  // namespace

Value extras_of_material(const Material& material, const Material& seen,
                         GltfPictureWriter& pictures) {
    Value::Object words = MaterialDifference(material, seen, pictures).words();
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
        MaterialAddition(words, pictures).add_to(whole);
        seen = std::move(whole);
        return true;
    } catch (const Error&) {
        return false;
    }
}

}  // namespace lodestone::format
