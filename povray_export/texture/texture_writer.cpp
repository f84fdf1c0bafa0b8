// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/texture/texture_writer.h"

#include "povray_export/scene/povray_number.h"
#include "povray_export/texture/grazing_gloss.h"
#include "povray_export/texture/height_map.h"
#include "povray_export/texture/lamp_gloss.h"
#include "povray_export/texture/pigment_picture.h"
#include "povray_export/texture/surface_finish.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace lodestone::povray {
namespace {

// The steps of roughness whose textures are blended, for a finish cannot follow a picture.
// Taste: highlights change fastest where the surface is smooth; more steps write longer textures,
// which take longer to shade.
constexpr double kRoughnessSteps[] = {0, 0.1, 0.2, 0.35, 0.5, 0.75, 1};

// The darkest pigment. POV-Ray multiplies emission and the answer to the sky by the pigment, so a
// black one needs a trace of color.
// Taste: lit, it is never seen; a larger value makes black surfaces gray.
constexpr double kLeastPigment = 1e-4;

// The share of a surface that its veil covers: the layer that holds what has not the color of its
// picture.
// Taste: any small share, which the layer below makes up for; a larger value costs that one digits.
constexpr double kVeil = 1.0 / 64;

constexpr const char* kClear =
    "pigment{rgbt 1} finish{ambient 0 emission 0 diffuse 0 specular 0 reflection{rgb 0}}";

/// The part of what a surface mirrors more at no angle than in front that it mirrors of light from
/// all sides.
/// Law: the mean of (1 - cosine)^5, weighed by the cosine.
constexpr double kGrazingMean = 1.0 / 21;

double share(double value, double otherwise) {
    return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : otherwise;
}

/// The factor of all channels, where that is all that is done to them and about 1 (a picture cannot
/// hold more than 1); else 1.
double even_scale(const Texture& texture) {
    // The largest factor.
    // Taste: a larger value leaves more of the brightness to the finish.
    constexpr double kMost = 2;
    const glm::dvec3& scale = texture.scale;
    const bool even = std::abs(scale.x - scale.y) <= 1e-9 * std::abs(scale.x) &&
                      std::abs(scale.x - scale.z) <= 1e-9 * std::abs(scale.x);
    return even && texture.offset == glm::dvec3(0.0) && scale.x >= 1 / kMost && scale.x <= kMost
               ? scale.x
               : 1;
}

// The brightness of a picture's colors, about.
// Taste: a larger value lets lit surfaces around light pictures more where no light bounces.
constexpr double kUsualGray = 0.35;

/// The inside of texture{...} or of an entry of a texture_map.
using Body = std::string;

class TextureText {
public:
    TextureText(const TexturedSurface& surface, PictureWriter& pictures)
        : surface_(surface), pictures_(pictures) {}

    /// The whole text. A surface that hides what is behind it is no average where it need not be:
    /// POV-Ray takes averages and other maps of textures for transparent, so that a shadow ray asks
    /// for their color and goes on.
    std::string whole(const Material& material) {
        if (material.other || material.alpha_mode != AlphaMode::Opaque ||
            share(material.transmission, 0) > 0 || shown(material.roughness_texture) ||
            shown(material.metallic_texture))
            return "texture{" + mixed(material) + '}';
        const SolidSurface surface = surface_of(material, look_of(material), true);
        const bool mirror = surface.finish.mirror > 0 || surface.finish.mirror_grazing > 0;
        if (surface.lamp || !surface.plain || mirror)
            return "texture{" + solid(material, surface) + '}';
        std::string layers = "texture{" + surface.pigment;
        if (surface.gloss) {
            const GlossText gloss = gloss_layer(*surface.gloss, arriving());
            append_finish(layers, surface.finish, gloss.below, glm::dvec3(0.0));
            layers += "} texture{" + pictures_.declared_pigment(gloss.pigment) + ' ';
            return pictures_.layered(layers + normal(material) + gloss.finish + '}');
        }
        append_finish(layers, surface.finish, 1 / (1 - kVeil), glm::dvec3(0.0));
        Finish veil;
        veil.ambient = surface.white;
        append_number(layers += "} texture{pigment{rgbt <1,1,1,", 1 - kVeil, 6);
        append_finish(layers += ">} ", veil, 1 / kVeil, surface.even / kVeil);
        return pictures_.layered(layers + '}');
    }

