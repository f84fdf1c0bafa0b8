// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/obj/mtl.h"

#include "format/obj/mtl_map.h"
#include "format/obj/text_lines.h"
#include "image/texture_sampler.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lodestone::format {
namespace {

/// Keeps the old value unless there are as many finite numbers.
bool read_values(std::string_view words, double* values, int count) {
    double found[3] = {0, 0, 0};
    for (int i = 0; i < count; ++i) {
        float value = 0;
        if (!next_float(words, value) || !std::isfinite(value))
            return false;
        found[i] = static_cast<double>(value);
    }
    std::copy_n(found, count, values);
    return true;
}

/// Purple on the whole, as the directions of a surface's normals are.
bool looks_like_normals(const Picture& picture) {
    const glm::dvec4& mean = picture.mean;
    return mean.z > 0.75 && std::abs(mean.x - 0.5) < 0.15 && std::abs(mean.y - 0.5) < 0.15;
}

/// One material while its lines come.
struct MaterialDraft {
    Material material;
    std::optional<double> dissolve;
    std::optional<double> transparency;
    std::optional<glm::dvec3> filter;
    int illumination = 2;
};

class LibraryReader {
public:
    LibraryReader(const std::filesystem::path& folder, const std::string& name, Problems& problems)
        : pictures_(folder), name_(name), problems_(problems) {}

    std::vector<Material> read(std::string_view bytes) {
        LineReader lines(bytes);
        std::string_view line;
        std::vector<Material> out;
        std::optional<MaterialDraft> draft;
        while (lines.next(line)) {
            const std::string_view word = next_word(line);
            if (word == "newmtl") {
                if (draft)
                    out.push_back(finished(std::move(*draft)));
                draft.emplace();
                draft->material.name = std::string(trimmed(line));
            } else if (draft && !read_number(word, line, *draft)) {
                read_map(word, line, draft->material);
            }
        }
        if (draft)
            out.push_back(finished(std::move(*draft)));
        return out;
    }

private:
    static bool read_number(std::string_view word, std::string_view line, MaterialDraft& draft) {
        Material& m = draft.material;
        for (const MtlShare& share : kMtlShares) {
            if (word != share.word)
                continue;
            double& value = m.*share.member;
            read_values(line, &value, 1);
            value = std::clamp(value, 0.0, 1.0);
            return true;
        }
        double number = 0;
        glm::dvec3 color(0.0);
        if (word == "Kd") {
            read_values(line, &m.base_color.x, 3);
        } else if (word == "Ke") {
            read_values(line, &m.emission.x, 3);
        } else if (word == "d") {
            if (read_values(line, &number, 1))
                draft.dissolve = std::clamp(number, 0.0, 1.0);
        } else if (word == "Tr") {
            if (read_values(line, &number, 1))
                draft.transparency = std::clamp(number, 0.0, 1.0);
        } else if (word == "Tf") {
            if (read_values(line, &color.x, 3))
                draft.filter =
                    glm::dvec3(std::clamp(color.x, 0.0, 1.0), std::clamp(color.y, 0.0, 1.0),
                               std::clamp(color.z, 0.0, 1.0));
        } else if (word == "Ni") {
            if (read_values(line, &number, 1) && number >= 1 && number <= 100)
                m.ior = number;
        } else if (word == "illum") {
            if (read_values(line, &number, 1) && number >= 0 && number <= 10)
                draft.illumination = static_cast<int>(number);
        } else {
            return false;
        }
        return true;
    }

    /// The texture of a map line, with its picture; nothing when that is not there (a problem
    /// then).
    std::optional<MapLine> map_of(std::string_view line, ColorSpace space,
                                  const Material& material) {
        MapLine map = map_line(line);
        try {
            map.texture.picture = pictures_.find(map.file, space);
            return map;
        } catch (const Error& e) {
            problems_.push_back({name_, Severity::Warning, "texture_missing",
                                 text("material '", material.name, "': ", e.what())});
            return std::nullopt;
        }
    }

