// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/store_json.h"

#include "segment/store_payloads.h"
#include "segment/tile_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lodestone::segment {
namespace {

PicturePtr picture(const Json& json) {
    auto p = std::make_shared<Picture>();
    p->name = json.at("name").get<std::string>();
    p->hash = hash(json, "hash");
    const auto format = json.at("format").get<std::string>();
    for (const PictureFormat known :
         {PictureFormat::Png, PictureFormat::Jpeg, PictureFormat::Exr}) {
        if (format == suffix_of(known))
            p->format = known;
    }
    if (format != suffix_of(p->format))
        fail(Status::BadFile, "a picture has the unknown format '", format, "'");
    p->space = json.at("linear").get<bool>() ? ColorSpace::Linear : ColorSpace::Srgb;
    p->width = integer<int>(json, "width");
    p->height = integer<int>(json, "height");
    if (p->width < 1 || p->height < 1)
        fail(Status::BadFile, "a picture has no pixels");
    const std::vector<double> mean = numbers(json, "mean", 4);
    p->mean = {mean[0], mean[1], mean[2], mean[3]};
    return p;
}

using Pictures = std::vector<PicturePtr>;

Texture texture(const Json& material, const char* key, const Pictures& pictures) {
    Texture t;
    if (!material.contains(key))
        return t;
    const Json& json = material.at(key);
    const auto index = integer<size_t>(json, "picture");
    if (index >= pictures.size())
        fail(Status::BadFile, "a texture names picture ", index, " of ", pictures.size());
    t.picture = pictures[index];
    t.channel = choice(json, "channel", TextureChannel::Luma);
    t.extension = choice(json, "extension", TextureExtension::Mirror);
    t.interpolation = json.at("closest").get<bool>() ? TextureInterpolation::Closest
                                                     : TextureInterpolation::Linear;
    const std::vector<double> mapping = numbers(json, "to_picture", 6);
    std::copy(mapping.begin(), mapping.end(), t.to_picture.begin());
    t.scale = vector(json, "scale");
    t.offset = vector(json, "offset");
    return t;
}

/// Reads what a field of a material says.
class StoredMaterialReader {
public:
    StoredMaterialReader(const Json& json, const Pictures& pictures, int depth = 0)
        : json_(json), pictures_(pictures), depth_(depth) {}

    Material material() {
        if (depth_ > kMostMixtures)
            fail(Status::BadFile, "a material is mixed more than ", kMostMixtures, " times");
        made_.name = json_.at("name").get<std::string>();
        for_each_field([this](const auto& field) {
            if (told(field))
                read(field.key, made_.*field.member);
        });
        clamp_numbers(made_);
        return std::move(made_);
    }

private:
    template <typename Value>
    bool told(const MaterialField<Value>& field) const {
        switch (field.presence) {
            case FieldPresence::Always:
                return true;
            case FieldPresence::Unusual:
                return json_.contains(field.key);
            case FieldPresence::WithAlphaMode:
                return json_.contains("alpha_mode");
            case FieldPresence::WithOther:
                return json_.contains("other");
        }
        return true;
    }

    void read(const char* key, glm::dvec3& color) const { color = vector(json_, key); }
    void read(const char* key, double& out) const { out = number(json_, key); }
    void read(const char* key, Texture& out) const { out = texture(json_, key, pictures_); }
    void read(const char* key, bool& truth) const { truth = json_.at(key).get<bool>(); }
    void read(const char* key, AlphaMode& mode) const {
        mode = choice(json_, key, AlphaMode::Clip);
    }
    void read(const char* key, std::shared_ptr<const Material>& other) const {
        other = std::make_shared<Material>(
            StoredMaterialReader(json_.at(key), pictures_, depth_ + 1).material());
    }