    Body mixed(const Material& material) {
        if (!material.other)
            return covered(material);
        const double mix = share(material.mix, 0);
        if (shown(material.mix_texture))
            return blended(material.mix_texture,
                           {{0, covered(material)}, {1, mixed(*material.other)}});
        return average(covered(material), mixed(*material.other), mix);
    }

private:
    using Entries = std::vector<std::pair<double, Body>>;

    /// A surface without alpha, maps of numbers and glass, in parts that add up.
    struct SolidSurface {
        Body pigment;  // and the bumps
        Finish finish;
        bool lamp = false;   // it glows in a picture
        bool plain = false;  // what follows has not the color of the pigment
        /// The white gloss, if it follows the angle of view: then it is not in the finish.
        std::optional<GrazingGloss> gloss;
        glm::dvec3 white{0.0};  // the answer to a uniform sky, if there is no such gloss
        glm::dvec3 even{0.0};   // emission, and the same answer to lit surfaces around
    };

    /// The light that gloss shows.
    GlossLight arriving() const { return {share(surface_.sky, 1), surface_.around}; }

    bool shown(const Texture& texture) const { return texture && surface_.uvs; }

    /// `whole`: the picture is not made smaller.
    std::string pigment(const Texture& texture, PigmentContent content, bool whole = false) {
        UvRange range = surface_.range;
        if (whole)
            range.texel = 0;
        return "uv_mapping " + pictures_.pigment(texture, content, range);
    }

    /// The text of the bumps. POV-Ray's bump_map knows no direction of u, so the height is a
    /// pattern in space, laid on the plane of the surface: a slope of 1 needs an amount of 7.5
    /// (measured).
    std::string normal(const Material& material) {
        if (!surface_.flat)
            return "";
        std::string bump;
        std::string map;
        const bool both = shown(material.bump_texture) && shown(material.normal_texture);
        if (shown(material.bump_texture) && std::isfinite(material.bump_distance) &&
            material.bump_distance != 0)
            bump = relief(material.bump_texture, PigmentContent::Number,
                          std::clamp(material.bump_distance, -1e6, 1e6) * (both ? 2 : 1), 1);
        if (shown(material.normal_texture) && std::isfinite(material.normal_strength)) {
            const Texture& texture = material.normal_texture;
            const std::shared_ptr<const HeightMap> heights = height_map(texture);
            const glm::dvec2 size = picture_size(texture);
            // The width of a texel; where it is no square its slopes are true on average.
            const double wide = std::sqrt(size.x / heights->width * size.y / heights->height);
            map = relief(texture, PigmentContent::Height,
                         std::clamp(material.normal_strength, 0.0, 10.0) * heights->range * wide *
                             (both ? 2 : 1),
                         std::max(texture.picture->width / heights->width, 1));
        }
        if (bump.empty() && map.empty())
            return "";
        if (bump.empty() || map.empty())
            return "normal{" + bump + map + "} ";
        return "normal{average normal_map{[1 " + bump + "][1 " + map + "]}} ";
    }

    /// The metres of the whole picture across and along, on this plane.
    glm::dvec2 picture_size(const Texture& texture) const {
        const std::array<double, 6>& m = texture.to_picture;
        const glm::dmat3 rows = glm::transpose(surface_.to_uv.linear);
        return {1 / std::max(glm::length(m[0] * rows[0] + m[1] * rows[1]), 1e-9),
                1 / std::max(glm::length(m[3] * rows[0] + m[4] * rows[1]), 1e-9)};
    }