    void read_map(std::string_view word, std::string_view line, Material& m) {
        struct MapKeyword {
            std::string_view word;
            Texture Material::*texture;
            ColorSpace space;
        };
        static constexpr MapKeyword kMaps[] = {
            {"map_Kd", &Material::base_color_texture, ColorSpace::Srgb},
            {"map_Ke", &Material::emission_texture, ColorSpace::Srgb},
            {"map_d", &Material::alpha_texture, ColorSpace::Linear},
            {"map_Pr", &Material::roughness_texture, ColorSpace::Linear},
            {"map_Pm", &Material::metallic_texture, ColorSpace::Linear},
        };
        for (const MapKeyword& map : kMaps) {
            if (word != map.word)
                continue;
            const auto found = map_of(line, map.space, m);
            if (!found)
                return;
            m.*map.texture = found->texture;
            const bool cut_out =
                map.texture == &Material::alpha_texture && found->texture.picture->mean.w < 1;
            if (!found->channel && map.space == ColorSpace::Linear)
                (m.*map.texture).channel = cut_out ? TextureChannel::Alpha : TextureChannel::Luma;
            return;
        }
        if (word == "norm" || word == "map_norm") {
            if (const auto found = map_of(line, ColorSpace::Linear, m)) {
                m.normal_texture = found->texture;
                m.normal_strength = found->bump;
            }
        } else if (word == "bump" || word == "map_bump" || word == "map_Bump") {
            read_bump(line, m);
        }
    }

    void read_bump(std::string_view line, Material& m) {
        const auto found = map_of(line, ColorSpace::Linear, m);
        if (!found)
            return;
        if (!found->channel && looks_like_normals(*found->texture.picture)) {
            m.normal_texture = found->texture;
            m.normal_strength = found->bump;
            return;
        }
        m.bump_texture = found->texture;
        if (!found->channel)
            m.bump_texture.channel = TextureChannel::Luma;
        m.bump_distance = found->bump * kBumpMetres;
        problems_.push_back(
            {name_, Severity::Info, "bump_height_guessed",
             text("material '", m.name, "': its bumps are taken as ",
                  1000 * std::abs(m.bump_distance), " mm high; MTL gives them no unit")});
    }

    static Material finished(MaterialDraft draft) {
        Material& m = draft.material;
        const double dissolve =
            draft.dissolve ? *draft.dissolve : 1 - draft.transparency.value_or(0.0);
        const auto number = [](Texture& texture, double& value) {
            if (texture)
                value = image::number_of(texture, texture.picture->mean);
        };
        const bool glass =
            draft.illumination == 4 || draft.illumination == 6 || draft.illumination == 7;
        if (glass && !m.alpha_texture) {
            m.transmission = 1 - dissolve;
            if (dissolve == 1 && draft.filter && draft.illumination != 4 && m.ior > 1)
                m.transmission = (draft.filter->x + draft.filter->y + draft.filter->z) / 3;
            // Kd is that of what scatters, and often black.
            if (m.transmission > 0 && (draft.filter || m.transmission > 0.5))
                m.base_color = draft.filter.value_or(glm::dvec3(1.0));
        } else {
            m.alpha = dissolve;
            if (m.alpha_texture) {
                m.alpha_texture.scale *= dissolve;
                m.alpha_texture.offset *= dissolve;
            }
            number(m.alpha_texture, m.alpha);
            if (m.alpha_texture || m.alpha < 1)
                m.alpha_mode = AlphaMode::Blend;
        }
        if (m.base_color_texture)
            m.base_color =
                image::color_of(m.base_color_texture, m.base_color_texture.picture->mean);
        if (m.emission_texture) {
            if (m.emission != glm::dvec3(0.0)) {
                m.emission_texture.scale *= m.emission;
                m.emission_texture.offset *= m.emission;
            }
            m.emission = image::color_of(m.emission_texture, m.emission_texture.picture->mean);
        }
        number(m.roughness_texture, m.roughness);
        number(m.metallic_texture, m.metallic);
        return std::move(draft.material);
    }

    MapPictures pictures_;
    const std::string& name_;
    Problems& problems_;
};

}  // namespace

std::vector<Material> read_mtl(std::string_view bytes, const std::filesystem::path& folder,
                               const std::string& name, Problems& problems) {
    return LibraryReader(folder, name, problems).read(bytes);
}

}  // namespace lodestone::format
