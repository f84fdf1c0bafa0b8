// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/baked_textures.h"
#include "format/obj/mtl.h"
#include "format/obj/mtl_map.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace lodestone::format {
namespace {

class LibraryWriter {
public:
    MaterialLibrary write(std::span<const Material> materials) {
        const std::vector<std::string> names = mtl_names(materials);
        out_.text = "# Lodestone\n";
        for (size_t i = 0; i < materials.size(); ++i) {
            out_.text += "newmtl " + names[i] + '\n';
            add(materials[i]);
        }
        return std::move(out_);
    }

private:
    void number(std::string_view word, double value) {
        out_.text += word;
        put_number(out_.text, value);
        out_.text += '\n';
    }

    void color(const char* word, const glm::dvec3& value) {
        out_.text += word;
        for (int c = 0; c < 3; ++c)
            put_number(out_.text, value[c]);
        out_.text += '\n';
    }

    void add(const Material& m) {
        const BakedTexture base =
            drawn(m.base_color_texture, ColorSpace::Srgb, TextureChannel::Color, false);
        color("Kd", base.texture ? glm::dvec3(1.0) : m.base_color);
        const BakedTexture glow =
            drawn(m.emission_texture, ColorSpace::Srgb, TextureChannel::Color, true);
        color("Ke", glow.texture ? glm::dvec3(glow.limit) : m.emission);
        for (const MtlShare& share : kMtlShares) {
            if (share.needs == nullptr || m.*share.needs > 0)
                number(share.word, m.*share.member);
        }
        map("map_Kd", base.texture);
        map("map_Ke", glow.texture);
        map("map_Pr", drawn(m.roughness_texture, ColorSpace::Linear, TextureChannel::Luma).texture);
        map("map_Pm", drawn(m.metallic_texture, ColorSpace::Linear, TextureChannel::Luma).texture);
        const Texture normal =
            drawn(m.normal_texture, ColorSpace::Linear, TextureChannel::Color).texture;
        map("norm", normal, m.normal_strength);
        // Blender and others look for normals here.
        map("map_Bump",
            m.bump_texture ? drawn(m.bump_texture, ColorSpace::Linear, TextureChannel::Luma).texture
                           : normal,
            m.bump_texture ? m.bump_distance / kBumpMetres : m.normal_strength);
        add_cover(m);
    }

    void add_cover(const Material& m) {
        if (m.transmission > 0) {
            out_.text += "illum 7\n";
            color("Tf", m.base_color);
            number("Ni", m.ior);
            number("d", 1 - m.transmission);
        } else if (m.alpha_mode != AlphaMode::Opaque && (m.alpha < 1 || m.alpha_texture)) {
            const Texture cover =
                drawn(m.alpha_texture, ColorSpace::Linear, TextureChannel::Alpha).texture;
            out_.text += "illum 9\n";
            number("d", cover ? 1 : m.alpha);
            map("map_d", cover);
        }
    }

    void map(const char* word, const Texture& texture, double strength = 1) {
        if (!texture)
            return;
        out_.text += word;
        if (strength != 1) {
            out_.text += " -bm";
            put_number(out_.text, strength);
        }
        const std::string name = file_name(*texture.picture);
        out_.text += map_options(texture).value() + ' ' + name + '\n';
        out_.pictures.emplace(name, texture.picture);
    }

    /// The texture in the words of MTL: the picture's own values times `limit`; for Luma its one
    /// number; for Alpha that, or the picture's alpha if it has one. It has no picture when that
    /// fails.
    BakedTexture drawn(const Texture& texture, ColorSpace space, TextureChannel channel,
                       bool bright = false) {
        if (!texture || texture.picture->bytes.empty())
            return {};
        const bool covered = texture.picture->mean.w < 1;
        const bool gray =
            texture.channel == TextureChannel::Luma || texture.channel == TextureChannel::Color;
        const bool plain = channel == TextureChannel::Color
                               ? texture.channel == TextureChannel::Color
                           : channel == TextureChannel::Luma ? gray
                           : covered ? texture.channel == TextureChannel::Alpha
                                     : gray;
        if (plain &&
            (texture.picture->space == space || texture.channel == TextureChannel::Alpha) &&
            texture.scale == glm::dvec3(1.0) && texture.offset == glm::dvec3(0.0) &&
            map_options(texture))
            return {texture, 1};
        Recipe recipe = color_recipe(texture);
        if (channel != TextureChannel::Color)
            recipe[0] = recipe[1] = recipe[2] = {&texture};
        const std::optional<BakedTexture> baked = bake_recipe(recipe, space, bright);
        return baked && map_options(baked->texture) ? *baked : BakedTexture{};
    }

    MaterialLibrary out_;
};

}  // namespace

std::vector<std::string> mtl_names(std::span<const Material> materials) {
    std::vector<std::string> names;
    std::set<std::string> taken;
    std::map<std::string, size_t> counts;  // of equal names: thousands must not be tried in turn
    for (size_t i = 0; i < materials.size(); ++i) {
        std::string name = materials[i].name;
        for (char& c : name) {
            if (static_cast<unsigned char>(c) <= ' ' || c == '\\' || c == '#' || c == 0x7f)
                c = '_';
        }
        if (name.empty())
            name = "material";
        std::string unique = name;
        for (size_t& k = counts[name]; !taken.insert(unique).second;)
            unique = text(name, "_", ++k + 1);
        names.push_back(std::move(unique));
    }
    return names;
}

MaterialLibrary write_mtl(std::span<const Material> materials) {
    return LibraryWriter().write(materials);
}

}  // namespace lodestone::format