    const Json& json_;
    const Pictures& pictures_;
    int depth_;
    Material made_;
};

SlotShares shares(const Json& json) {
    if (json.size() % 2 != 0)
        fail(Status::BadFile, "a slot has no share");
    SlotShares out;
    for (size_t i = 0; i < json.size(); i += 2) {
        const auto slot = json.at(i).get<uint64_t>();
        const double share = json.at(i + 1).get<double>();
        if (slot > std::numeric_limits<uint16_t>::max() || !std::isfinite(share))
            fail(Status::BadFile, "slot ", slot, " has the share ", share);
        out.push_back({static_cast<uint16_t>(slot), share});
    }
    return out;
}

Attributes attributes(const Json& json) {
    Attributes a;
    a.visible_area = number(json, "visible_area");
    a.surface_area = number(json, "surface_area");
    a.centroid = vector(json, "centroid");
    a.moments = matrix(json, "moments");
    a.axes = matrix(json, "axes");
    a.normal_moment = number(json, "normal_moment");
    a.color = vector(json, "color");
    a.roughness = number(json, "roughness");
    a.metallic = number(json, "metallic");
    a.specular = number(json, "specular");
    a.emission = vector(json, "emission");
    a.shares = shares(json.at("shares"));
    a.relative_error = number(json, "relative_error");
    a.rays = integer<uint64_t>(json, "rays");
    return a;
}

Representation representation(const Json& json, size_t object_count, size_t material_count) {
    Representation r;
    RepresentationSummary& s = r.summary;
    s.kind = kind_named(json.at("kind").get<std::string>());
    s.error = number(json, "error");
    s.max_error = number(json, "max_error");
    if (s.error < 0 || s.max_error < 0)
        fail(Status::BadFile, "a representation has a negative error");
    s.hash = hash(json, "hash");
    s.sealed = json.value("sealed", false);
    s.bound.center = vector(json, "center");
    s.bound.radius = number(json, "radius");
    if (json.contains("low")) {
        s.bound.box.low = vector(json, "low");
        s.bound.box.high = vector(json, "high");
    }
    s.cost.triangles = integer<uint64_t>(json, "triangles");
    s.cost.bytes = integer<uint64_t>(json, "bytes");
    r.materials = json.at("materials").get<std::vector<uint32_t>>();
    for (const uint32_t index : r.materials) {
        if (index >= material_count)
            fail(Status::BadFile, "a representation names material ", index, " of ",
                 material_count);
    }
    if (s.error == 0)
        s.shape = hash(json, "shape");
    if (json.contains("means")) {
        for (const Json& one : json.at("means"))
            r.means.push_back(shares(one));
    }
    if (r.means.size() > r.materials.size())
        fail(Status::BadFile, "a representation has more means than materials");
    // They are in a file; until it is read, only their hash is known.
    if (json.contains("chunks")) {
        auto surface = std::make_shared<SurfaceLevel>();
        surface->hash = hash(json, "chunks");
        r.surface = std::move(surface);
    }
    r.payload = read_payload(json, s.kind, {object_count, r.materials.size()});
    return r;
}

Object object(const Json& json, size_t object_count, size_t material_count) {
    Object o;
    o.uid = json.at("uid").get<std::string>();
    o.name = json.at("name").get<std::string>();
    o.deforms = json.at("deforms").get<bool>();
    o.role = json.at("role") == "environment" ? ObjectRole::Environment
             : json.at("role") == "automatic" ? ObjectRole::Automatic
                                              : ObjectRole::Ordinary;
    o.source_hash = hash(json, "source_hash");
    o.build_hash = hash(json, "build_hash");
    o.made_of_parts = json.value("of_parts", false);
    if (json.contains("bind_hash"))
        o.bind_hash = hash(json, "bind_hash");
    if (json.contains("attributes"))
        o.attributes = attributes(json.at("attributes"));
    if (json.contains("sources")) {
        for (const Json& one : json.at("sources")) {
            const auto index = one.at(0).get<uint64_t>();
            if (index >= material_count)
                fail(Status::BadFile, "'", o.name, "' is made of material ", index, " of ",
                     material_count);
            o.sources.push_back({static_cast<uint32_t>(index), one.at(1).get<bool>()});
        }
    }
    double last = -1;
    for (const Json& one : json.at("representations")) {
        o.representations.push_back(representation(one, object_count, material_count));
        const RepresentationSummary& s = o.representations.back().summary;
        if (s.error <= last || (last < 0 && s.error != 0))
            fail(Status::BadFile, "errors of '", o.name, "' do not rise from 0");
        if (last >= 0 && s.kind == Kind::Assembly)
            fail(Status::BadFile, "'", o.name, "' has an assembly that is not its finest level");
        last = s.error;
    }
    if (o.made_of_parts && !o.group())
        fail(Status::BadFile, "'", o.name, "' is made of parts, but is no group");
    return o;
}

Light light(const Json& json) {
    Light light;
    light.name = json.at("name").get<std::string>();
    light.kind = light_kind_named(json.at("kind").get<std::string>());
    light.color = vector(json, "color");
    light.power = number(json, "power");
    light.position = vector(json, "position");
    light.direction = vector(json, "direction");
    light.shadow = json.at("shadow").get<bool>();
    light.angle = number_or(json, "angle", 0);
    light.radius = number_or(json, "radius", 0);
    light.spot_size = number_or(json, "spot_size", light.spot_size);
    light.spot_blend = number_or(json, "spot_blend", 0);
    if (light.kind == LightKind::Area) {
        light.edge_u = vector(json, "edge_u");
        light.edge_v = vector(json, "edge_v");
        light.round = json.at("round").get<bool>();
        light.spread = number(json, "spread");
    }
    return light;
}

Camera camera(const Json& json) {
    Camera camera;
    camera.name = json.at("name").get<std::string>();
    camera.orthographic = json.at("orthographic").get<bool>();
    camera.position = vector(json, "position");
    camera.direction = vector(json, "direction");
    camera.right = vector(json, "right");
    camera.up = vector(json, "up");
    camera.near_clip = number(json, "near_clip");
    camera.focus_distance = number_or(json, "focus_distance", 0);
    camera.aperture = number_or(json, "aperture", 0);
    return camera;
}

World world(const Json& json, const Pictures& pictures) {
    World world;
    world.color = vector(json, "color");
    world.transparent = json.at("transparent").get<bool>();
    if (json.contains("environment")) {
        const auto index = integer<size_t>(json, "environment");
        if (index >= pictures.size())
            fail(Status::BadFile, "the world names picture ", index, " of ", pictures.size());
        world.environment = pictures[index];
        world.environment_turn = matrix(json, "turn");
        if (!(std::abs(glm::determinant(world.environment_turn)) > 1e-12))
            fail(Status::BadFile, "the world's environment is flattened");
        world.environment_strength = vector(json, "strength");
    }
    return world;
}

Model model_of(const Json& json) {
    if (integer<int>(json, "format") != kStoreFormat)
        fail(Status::BadFile, "the store has format ", integer<int>(json, "format"),
             ", this Lodestone reads ", kStoreFormat, ": update the levels");
    Model model;
    Pictures pictures;
    for (const Json& one : json.at("pictures"))
        pictures.push_back(picture(one));
    for (const Json& one : json.at("materials"))
        model.materials.push_back(StoredMaterialReader(one, pictures).material());
    const Json& objects = json.at("objects");
    for (const Json& one : objects)
        model.objects.push_back(object(one, objects.size(), model.materials.size()));
    for (const Json& one : json.at("lights"))
        model.lights.push_back(light(one));
    for (const Json& one : json.at("cameras"))
        model.cameras.push_back(camera(one));
    model.world = world(json.at("world"), pictures);
    if (!json.at("root").is_null()) {
        model.root = integer<uint32_t>(json, "root");
        if (model.root >= model.objects.size())
            fail(Status::BadFile, "the root is object ", model.root, " of ", objects.size());
    }
    set_demands(model, bottom_up(model));  // refuses cycles and a wrong root
    return model;
}

}  // namespace

