// SPDX-License-Identifier: GPL-3.0-or-later
// Material: what a surface looks like, in the terms of the principled model.
#pragma once

#include "base/maths.h"
#include "model/texture.h"

#include <string>
#include <type_traits>

namespace lodestone {

/// The meaning of an alpha below 1.
enum class AlphaMode : uint8_t {
    Opaque = 0,  // nothing
    Blend = 1,   // the surface covers that share of what is behind it
    Clip = 2,    // it is there where alpha >= alpha_cutoff, and nowhere else
};

/// A number or color that has a texture is the texture's value; the field beside it holds the mean,
/// which is what everything that looks at no texture uses. Numbers are 0...1 unless said otherwise.
struct Material {
    std::string name;            // the user's; any bytes
    glm::dvec3 base_color{0.8};  // linear Rec.709
    double roughness = 0.5;      // perceptual (alpha = roughness squared)
    double metallic = 0;
    double specular = 0.5;     // 0.5 is an index of refraction of 1.45
    glm::dvec3 emission{0.0};  // linear, W/(sr m^2)

    Texture base_color_texture;
    Texture roughness_texture;
    Texture metallic_texture;
    Texture emission_texture;
    bool vertex_colors = false;  // base color (its texture's too) times Mesh::colors, alpha too

    double alpha = 1;
    Texture alpha_texture;
    AlphaMode alpha_mode = AlphaMode::Opaque;
    double alpha_cutoff = 0.5;

    double transmission = 0;  // share of light that is refracted instead of scattered
    double ior = 1.45;        // > 0; of what is refracted
    double clearcoat = 0;
    double clearcoat_roughness = 0.03;

    Texture normal_texture;  // tangent space, 0...1 for -1...1, green up
    double normal_strength = 1;
    Texture bump_texture;      // height: channel's value times bump_distance
    double bump_distance = 0;  // metres from black to white; below 0 inward

