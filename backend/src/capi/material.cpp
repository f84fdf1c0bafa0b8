// SPDX-License-Identifier: GPL-3.0-or-later
// The materials' part of the C interface: pictures, textures, materials.
#include "base/files.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "image/baked_image.h"
#include "image/texture_sampler.h"

#include <algorithm>
#include <cmath>

using namespace lodestone;
using namespace lodestone::capi;

namespace {

constexpr uint64_t kMostPictureBytes = uint64_t{1} << 30u;

std::string bytes_of(const lds_picture& given, const std::string& name) {
    const int sources = (given.path != nullptr ? 1 : 0) + (given.bytes != nullptr ? 1 : 0) +
                        (given.pixels != nullptr ? 1 : 0);
    if (sources != 1)
        fail(Status::InvalidArgument, "picture '", name,
             "': exactly one of path, bytes and pixels is to be given");
    if (given.path != nullptr)
        return read_file(given.path, kMostPictureBytes);
    if (given.bytes != nullptr)
        return {static_cast<const char*>(given.bytes), given.byte_count};
    if (given.width < 1 || given.height < 1 ||
        static_cast<uint64_t>(given.width) * static_cast<uint64_t>(given.height) >
            image::kMostPixels)
        fail(Status::InvalidArgument, "picture '", name, "': ", given.width, " x ", given.height,
             " pixels");
    image::Image image;
    image.width = given.width;
    image.height = given.height;
    const size_t row = static_cast<size_t>(given.width) * 4;
    image.pixels.resize(row * static_cast<size_t>(given.height));
    for (int y = 0; y < given.height; ++y)
        std::copy_n(given.pixels + row * static_cast<size_t>(given.height - 1 - y), row,
                    image.pixels.begin() + static_cast<std::ptrdiff_t>(row) * y);
    return image::png_bytes(image);
}

Texture texture_of(const lds_model& model, const lds_texture& given, const std::string& owner) {
    Texture texture;
    if (given.picture == 0)
        return texture;
    if (given.picture > model.pictures.size())
        fail(Status::InvalidArgument, "a texture of ", owner, " uses picture ", given.picture - 1,
             " of ", model.pictures.size());
    if (given.channel < LDS_CHANNEL_COLOR || given.channel > LDS_CHANNEL_LUMA)
        fail(Status::InvalidArgument, "a texture of ", owner, " has channel ", given.channel);
    if (given.extension < LDS_EXTENSION_REPEAT || given.extension > LDS_EXTENSION_MIRROR)
        fail(Status::InvalidArgument, "a texture of ", owner, " has extension ", given.extension);
    texture.picture = model.pictures[given.picture - 1];
    texture.channel = static_cast<TextureChannel>(given.channel);
    texture.extension = static_cast<TextureExtension>(given.extension);
    texture.interpolation =
        given.closest != 0 ? TextureInterpolation::Closest : TextureInterpolation::Linear;
    for (size_t i = 0; i < 6; ++i) {
        if (!std::isfinite(given.to_picture[i]))
            fail(Status::InvalidArgument, "a texture of ", owner, " has a mapping not finite");
        texture.to_picture[i] = given.to_picture[i];
    }
    texture.scale = vector(given.scale, "texture.scale");
    texture.offset = vector(given.offset, "texture.offset");
    return texture;
}

class MaterialInput {
public:
    MaterialInput(const lds_model& model, const lds_material& given)
        : model_(model), given_(given), owner_("material '" + name_of(given.name) + "'") {}

    Material material() const {
        Material made;
        made.name = name_of(given_.name);
        made.base_color = vector(given_.base_color, "material.base_color");
        made.emission = vector(given_.emission, "material.emission");
        made.roughness = finite(given_.roughness, "roughness");
        made.metallic = finite(given_.metallic, "metallic");
        made.specular = finite(given_.specular, "specular");
        made.base_color_texture = texture(given_.base_color_texture);
        made.roughness_texture = texture(given_.roughness_texture);
        made.metallic_texture = texture(given_.metallic_texture);
        made.emission_texture = texture(given_.emission_texture);
        made.vertex_colors = given_.vertex_colors != 0;
        made.alpha = finite(given_.alpha, "alpha");
        made.alpha_texture = texture(given_.alpha_texture);
        if (given_.alpha_mode < LDS_ALPHA_MODE_OPAQUE || given_.alpha_mode > LDS_ALPHA_MODE_CLIP)
            fail(Status::InvalidArgument, owner_, " has alpha mode ", given_.alpha_mode);
        made.alpha_mode = static_cast<AlphaMode>(given_.alpha_mode);
        made.alpha_cutoff = finite(given_.alpha_cutoff, "alpha_cutoff");
        made.transmission = finite(given_.transmission, "transmission");
        made.ior = finite(given_.ior, "ior");
        made.clearcoat = finite(given_.clearcoat, "clearcoat");
        made.clearcoat_roughness = finite(given_.clearcoat_roughness, "clearcoat_roughness");
        made.normal_texture = texture(given_.normal_texture);
        made.normal_strength = finite(given_.normal_strength, "normal_strength");
        made.bump_texture = texture(given_.bump_texture);
        made.bump_distance = finite(given_.bump_distance, "bump_distance");
        if (given_.other != 0) {
            if (given_.other > model_.model.materials.size())
                fail(Status::InvalidArgument, owner_, " is mixed with material ", given_.other - 1,
                     " of ", model_.model.materials.size());
            made.other = std::make_shared<Material>(model_.model.materials[given_.other - 1]);
            int mixtures = 0;
            for (const Material* at = &made; at->other; at = at->other.get())
                ++mixtures;
            if (mixtures > kMostMixtures)
                fail(Status::InvalidArgument, owner_, " is mixed more than ", kMostMixtures,
                     " times");
            made.mix = finite(given_.mix, "mix");
            made.mix_texture = texture(given_.mix_texture);
        }
        clamp_numbers(made);
        return made;
    }

private:
    double finite(double value, const char* what) const {
        if (!std::isfinite(value))
            fail(Status::InvalidArgument, what, " of ", owner_, " is not finite");
        return value;
    }
    Texture texture(const lds_texture& given) const { return texture_of(model_, given, owner_); }

