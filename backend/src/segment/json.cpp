// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/json.h"

#include "segment/tiles.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace lodestone::segment {
namespace {

using Json = nlohmann::json;

constexpr int kFormat = 1;

// ---- Out -----------------------------------------------------------------------------------

Json out(const glm::dvec3& v) {
    return Json::array({v.x, v.y, v.z});
}

Json out(const glm::dmat3& m) {
    Json rows = Json::array();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            rows.push_back(m[column][row]);
    }
    return rows;
}

Json out(const Affine& transform) {
    double rows[12];
    transform.to_rows(rows);
    return Json(std::vector<double>(rows, rows + 12));
}

Json out(const Material& m) {
    return {{"name", m.name},           {"base_color", out(m.base_color)},
            {"roughness", m.roughness}, {"metallic", m.metallic},
            {"specular", m.specular},   {"emission", out(m.emission)}};
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
            {"relative_error", a.relative_error},
            {"rays", a.rays}};
}

Json out(const Representation& r) {
    const Summary& s = r.summary;
    Json json = {{"kind", name_of(s.kind)},       {"error", s.error},
                 {"max_error", s.max_error},      {"hash", hex16(s.hash)},
                 {"center", out(s.bound.center)}, {"radius", s.bound.radius},
                 {"triangles", s.cost.triangles}, {"bytes", s.cost.bytes},
                 {"materials", r.materials}};
    if (!s.bound.empty()) {
        json["low"] = out(s.bound.box.low);
        json["high"] = out(s.bound.box.high);
    }
    if (s.kind == Kind::Box || s.kind == Kind::Ellipsoid) {
        const Primitive& p = r.primitive();
        json["primitive"] = {
            {"center", out(p.center)}, {"axes", out(p.axes)}, {"half_size", out(p.half_size)}};
    } else if (s.kind == Kind::Assembly) {
        Json placements = Json::array();
        for (const Placement& placement : r.assembly().placements)
            placements.push_back({{"object", placement.object},
                                  {"transform", out(placement.transform)},
                                  {"name", placement.name}});
        json["placements"] = std::move(placements);
    }
    return json;
}

Json out(const Light& l) {
    return {{"name", l.name},
            {"kind", l.kind == LightKind::Sun ? "sun" : "point"},
            {"color", out(l.color)},
            {"power", l.power},
            {"position", out(l.position)},
            {"direction", out(l.direction)},
            {"shadow", l.shadow}};
}

Json out(const Camera& c) {
    return {{"name", c.name},
            {"orthographic", c.orthographic},
            {"position", out(c.position)},
            {"direction", out(c.direction)},
            {"right", out(c.right)},
            {"up", out(c.up)},
            {"near_clip", c.near_clip}};
}

/// Our own description of a model. Object indices are positions in `order`.
Json describe(const Model& model) {
    Json json = {{"format", kFormat},
                 {"version", LODESTONE_VERSION},
                 {"root", model.root == kNoObject ? Json() : Json(model.root)}};
    Json& materials = json["materials"] = Json::array();
    for (const Material& material : model.materials)
        materials.push_back(out(material));
    Json& objects = json["objects"] = Json::array();
    for (const Object& object : model.objects) {
        Json one = {{"uid", object.uid},
                    {"name", object.name},
                    {"role", object.role == Role::Environment ? "environment" : "ordinary"},
                    {"source_hash", hex16(object.source_hash)},
                    {"build_hash", hex16(object.build_hash)}};
        if (object.attributes)
            one["attributes"] = out(*object.attributes);
        Json& representations = one["representations"] = Json::array();
        for (const Representation& representation : object.representations)
            representations.push_back(out(representation));
        objects.push_back(std::move(one));
    }
    json["lights"] = Json::array();
    for (const Light& light : model.lights)
        json["lights"].push_back(out(light));
    json["cameras"] = Json::array();
    for (const Camera& camera : model.cameras)
        json["cameras"].push_back(out(camera));
    json["world"] = {{"color", out(model.world.color)}, {"transparent", model.world.transparent}};
    return json;
}