    /// The text of a relief. `height` is in metres for white; `texels` of the picture are covered
    /// by one of the pattern.
    std::string relief(const Texture& texture, PigmentContent content, double height, int texels) {
        const glm::dvec2 size = picture_size(texture);
        const double texel =
            std::min(size.x / texture.picture->width, size.y / texture.picture->height);
        std::string out =
            "pigment_pattern{" + pictures_.pigment(texture, content, surface_.range) + ' ';
        Affine from_uv;
        from_uv.linear = glm::inverse(surface_.to_uv.linear);
        from_uv.offset = -(from_uv.linear * surface_.to_uv.offset);
        append_matrix(out, from_uv);
        append_number(out += "} ", 7.5 * height, 6);
        append_number(out += " accuracy ", std::max(texels * texel / 2, 1e-9), 6);
        return out;
    }

    static Body map(const Entries& entries) {
        Body out = " texture_map{";
        for (const auto& [at, body] : entries) {
            out += '[';
            append_number(out, at, 6);
            out += ' ' + body + ']';
        }
        return out + '}';
    }

    /// Blends entries by the number of a texture.
    Body blended(const Texture& texture, const Entries& entries,
                 PigmentContent content = PigmentContent::Number, bool whole = false) {
        return "pigment_pattern{" + pigment(texture, content, whole) + '}' + map(entries);
    }

    /// The average: (1 - second) of a and second of b.
    static Body average(Body a, Body b, double second) {
        if (second <= 0 || a == b)
            return a;
        if (second >= 1)
            return b;
        return "average" + map({{1 - second, std::move(a)}, {second, std::move(b)}});
    }

    /// Covers a share of alpha of the surface; the other part is not there.
    Body covered(const Material& material) {
        Body body = rough(material);
        if (material.alpha_mode == AlphaMode::Opaque)
            return body;
        const double paint = material.vertex_colors ? share(surface_.color.w, 1) : 1;
        const double cutoff = share(material.alpha_cutoff, 0.5);
        const bool clip = material.alpha_mode == AlphaMode::Clip;
        if (!shown(material.alpha_texture)) {
            const double alpha = paint * share(material.alpha, 1);
            if (clip)
                return alpha >= cutoff ? body : kClear;
            return average(kClear, body, alpha);
        }
        if (!clip)
            return average(
                kClear,
                blended(material.alpha_texture, {{0, kClear}, {1, body}}, PigmentContent::Alpha),
                paint);
        if (cutoff <= 0)
            return body;
        const double least = paint > 0 ? cutoff / paint : 2;
        if (least > 1)
            return kClear;
        // Means of texels would lose what is thinner than they are.
        return blended(material.alpha_texture, {{least, kClear}, {least, body}},
                       PigmentContent::Number, true);
    }

    Body rough(const Material& material) {
        SurfaceLook look = look_of(material);
        if (!shown(material.roughness_texture))
            return metal(material, look);
        Entries entries;
        for (const double roughness : kRoughnessSteps) {
            look.roughness = roughness;
            entries.emplace_back(roughness, metal(material, look));
        }
        return blended(material.roughness_texture, entries);
    }

    Body metal(const Material& material, SurfaceLook look) {
        if (!shown(material.metallic_texture))
            return lit(material, look);
        look.metallic = 0;
        const Body dielectric = lit(material, look);
        look.metallic = 1;
        return blended(material.metallic_texture, {{0, dielectric}, {1, lit(material, look)}});
    }

    Body lit(const Material& material, const SurfaceLook& look) {
        const double through = share(material.transmission, 0) * (1 - look.metallic);
        if (through <= 0)
            return solid(material, surface_of(material, look));
        return average(solid(material, surface_of(material, look)), glass(material, look), through);
    }

