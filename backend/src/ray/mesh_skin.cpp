// SPDX-License-Identifier: GPL-3.0-or-later
#include "ray/mesh_skin.h"

#include "image/texture_sampler.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace lodestone::ray {
namespace {

// An alpha that is this near to 1 everywhere is 1.
// Law: half of a picture's rounding to 8 bits.
constexpr double kOpaque = 1 - 1.0 / 512;

template <typename T>
T interpolated(const std::vector<T>& values, const Triangle& t, double u, double v) {
    const auto a = static_cast<float>(u);
    const auto b = static_cast<float>(v);
    return (1 - a - b) * values[t.x] + a * values[t.y] + b * values[t.z];
}

double share(double value) {
    return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 1.0;
}

/// An alpha that comes from the picture's own channel and is 1 in all of it.
bool covers_all(const Texture& texture, const image::TexelsPtr& texels) {
    return texels && texture.channel == TextureChannel::Alpha &&
           texture.extension != TextureExtension::Clip && texture.scale.x == 1 &&
           texture.offset.x == 0 && texels->least.w >= kOpaque;
}

}  // namespace

struct MeshSkin::Slot {
    using TextureSampler = image::TextureSampler;

    Material material;
    TextureSampler color;
    TextureSampler roughness;
    TextureSampler metallic;
    TextureSampler emission;
    TextureSampler alpha;
    TextureSampler mix;
    bool cut_by_texel = false;  // the alpha sampler gives the share that is there, not the alpha
    bool opaque = true;         // opaque but for vertex colors
    std::unique_ptr<Slot> other;

    Slot(const Material& source, image::TexelCache& texels)
        : material(source),
          color(source.base_color_texture, source.base_color, texels.of(source.base_color_texture)),
          roughness(source.roughness_texture, glm::dvec3(source.roughness),
                    texels.of(source.roughness_texture)),
          metallic(source.metallic_texture, glm::dvec3(source.metallic),
                   texels.of(source.metallic_texture)),
          emission(source.emission_texture, source.emission, texels.of(source.emission_texture)),
          alpha(Texture{}, glm::dvec3(source.alpha), nullptr),
          mix(source.mix_texture, glm::dvec3(source.mix), texels.of(source.mix_texture)) {
        if (material.alpha_mode != AlphaMode::Opaque)
            prepare_alpha(texels);
        if (source.other)
            other = std::make_unique<Slot>(*source.other, texels);
    }

    void prepare_alpha(image::TexelCache& texels) {
        const Texture& texture = material.alpha_texture;
        const image::TexelsPtr plain = texels.of(texture);
        alpha = TextureSampler(texture, glm::dvec3(material.alpha), plain);
        const bool clip = material.alpha_mode == AlphaMode::Clip;
        opaque = plain ? covers_all(texture, plain) && !(clip && material.alpha_cutoff > kOpaque)
                       : (clip ? material.alpha >= material.alpha_cutoff : material.alpha >= 1);
        // Texels that stand for blocks must be cut before they are averaged. (Vertex colors come
        // after the texture; outside a clipped picture there is no texel to cut.)
        const bool there_outside = texture.extension == TextureExtension::Clip &&
                                   texture.offset.x >= material.alpha_cutoff;
        if (clip && plain && plain->reduced && !opaque && !material.vertex_colors &&
            !there_outside) {
            Texture shares = texture;
            shares.channel = TextureChannel::Red;
            shares.scale = glm::dvec3(1);
            shares.offset = glm::dvec3(0);
            alpha = TextureSampler(shares, glm::dvec3(material.alpha),
                                   texels.at_least(texture, material.alpha_cutoff));
            cut_by_texel = true;
        }
    }

    bool textured() const {
        return color || roughness || metallic || emission || mix || (other && other->textured());
    }
    bool colored() const { return material.vertex_colors || (other && other->colored()); }
    bool sees_through(bool colors) const {
        const bool own = material.alpha_mode != AlphaMode::Opaque &&
                         (!opaque || (colors && material.vertex_colors));
        return own || (other && other->sees_through(colors));
    }

    /// Whether points of one triangle may have different alphas.
    bool alpha_varies(bool uvs, bool colors) const {
        const bool own = material.alpha_mode != AlphaMode::Opaque &&
                         ((uvs && alpha) || (colors && material.vertex_colors));
        return own || (other && ((uvs && mix) || other->alpha_varies(uvs, colors)));
    }

    double mixed(const std::optional<glm::dvec2>& uv) const {
        return share(uv && mix ? mix.number(*uv) : material.mix);
    }

    SurfaceAppearance at(const std::optional<glm::dvec2>& uv, const glm::dvec4& tint) const {
        SurfaceAppearance out{material.base_color, material.emission, material.roughness,
                              material.metallic, material.specular};
        if (uv) {
            out.color = color.color(*uv);
            out.emission = emission.color(*uv);
            out.roughness = share(roughness.number(*uv));
            out.metallic = share(metallic.number(*uv));
        }
        if (material.vertex_colors)
            out.color *= glm::dvec3(tint);
        if (!other)
            return out;
        const SurfaceAppearance second = other->at(uv, tint);
        const double t = mixed(uv);
        out.color = glm::mix(out.color, second.color, t);
        out.emission = glm::mix(out.emission, second.emission, t);
        out.roughness = glm::mix(out.roughness, second.roughness, t);
        out.metallic = glm::mix(out.metallic, second.metallic, t);
        out.specular = glm::mix(out.specular, second.specular, t);
        return out;
    }