std::string file_of(Hash hash) {
    return text("r/", hex16(hash), ".glb");
}

std::string bound_file_of(Hash bind_hash) {
    return text("b/", hex16(bind_hash), ".bound");
}

std::string chunk_file_of(const SurfaceLevel& level) {
    return text("r/", hex16(level.hash), ".chunks");
}

std::string tileset_head(const DescriptionText& description, bool with_view) {
    std::string text = "{\"asset\":{\"version\":\"1.1\",\"extras\":{\"lodestone\":";
    text += description.objects;
    if (with_view)
        text += description.view;
    return text;
}

std::string tileset_text(const Model& model, const DescriptionText& description) {
    std::string text = tileset_head(description);
    text += "}},";
    text += tiles_text(model);
    text += "}\n";
    return text;
}

std::string described(const Model& model) {
    const DescriptionText text = description_text(model);
    return text.objects + text.view;
}

Model model_of_description(const std::string& text) {
    try {
        return model_of(Json::parse(text));
    } catch (const Json::exception& error) {
        fail(Status::BadFile, "no description of a model: ", error.what());
    }
}

Model model_of_tileset(const std::string& text) {
    try {
        // Only the asset is ours; the tiles below "root" are for strangers and are not kept.
        const Json json = Json::parse(text, [](int depth, Json::parse_event_t event, Json& parsed) {
            return !(depth == 1 && event == Json::parse_event_t::key && parsed == "root");
        });
        return model_of(json.at("asset").at("extras").at("lodestone"));
    } catch (const Json::exception& error) {
        fail(Status::BadFile, "tileset.json is not a Lodestone store: ", error.what());
    } catch (const Error& error) {
        fail(Status::BadFile, "tileset.json cannot be used: ", error.what());
    }
}

std::string file_of(const Picture& picture) {
    return "i/" + file_name(picture);
}

std::set<std::string> files_of(const Model& model) {
    std::set<std::string> files;
    for (const Object& object : model.objects) {
        if (object.bind_hash != 0)
            files.insert(bound_file_of(object.bind_hash));
        for (const Representation& representation : object.representations) {
            if (representation.summary.kind != Kind::Assembly)
                files.insert(file_of(representation.summary.hash));
            if (representation.surface != nullptr)
                files.insert(chunk_file_of(*representation.surface));
        }
    }
    for (const Material& material : model.materials)
        for_each_texture(material,
                         [&](const Texture& texture) { files.insert(file_of(*texture.picture)); });
    if (model.world.environment)
        files.insert(file_of(*model.world.environment));
    return files;
}

}  // namespace lodestone::segment
