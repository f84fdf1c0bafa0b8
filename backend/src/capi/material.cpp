// SPDX-License-Identifier: GPL-3.0-or-later
// The materials' part of the C interface: pictures, textures, materials.
#include "base/files.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "image/bake/baked_image.h"
#include "image/picture_findings.h"
#include "image/texture_sampler.h"

#include <algorithm>
#include <cmath>

using namespace lodestone;
using namespace lodestone::capi;

namespace {

// Taste: a larger number lets larger pictures fill more memory.
constexpr uint64_t kMostPictureBytes = uint64_t{1} << 30u;

PicturePtr picture_of(const lds_picture& given, const std::string& name) {
    const ColorSpace space = given.linear != 0 ? ColorSpace::Linear : ColorSpace::Srgb;
    const int sources = (given.path != nullptr ? 1 : 0) + (given.bytes != nullptr ? 1 : 0) +
                        (given.pixels != nullptr ? 1 : 0);
    if (sources != 1)
        fail(Status::InvalidArgument, "picture '", name,
             "': exactly one of path, bytes and pixels is to be given");
    if (given.path != nullptr)
        return image::make_picture(read_file(given.path, kMostPictureBytes), space, name);
    if (given.bytes != nullptr)
        return image::make_picture({static_cast<const char*>(given.bytes), given.byte_count}, space,
                                   name);
    if (given.width < 1 || given.height < 1 ||
        static_cast<uint64_t>(given.width) * static_cast<uint64_t>(given.height) >
            image::kMostPixels)
        fail(Status::InvalidArgument, "picture '", name, "': ", given.width, " x ", given.height,
             " pixels");
    image::Image image;
    image.width = given.width;
    image.height = given.height;
    const size_t row = static_cast<size_t>(given.width) * 4;
    image.pixels.reserve(row * static_cast<size_t>(given.height));
    for (int y = given.height - 1; y >= 0; --y) {
        const float* from = given.pixels + row * static_cast<size_t>(y);
        image.pixels.insert(image.pixels.end(), from, from + row);
    }
    return image::make_picture(image::packed(image), image::PngEffort::Small, space, name);
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
#define LODESTONE_COPY_FIELD(name, presence, clamped, believed)                   \
    if (FieldPresence::presence != FieldPresence::WithOther || given_.other != 0) \
        copy_field(made.name, given_.name, #name);
        LODESTONE_MATERIAL_FIELDS(LODESTONE_COPY_FIELD)
#undef LODESTONE_COPY_FIELD
        clamp_numbers(made);
        return made;
    }

private:
    void copy_field(glm::dvec3& out, const double (&value)[3], const char* what) const {
        out = vector(value, text("material.", what).c_str());
    }
    void copy_field(double& out, double value, const char* what) const {
        if (!std::isfinite(value))
            fail(Status::InvalidArgument, what, " of ", owner_, " is not finite");
        out = value;
    }
    void copy_field(Texture& out, const lds_texture& value, const char*) const {
        out = texture_of(model_, value, owner_);
    }
    static void copy_field(bool& out, int32_t value, const char*) {
        out = value != 0;
    }
    void copy_field(AlphaMode& out, int32_t value, const char*) const {
        if (value < LDS_ALPHA_MODE_OPAQUE || value > LDS_ALPHA_MODE_CLIP)
            fail(Status::InvalidArgument, owner_, " has alpha mode ", value);
        out = static_cast<AlphaMode>(value);
    }
    /// `value`: 1 + the index of the other material; 0: none.
    void copy_field(std::shared_ptr<const Material>& out, uint32_t value, const char*) const {
        if (value == 0)
            return;
        const std::vector<Material>& materials = model_.model.materials;
        if (value > materials.size())
            fail(Status::InvalidArgument, owner_, " is mixed with material ", value - 1, " of ",
                 materials.size());
        out = std::make_shared<Material>(materials[value - 1]);
        int mixtures = 0;
        for (const Material* at = out.get(); at != nullptr; at = at->other.get())
            ++mixtures;
        if (mixtures > kMostMixtures)
            fail(Status::InvalidArgument, owner_, " is mixed more than ", kMostMixtures, " times");
    }

    const lds_model& model_;
    const lds_material& given_;
    std::string owner_;
};

// The fields of a new lds_material; it has no textures and no other material.
void set_default(double (&out)[3], const glm::dvec3& value) {
    copy(value, out);
}
void set_default(double& out, double value) {
    out = value;
}
void set_default(int32_t& out, bool value) {
    out = value ? 1 : 0;
}
void set_default(int32_t& out, AlphaMode value) {
    out = static_cast<int32_t>(value);
}
void set_default(const lds_texture&, const Texture&) {}
void set_default(uint32_t, const std::shared_ptr<const Material>&) {}

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
    // The most entries of a step's table.
    // Taste: as many as colors of 16 bits have values; a larger number takes more memory.
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
        const lds_bake given = checked(bake, "bake");
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
        const lds_picture given = checked(picture, "picture");
        const std::string name = name_of(given.name);
        *out_index = index_of(*model, picture_of(given, name));
    });
}

lds_status lds_pictures_keep(const char* folder) {
    return guard([&] {
        require(folder, "folder");
        if (*folder == '\0')
            fail(Status::InvalidArgument, "the folder has no name");
        image::keep_pictures(folder);
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
#define LODESTONE_DEFAULT_FIELD(name, presence, clamped, believed) \
    set_default(out.name, standard.name);
        LODESTONE_MATERIAL_FIELDS(LODESTONE_DEFAULT_FIELD)
#undef LODESTONE_DEFAULT_FIELD
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
