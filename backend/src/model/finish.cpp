// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/finish.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone {
namespace {

/// Whether a field belongs to the finish. A new field belongs to the look, which is always right.
template <typename Value>
bool is_finish(Value Material::*) {
    return false;
}
bool is_finish(double Material::*field) {
    return field == &Material::roughness || field == &Material::metallic ||
           field == &Material::specular || field == &Material::ior ||
           field == &Material::clearcoat || field == &Material::clearcoat_roughness ||
           field == &Material::normal_strength || field == &Material::bump_distance;
}
bool is_finish(Texture Material::*field) {
    return field == &Material::roughness_texture || field == &Material::metallic_texture ||
           field == &Material::normal_texture || field == &Material::bump_texture;
}

/// Sampling noise may leave a mean outside its range by a rounding; a value that is not a number
/// becomes `usual`.
double within(double value, double usual) {
    return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : usual;
}

}  // namespace

Hash look_hash_of(const Material& material) {
    Hasher hasher;
    for_each_field([&](const auto& field) {
        const auto& value = material.*field.member;
        using Value = std::decay_t<decltype(value)>;
        const bool finish = is_finish(field.member);
        if constexpr (std::is_same_v<Value, Texture>) {
            hasher.value(finish ? Hash{value ? 1u : 0u} : hash_of(value));
        } else if constexpr (std::is_same_v<Value, glm::dvec3>) {
            hasher.value(value.x).value(value.y).value(value.z);
        } else if constexpr (std::is_same_v<Value, std::shared_ptr<const Material>>) {
            hasher.value(value ? look_hash_of(*value) : Hash{0});
        } else {
            if (!finish)
                hasher.value(value);
        }
    });
    if (material.transmission > 0)
        hasher.value(material.ior).value(material.metallic);
    return hasher.result();
}

Material with_finish(Material material, const Material& finish) {
    for_each_field([&](const auto& field) {
        if (is_finish(field.member))
            material.*field.member = finish.*field.member;
    });
    if (material.other && finish.other)
        material.other =
            std::make_shared<const Material>(with_finish(*material.other, *finish.other));
    return material;
}

SolidFinish mean_finish(const Material& material) {
    SolidFinish out{material.roughness, material.metallic, material.specular};
    if (!material.other)
        return out;
    const SolidFinish second = mean_finish(*material.other);
    const double t = within(material.mix, 1);
    out.roughness = glm::mix(out.roughness, second.roughness, t);
    out.metallic = glm::mix(out.metallic, second.metallic, t);
    out.specular = glm::mix(out.specular, second.specular, t);
    return out;
}

void set_finish(Attributes& attributes, const SolidFinish& finish) {
    attributes.roughness = finish.roughness;
    attributes.metallic = finish.metallic;
    attributes.specular = finish.specular;
}

void set_finish(Material& material, const SolidFinish& finish) {
    const Material usual;
    material.roughness = within(finish.roughness, usual.roughness);
    material.metallic = within(finish.metallic, usual.metallic);
    material.specular = within(finish.specular, usual.specular);
}

Material without_textures(Material material) {
    for_own_textures(material, [](Texture& texture) { texture = Texture{}; });
    if (material.other)
        material.other = std::make_shared<const Material>(without_textures(*material.other));
    return material;
}

}  // namespace lodestone