    /// The text of glass. It filters by the base color where light enters and where it leaves; the
    /// index of refraction is the object's. Other than in a path tracer without caustics its shadow
    /// is bright.
    Body glass(const Material& material, const SurfaceLook& look) {
        Body out = "pigment{";
        if (shown(material.base_color_texture)) {
            out += pigment(material.base_color_texture, PigmentContent::Filter);
        } else {
            out += "rgbf <";
            for (int i = 0; i < 3; ++i) {
                const double paint = material.vertex_colors ? share(surface_.color[i], 1) : 1;
                append_number(out, paint * share(material.base_color[i], 0.8), 6);
                out += ',';
            }
            out += "1>";
        }
        out += "} " + normal(material);
        append_glass_finish(out, look);
        return out;
    }

    /// `layered`: what has not the color of the pigment may be a layer over it.
    SolidSurface surface_of(const Material& material, const SurfaceLook& look,
                            bool layered = false) {
        glm::dvec3 base;
        glm::dvec3 emission;
        glm::dvec3 paint(1.0);
        for (int i = 0; i < 3; ++i) {
            base[i] = share(material.base_color[i], 0.8);
            emission[i] = std::isfinite(material.emission[i])
                              ? std::clamp(material.emission[i], 0.0, 1e9)
                              : 0;
            if (material.vertex_colors)
                paint[i] = share(surface_.color[i], 1);
        }
        SolidSurface out;
        const bool image = shown(material.base_color_texture);
        out.lamp = shown(material.emission_texture);
        // The brightness that the paint leaves of a picture, and the picture's own scale, are left
        // to the finish: a picture is baked for every distinct hue only.
        const double scale = image ? even_scale(material.base_color_texture) : 1;
        const double painted = image ? std::max({paint.x, paint.y, paint.z}) : 1;
        const double brightness = scale * painted;
        if (surface_.layered && (image || layered) && !out.lamp && emission == glm::dvec3(0.0))
            out.gloss = grazing_gloss(look);
        SurfaceLook below = look;
        if (out.gloss)
            below.specular = 0;
        out.finish = finish_of(below);
        const double sky = share(surface_.sky, 1);
        out.finish.ambient *= brightness * sky * surface_.sky_hue;
        const double gray = image ? kUsualGray : glm::dot(base * paint, glm::dvec3(1.0 / 3));
        out.finish.glow =
            (out.finish.around + carried_by_gloss(look, gray)) * brightness * surface_.around;
        out.finish.diffuse *= brightness;
        out.finish.specular *= std::lerp(1.0, brightness, out.finish.metallic);
        // The part that has not the color of the pigment, and is the same all over.
        out.even = out.lamp ? glm::dvec3(0.0) : emission;
        if (!out.gloss) {
            out.white = white_gloss(look) * sky * surface_.sky_hue;
            out.even += white_gloss(look) * surface_.around;
        }
        out.plain =
            out.gloss || (image && (out.white != glm::dvec3(0.0) || out.even != glm::dvec3(0.0)));
        std::optional<LampGloss> lamps;
        if (!surface_.layered && !image && !out.lamp && emission == glm::dvec3(0.0))
            lamps = lamp_gloss(look);
        out.pigment = "pigment{";
        if (lamps) {
            LampGlossText text = lamp_gloss_text(*lamps, base * paint, out.finish, arriving());
            out.pigment = std::move(text.pigment);
            out.finish = text.finish;
            out.even = glm::dvec3(0.0);  // its finish has what gloss shows
        } else if (image) {
            Texture texture = material.base_color_texture;
            if (painted > 0)
                texture.offset *= paint / painted;
            texture.scale *= (painted > 0 ? paint / painted : glm::dvec3(1.0)) / scale;
            const bool leaf = texture.picture == surface_.mask;
            out.pigment += pigment(texture, leaf ? PigmentContent::Leaf : PigmentContent::Color);
        } else {
            glm::dvec3 color = base * paint;
            for (int i = 0; i < 3; ++i) {
                if (out.white[i] + out.even[i] <= 0)
                    continue;
                color[i] = std::max(color[i], kLeastPigment);
                out.finish.ambient[i] += out.white[i] / color[i];
                out.even[i] /= color[i];
            }
            append_rgb(out.pigment, color);
        }
        out.pigment += "} " + normal(material);
        return out;
    }

