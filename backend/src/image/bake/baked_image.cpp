// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/bake/baked_image.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/recent_values.h"
#include "image/bake/bake_program.h"
#include "image/picture_findings.h"
#include "image/texture_sampler.h"

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <unordered_map>

namespace lodestone::image {
namespace {

Hash hash_of_bake(const std::vector<BakeStep>& steps, const std::vector<Texture>& textures,
                  int width, int height, ColorSpace space) {
    Hasher hasher;
    for (const BakeStep& step : steps) {
        hasher.value(step.op).array(std::span<const uint32_t>(step.args));
        for (int c = 0; c < 4; ++c)
            hasher.value(step.value[c]);
        hasher.bytes(step.table.data(), step.table.size() * sizeof(glm::vec4));
    }
    for (const Texture& texture : textures)
        hasher.value(hash_of(texture));
    return hasher.value(width).value(height).value(space).result();
}

/// The texels of one texture of a bake: as they are, for a picture of the baked size that lies on
/// all of it, else looked up.
struct BakeSource {
    PackedPtr packed;  // keeps the rows' bytes
    std::optional<TexelRows> rows;
    std::optional<TextureSampler> sampler;
    bool same = false;  // the sampler's texels are those of the bake
};

std::vector<BakeSource> sources_of(const std::vector<Texture>& textures, int width, int height,
                                   const Job& job) {
    const std::array<double, 6> identity = Texture().to_picture;
    std::unordered_map<Hash, PackedPtr> images;
    std::unordered_map<Hash, TexelsPtr> texels;
    std::vector<BakeSource> out;
    for (const Texture& texture : textures) {
        job.check();
        BakeSource& source = out.emplace_back();
        if (!texture) {
            source.sampler.emplace(texture, glm::dvec3(0), nullptr);
            continue;
        }
        const bool whole = texture.to_picture == identity;
        const ColorSpace space = texture.picture->space;
        PackedPtr& image = images[texture.picture->hash];
        if (!image)
            image = packed(*texture.picture);
        if (whole && image->width == width && image->height == height) {
            source.packed = image;
            source.rows.emplace(*image, space);
            continue;
        }
        TexelsPtr& found = texels[texture.picture->hash];
        if (!found)
            found = texels_of(TexelRows(*image, space), kMostBakeSide);
        source.sampler.emplace(texture, glm::dvec3(0), found);
        source.same = whole && found->width == width && found->height == height;
    }
    return out;
}

/// Hands out the rows of a checked bake as linear RGBA, each once, in no order, on several threads.
void bake_rows(const std::vector<BakeStep>& steps, const std::vector<Texture>& textures, int width,
               int height, const Job& job, const std::function<void(size_t, const float*)>& take) {
    const std::vector<BakeSource> sources = sources_of(textures, width, height, job);
    const size_t row_size = 4 * static_cast<size_t>(width);
    parallel_for(static_cast<size_t>(height), [&](size_t row) {
        job.check();
        std::vector<glm::dvec4> done(steps.size());
        std::vector<float> texels(row_size * sources.size());
        for (size_t i = 0; i < sources.size(); ++i) {
            if (sources[i].rows)
                sources[i].rows->read(static_cast<int>(row), texels.data() + row_size * i);
        }
        std::vector<float> made(row_size);
        float* to = made.data();
        const double v = 1 - (static_cast<double>(row) + 0.5) / height;
        for (int column = 0; column < width; ++column, to += 4) {
            const glm::dvec2 uv((column + 0.5) / width, v);
            for (size_t i = 0; i < steps.size(); ++i) {
                if (steps[i].op != BakeOp::Texel) {
                    done[i] = result_of(steps[i], done);
                    continue;
                }
                const size_t which = steps[i].args[0];
                const BakeSource& source = sources[which];
                if (source.rows) {
                    const float* at =
                        texels.data() + row_size * which + 4 * static_cast<size_t>(column);
                    done[i] = {at[0], at[1], at[2], at[3]};
                } else {
                    done[i] = source.same ? source.sampler->at(column, static_cast<int>(row))
                                          : source.sampler->texel(uv);
                }
            }
            for (int c = 0; c < 3; ++c)
                to[c] = static_cast<float>(finite_or_zero(done.back()[c]));
            to[3] = 1;
        }
        take(row, made.data());
    });
}

/// The picture that is kept from an earlier bake; null where there is none of that size.
PicturePtr kept_picture(Hash key, int width, int height, ColorSpace space,
                        const std::string& name) {
    std::optional<std::string> png = kept_bake(key);
    if (!png)
        return nullptr;
    try {
        PicturePtr made = make_picture(std::move(*png), space, name);
        return made->width == width && made->height == height ? made : nullptr;
    } catch (const Error&) {
        return nullptr;  // it is no picture
    }
}

/// Bakes a picture, and keeps it for other sessions.
PicturePtr baked_picture(Hash key, const std::vector<BakeStep>& steps,
                         const std::vector<Texture>& textures, int width, int height,
                         ColorSpace space, const std::string& name, const Job& job) {
    check_bake(steps, textures.size(), width, height);
    PackedImage image = blank_packed(width, height, 3, 8, name);
    bake_rows(steps, textures, width, height, job, [&](size_t row, const float* texels) {
        unsigned char* to = image.row(static_cast<int>(row));
        for (int x = 0; x < width; ++x, texels += 4, to += 3) {
            for (size_t c = 0; c < 3; ++c)  // a linear picture's numbers are not encoded
                to[c] = space == ColorSpace::Linear ? byte_of(texels[c]) : srgb_byte_of(texels[c]);
        }
    });
    // Not compressed: it is often made anew when a scene is read, and decoded soon.
    PicturePtr made = make_picture(image, PngEffort::Quick, space, name);
    keep_bake(key, made->bytes);
    return made;
}

}  // namespace

Image bake(const std::vector<BakeStep>& steps, const std::vector<Texture>& textures, int width,
           int height, const Job& job) {
    check_bake(steps, textures.size(), width, height);
    Image image;
    image.width = width;
    image.height = height;
    image.linear = true;
    image.pixels.resize(4 * image.size());
    bake_rows(steps, textures, width, height, job, [&](size_t row, const float* texels) {
        const size_t size = 4 * static_cast<size_t>(width);
        std::copy_n(texels, size, image.pixels.data() + size * row);
    });
    return image;
}

PicturePtr bake_picture(const std::vector<BakeStep>& steps, const std::vector<Texture>& textures,
                        int width, int height, ColorSpace space, const std::string& name,
                        const Job& job) {
    // The bytes of the pictures that the process remembers.
    // Taste: a larger value bakes fewer pictures again, when scenes have many.
    constexpr size_t kMostBytes = size_t{256} << 20u;
    static RecentValues<Picture> remembered(kMostBytes);
    const Hash key = hash_of_bake(steps, textures, width, height, space);
    PicturePtr made = remembered.of(
        key,
        [&] {
            PicturePtr kept = kept_picture(key, width, height, space, name);
            return kept ? kept
                        : baked_picture(key, steps, textures, width, height, space, name, job);
        },
        [](const Picture& picture) { return picture.bytes.size(); });
    if (made->name == name)
        return made;
    auto renamed = std::make_shared<Picture>(*made);
    renamed->name = name;
    return renamed;
}

}  // namespace lodestone::image