    /// Mixed with another one (which may be mixed, too; kMostMixtures at most): shading is (1 -
    /// mix) of this and mix of that.
    std::shared_ptr<const Material> other;
    double mix = 0;
    Texture mix_texture;
};

/// The most materials that are mixed one in another.
/// Taste: deeper ones are a mistake or an attack; a larger number needs more stack.
inline constexpr int kMostMixtures = 64;

/// The numbers that a field of a material may have.
struct NumberRange {
    double low = 0;
    double high = 1;
};
inline constexpr NumberRange kAnyNumber{-kInfinity, kInfinity};
/// Taste: nearly all doubles; a larger value lets products of such numbers overflow sooner.
inline constexpr NumberRange kFiniteNumber{-1e300, 1e300};
/// Taste: as kFiniteNumber.
inline constexpr NumberRange kPositiveNumber{0, 1e300};
inline constexpr NumberRange kShare{};

/// When a store says a field. It is what the formats of earlier stores have.
enum class FieldPresence : uint8_t {
    Always,
    Unusual,        // where it differs from that of a new Material
    WithAlphaMode,  // where the alpha mode is not Opaque
    WithOther,      // where there is another material
};

/// All fields of Material but its name, in the order in which they are hashed: the name, when a
/// store says it, the range that clamp_numbers() brings it into, and the range that our glTF files
/// may hold. Whatever copies, stores, reads or hashes materials goes by this list, so that a field
/// is listed here and nowhere else.
#define LODESTONE_MATERIAL_FIELDS(FIELD)                                      \
    FIELD(base_color, Always, kAnyNumber, kPositiveNumber)                    \
    FIELD(emission, Always, kAnyNumber, kPositiveNumber)                      \
    FIELD(base_color_texture, Unusual, kAnyNumber, kAnyNumber)                \
    FIELD(roughness_texture, Unusual, kAnyNumber, kAnyNumber)                 \
    FIELD(metallic_texture, Unusual, kAnyNumber, kAnyNumber)                  \
    FIELD(emission_texture, Unusual, kAnyNumber, kAnyNumber)                  \
    FIELD(alpha_texture, Unusual, kAnyNumber, kAnyNumber)                     \
    FIELD(normal_texture, Unusual, kAnyNumber, kAnyNumber)                    \
    FIELD(bump_texture, Unusual, kAnyNumber, kAnyNumber)                      \
    FIELD(mix_texture, WithOther, kAnyNumber, kAnyNumber)                     \
    FIELD(roughness, Always, kShare, kShare)                                  \
    FIELD(metallic, Always, kShare, kShare)                                   \
    FIELD(specular, Always, kShare, kPositiveNumber)                          \
    FIELD(vertex_colors, Unusual, kAnyNumber, kAnyNumber)                     \
    FIELD(alpha, Unusual, kShare, kShare)                                     \
    FIELD(alpha_mode, Unusual, kAnyNumber, kAnyNumber)                        \
    FIELD(alpha_cutoff, WithAlphaMode, kShare, kFiniteNumber)                 \
    FIELD(transmission, Unusual, kShare, kShare)                              \
    FIELD(ior, Unusual, (NumberRange{0.1, 10}), (NumberRange{1e-300, 1e300})) \
    FIELD(clearcoat, Unusual, kShare, kShare)                                 \
    FIELD(clearcoat_roughness, Unusual, kShare, kShare)                       \
    FIELD(normal_strength, Unusual, (NumberRange{0, 10}), kFiniteNumber)      \
    FIELD(bump_distance, Unusual, kAnyNumber, kFiniteNumber)                  \
    FIELD(other, Unusual, kAnyNumber, kAnyNumber)                             \
    FIELD(mix, WithOther, kShare, kShare)

/// A field of Material: its name in files and in the C interface, and where it is.
template <typename Value>
struct MaterialField {
    const char* key;
    Value Material::*member;
    FieldPresence presence;
    NumberRange clamped;
    NumberRange believed;
};

/// Calls visit(MaterialField<Value>) for every field in the order of the list. Value is glm::dvec3,
/// Texture, double, bool, AlphaMode or std::shared_ptr<const Material>: a visitor that is an
/// overload for each does not compile when a field of a new type comes.
template <typename Visit>
constexpr void for_each_field(Visit&& visit) {
#define LODESTONE_VISIT_FIELD(name, presence, clamped, believed)                                   \
    visit(MaterialField<decltype(Material::name)>{#name, &Material::name, FieldPresence::presence, \
                                                  clamped, believed});
    LODESTONE_MATERIAL_FIELDS(LODESTONE_VISIT_FIELD)
#undef LODESTONE_VISIT_FIELD
}

/// The same for the fields that are a Value.
template <typename Value, typename Visit>
constexpr void for_each_field_of(Visit&& visit) {
    for_each_field([&](const auto& field) {
        if constexpr (std::is_same_v<std::decay_t<decltype(field)>, MaterialField<Value>>)
            visit(field);
    });
}

/// Brings its own numbers, which are finite, into their ranges.
void clamp_numbers(Material& material);

/// The hash of everything but the names.
Hash hash_of(const Material& material);

/// Whether anything of it (or of what it is mixed with) is looked up by texture coordinates.
bool textured(const Material& material);

/// Calls visit(texture) for every texture it has, not those of the other. Material_ is Material or
/// const Material.
template <typename Material_, typename Visit>
void for_own_textures(Material_& material, const Visit& visit) {
    for_each_field_of<Texture>([&](const MaterialField<Texture>& field) {
        if (material.*field.member)
            visit(material.*field.member);
    });
}

/// The same, those of the other included.
template <typename Visit>
void for_each_texture(const Material& material, const Visit& visit) {
    for_own_textures(material, visit);
    if (material.other)
        for_each_texture(*material.other, visit);
}

}  // namespace lodestone
