// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/material.h"

#include <algorithm>

namespace lodestone {

namespace {

// Any converts to every type, so that a struct has as many members as there are Anys to make it of.
// One more than are listed gives away a member that is not in the list.
struct Any {
    template <typename Value>
    operator Value() const;
};
template <typename Struct, typename... Anys>
constexpr size_t member_count() {
    if constexpr (requires { Struct{Anys{}..., Any{}}; })
        return member_count<Struct, Anys..., Any>();
    else
        return sizeof...(Anys);
}
constexpr size_t listed_count() {
    size_t count = 0;
    for_each_field([&](const auto&) { ++count; });
    return count;
}
static_assert(member_count<Material>() == listed_count() + 1,
              "a member of Material, besides its name, is not in LODESTONE_MATERIAL_FIELDS");

}  // namespace

void clamp_numbers(Material& material) {
    for_each_field_of<double>([&](const MaterialField<double>& field) {
        double& number = material.*field.member;
        number = std::clamp(number, field.clamped.low, field.clamped.high);
    });
}

Hash hash_of(const Material& material) {
    Hasher hasher;
    for (int i = 0; i < 3; ++i) {
        for_each_field_of<glm::dvec3>([&](const MaterialField<glm::dvec3>& field) {
            hasher.value((material.*field.member)[i]);
        });
    }
    for_each_field_of<Texture>([&](const MaterialField<Texture>& field) {
        hasher.value(hash_of(material.*field.member));
    });
    for_each_field([&](const auto& field) {
        const auto& value = material.*field.member;
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, std::shared_ptr<const Material>>)
            hasher.value(value ? hash_of(*value) : Hash{0});
        else if constexpr (!std::is_same_v<Value, glm::dvec3> && !std::is_same_v<Value, Texture>)
            hasher.value(value);
    });
    return hasher.result();
}

bool textured(const Material& material) {
    bool found = false;
    for_each_texture(material, [&](const Texture&) { found = true; });
    return found;
}

}  // namespace lodestone