    const lds_model& model_;
    const lds_material& given_;
    std::string owner_;
};

/// The model's index of a picture; that of an equal one when there is one.
uint32_t index_of(lds_model& model, const PicturePtr& made) {
    auto& pictures = model.pictures;
    const auto same = std::find_if(pictures.begin(), pictures.end(),
                                   [&](const PicturePtr& p) { return p->hash == made->hash; });
    const auto index = static_cast<uint32_t>(same - pictures.begin());
    if (same == pictures.end())
        pictures.push_back(made);
    return index;
}

std::vector<image::BakeStep> steps_of(const lds_bake& given) {
    constexpr size_t kMostTable = 1u << 16u;
    std::vector<image::BakeStep> steps;
    if (given.step_count > image::kMostBakeSteps)
        fail(Status::InvalidArgument, "bake.step_count is ", given.step_count);
    for (size_t i = 0; i < given.step_count; ++i) {
        const lds_bake_step& from = given.steps[i];
        if (from.op < LDS_BAKE_CONSTANT || from.op > LDS_BAKE_FROM_SRGB ||
            from.table_count > kMostTable || (from.table == nullptr && from.table_count > 0))
            fail(Status::InvalidArgument, "step ", i, " of bake '", name_of(given.name),
                 "' has op ", from.op, " and a table of ", from.table_count);
        image::BakeStep step;
        step.op = static_cast<image::BakeOp>(from.op);
        for (size_t a = 0; a < 3; ++a)
            step.args[a] = from.args[a];
        step.value = {from.value[0], from.value[1], from.value[2], from.value[3]};
        for (size_t k = 0; k < from.table_count; ++k) {
            const float* row = from.table + 4 * k;
            step.table.emplace_back(row[0], row[1], row[2], row[3]);
        }
        steps.push_back(std::move(step));
    }
    return steps;
}

}  // namespace

lds_status lds_model_bake_picture(lds_model* model, const lds_bake* bake, lds_job* job,
                                  uint32_t* out_index) {
    return guard([&] {
        require(model, "model");
        require(out_index, "out_index");
        const lds_bake& given = checked(bake, "bake");
        const std::string name = name_of(given.name);
        if (given.step_count > 0)
            require(given.steps, "bake.steps");
        if (given.texture_count > 0)
            require(given.textures, "bake.textures");
        if (given.texture_count > image::kMostBakeSteps)
            fail(Status::InvalidArgument, "bake.texture_count is ", given.texture_count);
        std::vector<Texture> textures;
        int width = given.width;
        int height = given.height;
        for (size_t i = 0; i < given.texture_count; ++i) {
            textures.push_back(texture_of(*model, given.textures[i], "bake '" + name + "'"));
            const PicturePtr& picture = textures.back().picture;
            if (!picture)
                fail(Status::InvalidArgument, "texture ", i, " of bake '", name,
                     "' has no picture");
            if (given.width == 0)
                width = std::clamp(picture->width, std::max(width, 1), image::kMostBakeSide);
            if (given.height == 0)
                height = std::clamp(picture->height, std::max(height, 1), image::kMostBakeSide);
        }
        const ColorSpace space = given.linear != 0 ? ColorSpace::Linear : ColorSpace::Srgb;
        *out_index = index_of(*model, image::bake_picture(steps_of(given), textures, width, height,
                                                          space, name, job_of(job)));
    });
}

lds_status lds_model_add_picture(lds_model* model, const lds_picture* picture,
                                 uint32_t* out_index) {
    return guard([&] {
        require(model, "model");
        require(out_index, "out_index");
        const lds_picture& given = checked(picture, "picture");
        const std::string name = name_of(given.name);
        const PicturePtr made = image::make_picture(
            bytes_of(given, name), given.linear != 0 ? ColorSpace::Linear : ColorSpace::Srgb, name);
        *out_index = index_of(*model, made);
    });
}

lds_status lds_model_texture_mean(lds_model* model, const lds_texture* texture,
                                  double out_color[3]) {
    return guard([&] {
        require(model, "model");
        require(texture, "texture");
        require(out_color, "out_color");
        const Texture made = texture_of(*model, *texture, "the caller");
        if (!made)
            fail(Status::InvalidArgument, "the texture has no picture");
        copy(image::color_of(made, made.picture->mean), out_color);
    });
}

lds_status lds_material_default(lds_material* material) {
    return guard([&] {
        const Material standard;
        lds_material out{};
        for (int i = 0; i < 3; ++i) {
            out.base_color[i] = standard.base_color[i];
            out.emission[i] = standard.emission[i];
        }
        out.roughness = standard.roughness;
        out.metallic = standard.metallic;
        out.specular = standard.specular;
        out.alpha = standard.alpha;
        out.alpha_cutoff = standard.alpha_cutoff;
        out.ior = standard.ior;
        out.clearcoat_roughness = standard.clearcoat_roughness;
        out.normal_strength = standard.normal_strength;
        hand_out(material, out, "material");
    });
}

lds_status lds_model_add_material(lds_model* model, const lds_material* material,
                                  uint32_t* out_index) {
    return guard([&] {
        require(model, "model");
        require(out_index, "out_index");
        model->model.materials.push_back(
            MaterialInput(*model, checked(material, "material")).material());
        *out_index = static_cast<uint32_t>(model->model.materials.size() - 1);
    });
}