    Body solid(const Material& material, const SolidSurface& surface) {
        const double parts = 1 + (surface.lamp ? 1 : 0) + (surface.plain ? 1 : 0);
        Body body = surface.pigment;
        append_finish(body, surface.finish, parts,
                      surface.plain ? glm::dvec3(0.0) : parts * surface.even);
        if (parts == 1)
            return body;
        Entries entries{{1, std::move(body)}};
        if (surface.lamp)
            entries.emplace_back(1, glow(material.emission_texture, parts));
        if (surface.gloss) {
            const GlossText gloss = gloss_alone(*surface.gloss, arriving(), parts);
            entries.emplace_back(1, gloss.pigment + ' ' + normal(material) + gloss.finish);
        } else if (surface.plain) {
            Finish rest;
            rest.ambient = surface.white;
            Body text = "pigment{rgb 1} ";
            append_finish(text, rest, parts, parts * surface.even);
            entries.emplace_back(1, std::move(text));
        }
        return "average" + map(entries);
    }

    /// The text of a glow. A picture holds nothing brighter than 1: such brightness is left to the
    /// finish.
    Body glow(Texture texture, double light) {
        const glm::dvec3 most = glm::abs(texture.scale) + glm::abs(texture.offset);
        const double brightest =
            std::max({most.x, most.y, most.z, 1e-9}) * brightest_of(*texture.picture);
        texture.scale /= brightest;
        texture.offset /= brightest;
        Body out = "pigment{" + pigment(texture, PigmentContent::Color) + "} ";
        append_finish(out, Finish{}, 0, glm::dvec3(light * brightest));
        return out;
    }

    const TexturedSurface& surface_;
    PictureWriter& pictures_;
};

/// The largest share of light from all sides that a surface mirrors somewhere.
double mean_mirror(const Material& material, bool uvs) {
    // The smoothest that pictures may make of it, and the most metal, mirrors the most.
    SurfaceLook look = look_of(material);
    if (uvs && material.roughness_texture)
        look.roughness = 0;
    if (uvs && material.metallic_texture)
        look.metallic = 1;
    const Finish finish = finish_of(look);
    const double mean = finish.mirror + (finish.mirror_grazing - finish.mirror) * kGrazingMean;
    return std::max(mean, material.other ? mean_mirror(*material.other, uvs) : 0.0);
}

/// Whether rays go on through the surface itself, whatever it is mixed with.
bool goes_through(const Material& material) {
    return material.alpha_mode != AlphaMode::Opaque || share(material.transmission, 0) > 0;
}

}  // namespace

std::string texture_text(const Material& material, const TexturedSurface& surface,
                         PictureWriter& pictures) {
    return TextureText(surface, pictures).whole(material);
}

bool bumpy(const Material& material) {
    return material.bump_texture || material.normal_texture ||
           (material.other && bumpy(*material.other));
}

bool may_mirror(const Material& material, bool uvs) {
    return mean_mirror(material, uvs) > 0;
}

bool rays_go_on(const Material& material, bool uvs) {
    return goes_through(material) || may_mirror(material, uvs) ||
           (material.other && rays_go_on(*material.other, uvs));
}

void add_onward(const Material& material, OnwardRays& rays) {
    rays.mirrored = std::max(rays.mirrored, mean_mirror(material, true));
    rays.refracted = rays.refracted || refraction_of(material) > 0;
    for (const Material* one = &material; one != nullptr; one = one->other.get())
        rays.clear = rays.clear || goes_through(*one);
}

double refraction_of(const Material& material) {
    const double other = material.other ? refraction_of(*material.other) : 0;
    if (!(material.transmission > 0) || !std::isfinite(material.ior))
        return other;
    return std::clamp(material.ior, 0.1, 10.0);
}

}  // namespace lodestone::povray