// ---- In ------------------------------------------------------------------------------------

double number(const Json& json, const char* key) {
    const double value = json.at(key).get<double>();
    if (!std::isfinite(value))
        fail(Status::BadFile, "'", key, "' is not a finite number");
    return value;
}

std::vector<double> numbers(const Json& json, const char* key, size_t count) {
    auto values = json.at(key).get<std::vector<double>>();
    if (values.size() != count)
        fail(Status::BadFile, "'", key, "' has ", values.size(), " numbers; ", count, " expected");
    for (const double value : values) {
        if (!std::isfinite(value))
            fail(Status::BadFile, "'", key, "' holds a number that is not finite");
    }
    return values;
}

glm::dvec3 vector(const Json& json, const char* key) {
    const std::vector<double> v = numbers(json, key, 3);
    return {v[0], v[1], v[2]};
}

glm::dmat3 matrix(const Json& json, const char* key) {
    const std::vector<double> v = numbers(json, key, 9);
    return {v[0], v[3], v[6], v[1], v[4], v[7], v[2], v[5], v[8]};
}

Hash hash(const Json& json, const char* key) {
    const auto word = json.at(key).get<std::string>();
    if (word.size() != 16 || word.find_first_not_of("0123456789abcdef") != std::string::npos)
        fail(Status::BadFile, "'", key, "' is not 16 hexadecimal digits");
    return std::stoull(word, nullptr, 16);
}

Material material(const Json& json) {
    Material m;
    m.name = json.at("name").get<std::string>();
    m.base_color = vector(json, "base_color");
    m.roughness = number(json, "roughness");
    m.metallic = number(json, "metallic");
    m.specular = number(json, "specular");
    m.emission = vector(json, "emission");
    return m;
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
    a.relative_error = number(json, "relative_error");
    a.rays = json.at("rays").get<uint64_t>();
    return a;
}

std::shared_ptr<const Assembly> assembly(const Json& json, size_t object_count) {
    auto out = std::make_shared<Assembly>();
    for (const Json& one : json.at("placements")) {
        Placement placement;
        placement.object = one.at("object").get<uint32_t>();
        if (placement.object >= object_count)
            fail(Status::BadFile, "a placement names object ", placement.object, " of ",
                 object_count);
        placement.transform = Affine::from_rows(numbers(one, "transform", 12).data());
        placement.name = one.at("name").get<std::string>();
        out->placements.push_back(std::move(placement));
    }
    return out;
}

Representation representation(const Json& json, size_t object_count, size_t material_count) {
    Representation r;
    Summary& s = r.summary;
    s.kind = kind_named(json.at("kind").get<std::string>());
    s.error = number(json, "error");
    s.max_error = number(json, "max_error");
    if (s.error < 0 || s.max_error < 0)
        fail(Status::BadFile, "a representation has a negative error");
    s.hash = hash(json, "hash");
    s.bound.center = vector(json, "center");
    s.bound.radius = number(json, "radius");
    if (json.contains("low")) {
        s.bound.box.low = vector(json, "low");
        s.bound.box.high = vector(json, "high");
    }
    s.cost.triangles = json.at("triangles").get<uint64_t>();
    s.cost.bytes = json.at("bytes").get<uint64_t>();
    r.materials = json.at("materials").get<std::vector<uint32_t>>();
    for (const uint32_t index : r.materials) {
        if (index >= material_count)
            fail(Status::BadFile, "a representation names material ", index, " of ",
                 material_count);
    }
    if (s.kind == Kind::Box || s.kind == Kind::Ellipsoid) {
        const Json& p = json.at("primitive");
        const Primitive primitive{vector(p, "center"), matrix(p, "axes"), vector(p, "half_size")};
        if (!(glm::min(primitive.half_size.x,
                       glm::min(primitive.half_size.y, primitive.half_size.z)) > 0))
            fail(Status::BadFile, "a ", name_of(s.kind), " has no size");
        r.payload = primitive;
    } else if (s.kind == Kind::Assembly) {
        r.payload = assembly(json, object_count);
    }
    return r;
}