    double own_alpha(const std::optional<glm::dvec2>& uv, const glm::dvec4& tint) const {
        if (material.alpha_mode == AlphaMode::Opaque)
            return 1;
        const bool looked_up = uv && alpha;
        double value = looked_up ? alpha.number(*uv) : material.alpha;
        if (material.vertex_colors)
            value *= tint.w;
        value = share(value);
        if (material.alpha_mode == AlphaMode::Blend || (looked_up && cut_by_texel))
            return value;
        return value >= material.alpha_cutoff ? 1 : 0;
    }

    double alpha_at(const std::optional<glm::dvec2>& uv, const glm::dvec4& tint) const {
        const double own = own_alpha(uv, tint);
        return other ? glm::mix(own, other->alpha_at(uv, tint), mixed(uv)) : own;
    }

    double transmission() const {
        const double own = share(material.transmission) * (1 - share(material.metallic));
        return other ? glm::mix(own, other->transmission(), share(material.mix)) : own;
    }
};

MeshSkin::MeshSkin(std::span<const Material> materials, image::TexelCache& texels)
    : otherwise_(std::make_unique<Slot>(Material{}, texels)) {
    slots_.reserve(materials.size());
    for (const Material& material : materials)
        slots_.emplace_back(material, texels);
}

MeshSkin::~MeshSkin() = default;

const MeshSkin::Slot& MeshSkin::slot(uint16_t index) const {
    return index < slots_.size() ? slots_[index] : *otherwise_;
}

const Material& MeshSkin::material(uint16_t index) const {
    return slot(index).material;
}

bool MeshSkin::varies(const Mesh& mesh, uint16_t index) const {
    const Slot& own = slot(index);
    return (!mesh.uvs.empty() && own.textured()) || (!mesh.colors.empty() && own.colored());
}

bool MeshSkin::textured(const Mesh& mesh, uint16_t index) const {
    return !mesh.uvs.empty() && lodestone::textured(slot(index).material);
}

bool MeshSkin::see_through(const Mesh& mesh) const {
    const bool colors =
        std::any_of(mesh.colors.begin(), mesh.colors.end(),
                    [](const glm::vec4& color) { return static_cast<double>(color.w) < kOpaque; });
    std::vector<uint8_t> through(slots_.size(), 0);
    for (size_t i = 0; i < through.size(); ++i)
        through[i] = slots_[i].sees_through(colors) ? 1 : 0;
    if (std::find(through.begin(), through.end(), 1) == through.end())
        return false;
    if (mesh.slots.empty())
        return !mesh.empty() && through[0] != 0;
    return std::any_of(mesh.slots.begin(), mesh.slots.end(), [&](uint16_t index) {
        return index < through.size() && through[index] != 0;
    });
}

bool MeshSkin::transmits() const {
    return std::any_of(slots_.begin(), slots_.end(),
                       [](const Slot& own) { return own.transmission() > 0; });
}

namespace {

/// The facts about a point that the look-ups of its mesh need.
struct SkinLookup {
    std::optional<glm::dvec2> uv;
    glm::dvec4 tint{1.0};

    SkinLookup(const Mesh& mesh, uint32_t triangle, double u, double v) {
        const Triangle& t = mesh.triangles[triangle];
        if (!mesh.uvs.empty())
            uv = glm::dvec2(interpolated(mesh.uvs, t, u, v));
        if (!mesh.colors.empty())
            tint = glm::dvec4(interpolated(mesh.colors, t, u, v));
    }
};

}  // namespace

SurfaceAppearance MeshSkin::mean(uint16_t index) const {
    return slot(index).at(std::nullopt, glm::dvec4(1.0));
}

SurfaceAppearance MeshSkin::at(const Mesh& mesh, uint32_t triangle, double u, double v) const {
    const SkinLookup place(mesh, triangle, u, v);
    return slot(mesh.slot(triangle)).at(place.uv, place.tint);
}

double MeshSkin::alpha(const Mesh& mesh, uint32_t triangle, double u, double v) const {
    const Slot& own = slot(mesh.slot(triangle));
    if (!own.sees_through(!mesh.colors.empty()))
        return 1;
    const SkinLookup place(mesh, triangle, u, v);
    return own.alpha_at(place.uv, place.tint);
}

std::optional<double> MeshSkin::uniform_alpha(const Mesh& mesh, uint16_t index) const {
    const Slot& own = slot(index);
    const bool colors = !mesh.colors.empty();
    if (!own.sees_through(colors))
        return 1;
    if (own.alpha_varies(!mesh.uvs.empty(), colors))
        return std::nullopt;
    return own.alpha_at(std::nullopt, glm::dvec4(1));
}

double MeshSkin::opacity(const Mesh& mesh, uint32_t triangle, double u, double v) const {
    return alpha(mesh, triangle, u, v) * (1 - slot(mesh.slot(triangle)).transmission());
}

glm::dvec2 uv_at(const Mesh& mesh, uint32_t triangle, double u, double v) {
    return glm::dvec2(interpolated(mesh.uvs, mesh.triangles[triangle], u, v));
}

}  // namespace lodestone::ray
