// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/store_payloads.h"

namespace lodestone::segment {
namespace {

using segment::out;  // the overloads below would hide it

// ---- Writing: an overload for each kind's payload ----

Json out(const Primitive& p) {
    return {{"center", out(p.center)}, {"axes", out(p.axes)}, {"half_size", out(p.half_size)}};
}

struct PayloadWriter {
    Json& json;

    void operator()(const Solid& solid) const { json["primitive"] = out(solid.primitive); }

    void operator()(const Composite& composite) const {
        Json solids = Json::array();
        for (const Solid& solid : composite.solids) {
            solids.push_back(out(solid.primitive));
            solids.back()["box"] = solid.box;
            solids.back()["slot"] = solid.slot;
        }
        json["solids"] = std::move(solids);
    }

    void operator()(const Assembly& assembly) const {
        Json placements = Json::array();
        for (const Placement& placement : assembly.placements) {
            placements.push_back({{"object", placement.object},
                                  {"transform", out(placement.transform)},
                                  {"name", placement.name}});
            if (placement.hidden != 0)
                placements.back()["hidden"] = placement.hidden;
            if (placement.importance != 1)
                placements.back()["importance"] = placement.importance;
            if (placement.coarsest != kAnyLevel)
                placements.back()["coarsest"] = placement.coarsest;
            if (placement.finest != 0)
                placements.back()["finest"] = placement.finest;
        }
        json["placements"] = std::move(placements);
    }

    void operator()(const Mesh&) const {}  // in a file
};

// ---- Reading ----

std::shared_ptr<const Assembly> assembly(const Json& json, size_t object_count) {
    auto out = std::make_shared<Assembly>();
    for (const Json& one : json.at("placements")) {
        Placement placement;
        placement.object = integer<uint32_t>(one, "object");
        if (placement.object >= object_count)
            fail(Status::BadFile, "a placement names object ", placement.object, " of ",
                 object_count);
        placement.transform = Affine::from_rows(numbers(one, "transform", 12).data());
        placement.name = one.at("name").get<std::string>();
        if (one.contains("hidden")) {
            const auto hidden = integer<uint32_t>(one, "hidden");
            if (hidden > kAllRays)
                fail(Status::BadFile, "'", placement.name, "' is hidden from ray classes ", hidden);
            placement.hidden = static_cast<RayMask>(hidden);
        }
        if (one.contains("importance")) {
            placement.importance = number(one, "importance");
            if (!(placement.importance >= 1 / kMostImportance &&
                  placement.importance <= kMostImportance))
                fail(Status::BadFile, "'", placement.name, "' has importance ",
                     placement.importance);
        }
        if (one.contains("coarsest"))
            placement.coarsest = integer<uint32_t>(one, "coarsest");
        if (one.contains("finest"))
            placement.finest = integer<uint32_t>(one, "finest");
        out->placements.push_back(std::move(placement));
    }
    return out;
}

Primitive primitive(const Json& json, Kind kind) {
    const Primitive out{vector(json, "center"), matrix(json, "axes"), vector(json, "half_size")};
    if (!(glm::min(out.half_size.x, glm::min(out.half_size.y, out.half_size.z)) > 0))
        fail(Status::BadFile, "a ", name_of(kind), " has no size");
    return out;
}

std::shared_ptr<const Composite> composite(const Json& json, size_t slots) {
    // Taste: more are no file of ours; a larger number lets a hostile file fill more memory.
    constexpr size_t kMostSolids = 1024;
    if (!json.is_array() || json.empty() || json.size() > kMostSolids)
        fail(Status::BadFile, "a composite has ", json.size(), " solids");
    auto out = std::make_shared<Composite>();
    for (const Json& one : json) {
        Solid solid;
        solid.box = one.at("box").get<bool>();
        solid.primitive = primitive(one, solid.box ? Kind::Box : Kind::Ellipsoid);
        const auto slot = integer<uint32_t>(one, "slot");
        if (slot >= slots)
            fail(Status::BadFile, "a solid shows slot ", slot, " of ", slots);
        solid.slot = static_cast<uint16_t>(slot);
        out->solids.push_back(solid);
    }
    return out;
}

}  // namespace

void write_payload(Json& json, const Representation& representation) {
    if (representation.summary.kind != Kind::Mesh)  // which need not be resident
        visit(representation, PayloadWriter{json});
}

Payload read_payload(const Json& json, Kind kind, const PayloadLimits& limits) {
    switch (kind) {
        case Kind::Mesh:
            return {};
        case Kind::Box:
        case Kind::Ellipsoid:
            return primitive(json.at("primitive"), kind);
        case Kind::Composite:
            return composite(json.at("solids"), limits.slots);
        case Kind::Assembly:
            return assembly(json, limits.objects);
    }
    return {};
}

}  // namespace lodestone::segment
