// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/store_json.h"
#include "segment/store_payloads.h"

#include <map>

namespace lodestone::segment {
namespace {

using segment::out;  // the overloads below would hide it

/// Pictures in order of first use, each once.
class PictureList {
public:
    size_t index_of(const PicturePtr& picture) {
        const auto [at, fresh] = index_.try_emplace(picture->hash, index_.size());
        if (fresh)
            json_.push_back(
                {{"name", picture->name},
                 {"hash", hex16(picture->hash)},
                 {"format", suffix_of(picture->format)},
                 {"linear", picture->space == ColorSpace::Linear},
                 {"width", picture->width},
                 {"height", picture->height},
                 {"mean", {picture->mean.x, picture->mean.y, picture->mean.z, picture->mean.w}}});
        return at->second;
    }
    Json take() { return std::move(json_); }

private:
    std::map<Hash, size_t> index_;
    Json json_ = Json::array();
};

Json out(const Texture& t, PictureList& pictures) {
    return {{"picture", pictures.index_of(t.picture)},
            {"channel", static_cast<int>(t.channel)},
            {"extension", static_cast<int>(t.extension)},
            {"closest", t.interpolation == TextureInterpolation::Closest},
            {"to_picture", t.to_picture},
            {"scale", out(t.scale)},
            {"offset", out(t.offset)}};
}

/// Writes what a field of a material says.
class MaterialWords {
public:
    MaterialWords(const Material& material, PictureList& pictures)
        : m_(material), pictures_(pictures) {}

    Json words() {
        json_["name"] = m_.name;
        for_each_field([this](const auto& field) { say(field, m_.*field.member); });
        return std::move(json_);
    }

private:
    void say(const MaterialField<glm::dvec3>& field, const glm::dvec3& color) {
        json_[field.key] = out(color);
    }
    void say(const MaterialField<double>& field, double number) {
        if (said(field, number))
            json_[field.key] = number;
    }
    void say(const MaterialField<Texture>& field, const Texture& texture) {
        if (texture)
            json_[field.key] = out(texture, pictures_);
    }
    void say(const MaterialField<bool>& field, bool truth) {
        if (said(field, truth))
            json_[field.key] = truth;
    }
    void say(const MaterialField<AlphaMode>& field, AlphaMode mode) {
        if (said(field, mode))
            json_[field.key] = static_cast<int>(mode);
    }
    void say(const MaterialField<std::shared_ptr<const Material>>& field,
             const std::shared_ptr<const Material>& other) {
        if (other)
            json_[field.key] = MaterialWords(*other, pictures_).words();
    }

    /// Most materials have nothing but what is always said.
    template <typename Value>
    bool said(const MaterialField<Value>& field, const Value& value) const {
        static const Material kStandard;
        switch (field.presence) {
            case FieldPresence::Always:
                return true;
            case FieldPresence::Unusual:
                return value != kStandard.*field.member;
            case FieldPresence::WithAlphaMode:
                return m_.alpha_mode != AlphaMode::Opaque;
            case FieldPresence::WithOther:
                return m_.other != nullptr;
        }
        return true;
    }