Object object(const Json& json, size_t object_count, size_t material_count) {
    Object o;
    o.uid = json.at("uid").get<std::string>();
    o.name = json.at("name").get<std::string>();
    o.role = json.at("role") == "environment" ? Role::Environment : Role::Ordinary;
    o.source_hash = hash(json, "source_hash");
    o.build_hash = hash(json, "build_hash");
    if (json.contains("attributes"))
        o.attributes = attributes(json.at("attributes"));
    double last = -1;
    for (const Json& one : json.at("representations")) {
        o.representations.push_back(representation(one, object_count, material_count));
        const Summary& s = o.representations.back().summary;
        if (s.error <= last || (last < 0 && s.error != 0))
            fail(Status::BadFile, "errors of '", o.name, "' do not rise from 0");
        if (last >= 0 && s.kind == Kind::Assembly)
            fail(Status::BadFile, "'", o.name, "' has an assembly that is not its finest level");
        last = s.error;
    }
    return o;
}

Model model_of(const Json& json) {
    if (json.at("format").get<int>() != kFormat)
        fail(Status::BadFile, "the store has format ", json.at("format").get<int>(),
             ", this Lodestone reads ", kFormat, ": update the levels");
    Model model;
    for (const Json& one : json.at("materials"))
        model.materials.push_back(material(one));
    const Json& objects = json.at("objects");
    for (const Json& one : objects)
        model.objects.push_back(object(one, objects.size(), model.materials.size()));
    for (const Json& one : json.at("lights")) {
        Light light;
        light.name = one.at("name").get<std::string>();
        light.kind = one.at("kind") == "sun" ? LightKind::Sun : LightKind::Point;
        light.color = vector(one, "color");
        light.power = number(one, "power");
        light.position = vector(one, "position");
        light.direction = vector(one, "direction");
        light.shadow = one.at("shadow").get<bool>();
        model.lights.push_back(std::move(light));
    }
    for (const Json& one : json.at("cameras")) {
        Camera camera;
        camera.name = one.at("name").get<std::string>();
        camera.orthographic = one.at("orthographic").get<bool>();
        camera.position = vector(one, "position");
        camera.direction = vector(one, "direction");
        camera.right = vector(one, "right");
        camera.up = vector(one, "up");
        camera.near_clip = number(one, "near_clip");
        model.cameras.push_back(std::move(camera));
    }
    model.world.color = vector(json.at("world"), "color");
    model.world.transparent = json.at("world").at("transparent").get<bool>();
    if (!json.at("root").is_null()) {
        model.root = json.at("root").get<uint32_t>();
        if (model.root >= model.objects.size())
            fail(Status::BadFile, "the root is object ", model.root, " of ", objects.size());
    }
    bottom_up(model);  // refuses cycles and a wrong root
    return model;
}

}  // namespace

std::string file_of(Hash hash) {
    return "r/" + hex16(hash) + ".glb";
}

std::string tileset_text(const Model& model) {
    const std::string ours = describe(model).dump();
    return text("{\"asset\":{\"version\":\"1.1\",\"extras\":{\"lodestone\":", ours, "}},",
                tiles_text(model), "}\n");
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

std::set<Hash> files_of_tileset(const std::string& text) {
    std::set<Hash> files;
    try {
        for (const Object& object : model_of_tileset(text).objects) {
            for (const Representation& representation : object.representations) {
                if (representation.summary.kind != Kind::Assembly)
                    files.insert(representation.summary.hash);
            }
        }
    } catch (const Error&) {
        files.clear();
    }
    return files;
}

}  // namespace lodestone::segment
