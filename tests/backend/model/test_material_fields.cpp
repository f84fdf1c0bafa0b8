// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the list of a material's fields: each one is hashed, stored, and written to glTF and back.
#include "scenes/gltf_textured.h"
#include "segment/store_json.h"

#include <set>

namespace lodestone {
namespace {

using MaterialPtr = std::shared_ptr<const Material>;

// A value that no new material has.
void make_unusual(const MaterialField<glm::dvec3>& field, Material& material) {
    material.*field.member = {0.125, 1.0 / 3, 0.75};
}
void make_unusual(const MaterialField<double>& field, Material& material) {
    const NumberRange range = field.clamped;
    const bool bounded = range.low > -kInfinity && range.high < kInfinity;
    material.*field.member = bounded ? range.low + (range.high - range.low) / 7 : 1.0 / 7;
}
void make_unusual(const MaterialField<Texture>& field, Material& material) {
    Texture texture;
    texture.picture = models::checker();
    texture.channel = TextureChannel::Green;
    texture.scale = {0.5, 1.0 / 3, 2};
    material.*field.member = texture;
}
void make_unusual(const MaterialField<bool>& field, Material& material) {
    material.*field.member = !(material.*field.member);
}
void make_unusual(const MaterialField<AlphaMode>& field, Material& material) {
    material.*field.member = AlphaMode::Clip;
}
void make_unusual(const MaterialField<MaterialPtr>& field, Material& material) {
    material.*field.member =
        std::make_shared<const Material>(models::colored("other", {0.5, 0.25, 0.125}));
}

template <typename Value>
bool same(const Value& a, const Value& b) {
    if constexpr (std::is_same_v<Value, Texture>)
        return hash_of(a) == hash_of(b);
    else if constexpr (std::is_same_v<Value, MaterialPtr>)
        return a && b ? hash_of(*a) == hash_of(*b) && a->name == b->name : a == b;
    else
        return a == b;
}

/// A material where one field is unusual, with what the stores want beside it.
template <typename Field>
Material only_unusual(const Field& field) {
    Material material;
    make_unusual(field, material);
    if (field.presence == FieldPresence::WithAlphaMode)
        material.alpha_mode = AlphaMode::Clip;
    if (field.presence == FieldPresence::WithOther)
        material.other = std::make_shared<const Material>();
    return material;
}

Material stored_and_read(const Material& material) {
    const std::string text = segment::tileset_text(format::gltf_text::model_of(material));
    return segment::model_of_tileset(text).materials.at(0);
}

}  // namespace

TEST(MaterialFields, HaveNamesOfTheirOwn) {
    std::set<std::string> keys;
    size_t count = 0;
    for_each_field([&](const auto& field) {
        keys.insert(field.key);
        ++count;
    });
    EXPECT_EQ(keys.size(), count);
}

TEST(MaterialFields, UsualValuesLieInTheirRanges) {
    const Material standard;
    for_each_field_of<double>([&](const MaterialField<double>& field) {
        for (const NumberRange& range : {field.clamped, field.believed}) {
            EXPECT_GE(standard.*field.member, range.low) << field.key;
            EXPECT_LE(standard.*field.member, range.high) << field.key;
        }
    });
}

TEST(MaterialFields, EachChangesTheHash) {
    for_each_field([](const auto& field) {
        Material material = only_unusual(field);
        const Hash changed = hash_of(material);
        material.*field.member = Material().*field.member;
        EXPECT_NE(hash_of(material), changed) << field.key;
    });
}

TEST(MaterialFields, EachComesBackFromAStore) {
    for_each_field([](const auto& field) {
        const Material material = only_unusual(field);
        ASSERT_FALSE(same(material.*field.member, Material().*field.member)) << field.key;
        const Material back = stored_and_read(material);
        EXPECT_TRUE(same(back.*field.member, material.*field.member)) << field.key;
        EXPECT_EQ(hash_of(back), hash_of(material)) << field.key;
    });
}

TEST(MaterialFields, EachComesBackFromGltf) {
    for_each_field([](const auto& field) {
        const Material material = only_unusual(field);
        const Material back =
            format::gltf_text::back_of(format::write_glb(format::gltf_text::model_of(material)));
        EXPECT_TRUE(same(back.*field.member, material.*field.member)) << field.key;
        EXPECT_EQ(hash_of(back), hash_of(material)) << field.key;
    });
}

TEST(MaterialFields, NumbersAreBroughtIntoTheirRanges) {
    for_each_field_of<double>([](const MaterialField<double>& field) {
        for (const double wild : {-1e9, 1e9}) {
            Material material;
            material.*field.member = wild;
            clamp_numbers(material);
            EXPECT_GE(material.*field.member, field.clamped.low) << field.key;
            EXPECT_LE(material.*field.member, field.clamped.high) << field.key;
        }
    });
}

}  // namespace lodestone