    const Material& m_;
    PictureList& pictures_;
    Json json_ = Json::object();
};

/// Slots and their shares, one after the other.
Json out(const SlotShares& shares) {
    Json json = Json::array();
    for (const SlotShare& one : shares) {
        json.push_back(one.slot);
        json.push_back(one.share);
    }
    return json;
}

Json out(const Attributes& a) {
    return {{"visible_area", a.visible_area},
            {"surface_area", a.surface_area},
            {"centroid", out(a.centroid)},
            {"moments", out(a.moments)},
            {"axes", out(a.axes)},
            {"normal_moment", a.normal_moment},
            {"color", out(a.color)},
            {"roughness", a.roughness},
            {"metallic", a.metallic},
            {"specular", a.specular},
            {"emission", out(a.emission)},
            {"shares", out(a.shares)},
            {"relative_error", a.relative_error},
            {"rays", a.rays}};
}

Json out(const Representation& r) {
    const RepresentationSummary& s = r.summary;
    Json json = {{"kind", name_of(s.kind)},       {"error", s.error},
                 {"max_error", s.max_error},      {"hash", hex16(s.hash)},
                 {"center", out(s.bound.center)}, {"radius", s.bound.radius},
                 {"triangles", s.cost.triangles}, {"bytes", s.cost.bytes},
                 {"materials", r.materials}};
    if (!s.bound.empty()) {
        json["low"] = out(s.bound.box.low);
        json["high"] = out(s.bound.box.high);
    }
    if (s.sealed)
        json["sealed"] = true;
    if (s.error == 0)
        json["shape"] = hex16(s.shape);
    if (r.surface != nullptr)
        json["chunks"] = hex16(r.surface->hash);
    for (const SlotShares& mean : r.means)
        json["means"].push_back(out(mean));
    write_payload(json, r);
    return json;
}

Json out(const Light& l) {
    Json json = {
        {"name", l.name},    {"kind", name_of(l.kind)},     {"color", out(l.color)},
        {"power", l.power},  {"position", out(l.position)}, {"direction", out(l.direction)},
        {"shadow", l.shadow}};
    if (l.kind == LightKind::Sun)
        json["angle"] = l.angle;
    if (l.kind == LightKind::Point || l.kind == LightKind::Spot)
        json["radius"] = l.radius;
    if (l.kind == LightKind::Spot) {
        json["spot_size"] = l.spot_size;
        json["spot_blend"] = l.spot_blend;
    }
    if (l.kind == LightKind::Area) {
        json["edge_u"] = out(l.edge_u);
        json["edge_v"] = out(l.edge_v);
        json["round"] = l.round;
        json["spread"] = l.spread;
    }
    return json;
}

Json out(const Camera& c) {
    return {{"name", c.name},
            {"orthographic", c.orthographic},
            {"position", out(c.position)},
            {"direction", out(c.direction)},
            {"right", out(c.right)},
            {"up", out(c.up)},
            {"near_clip", c.near_clip},
            {"focus_distance", c.focus_distance},
            {"aperture", c.aperture}};
}

/// Names may be any bytes; JSON holds UTF-8.
std::string dumped(const Json& json) {
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Json out(const World& world, PictureList& pictures) {
    Json json = {{"color", out(world.color)}, {"transparent", world.transparent}};
    if (world.environment) {
        json["environment"] = pictures.index_of(world.environment);
        json["turn"] = out(world.environment_turn);
        json["strength"] = out(world.environment_strength);
    }
    return json;
}

/// The description of a model but for its view. Object indices are positions in `order`.
Json describe_objects(const Model& model, PictureList& pictures) {
    Json json = {{"format", kStoreFormat},
                 {"version", LODESTONE_VERSION},
                 {"root", model.root == kNoObject ? Json() : Json(model.root)}};
    Json& materials = json["materials"] = Json::array();
    for (const Material& material : model.materials)
        materials.push_back(MaterialWords(material, pictures).words());
    Json& objects = json["objects"] = Json::array();
    for (const Object& object : model.objects) {
        Json one = {{"uid", object.uid},
                    {"name", object.name},
                    {"deforms", object.deforms},
                    {"role", object.role == ObjectRole::Environment ? "environment"
                             : object.role == ObjectRole::Automatic ? "automatic"
                                                                    : "ordinary"},
                    {"source_hash", hex16(object.source_hash)},
                    {"build_hash", hex16(object.build_hash)}};
        if (object.made_of_parts)
            one["of_parts"] = true;
        if (object.bind_hash != 0)
            one["bind_hash"] = hex16(object.bind_hash);
        if (object.attributes)
            one["attributes"] = out(*object.attributes);
        for (const SourceMaterial& source : object.sources)
            one["sources"].push_back({source.material, source.plain});
        Json& representations = one["representations"] = Json::array();
        for (const Representation& representation : object.representations)
            representations.push_back(out(representation));
        objects.push_back(std::move(one));
    }
    return json;
}

/// The description of all that a picture is taken with: cameras, lights and the world.
Json describe_view(const Model& model, PictureList& pictures) {
    Json json;
    json["lights"] = Json::array();
    for (const Light& light : model.lights)
        json["lights"].push_back(out(light));
    json["cameras"] = Json::array();
    for (const Camera& camera : model.cameras)
        json["cameras"].push_back(out(camera));
    json["world"] = out(model.world, pictures);
    return json;
}

}  // namespace

DescriptionText description_text(const Model& model) {
    PictureList pictures;
    Json objects = describe_objects(model, pictures);
    const Json view = describe_view(model, pictures);
    objects["pictures"] = pictures.take();
    DescriptionText text{dumped(objects), dumped(view)};
    text.objects.back() = ',';  // for its brace
    text.view.erase(0, 1);
    return text;
}

}  // namespace lodestone::segment
