// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/representation_kinds.h"

#include <algorithm>

namespace lodestone {
namespace {

constexpr bool rows_rise() {
    for (size_t i = 1; i < kKindRows.size(); ++i) {
        if (kKindRows[i].kind <= kKindRows[i - 1].kind)
            return false;
    }
    return true;
}
static_assert(rows_rise(), "kinds are listed by their numbers, each once");
static_assert(kKindLimit <= 32, "a KindMask has 32 bits");

const KindRow* find_row(int64_t number) {
    const auto* found = std::find_if(kKindRows.begin(), kKindRows.end(), [&](const KindRow& row) {
        return static_cast<int64_t>(row.kind) == number;
    });
    return found == kKindRows.end() ? nullptr : found;
}

[[noreturn]] void refuse_assembly() {
    fail(Status::Internal, "an assembly is not drawn itself");
}

void add_solid(Hasher& hasher, const Solid& solid) {
    hasher.bytes(&solid.primitive, sizeof solid.primitive);
}

Primitive moved_primitive(Primitive primitive, const Affine& place) {
    primitive.center = place(primitive.center);
    primitive.axes = place.linear * primitive.axes;
    return primitive;
}

uint64_t triangles_of(Kind kind) {
    return row_of(kind).viewer_triangles.value_or(0);
}

}  // namespace

const KindRow& row_of(Kind kind) {
    const KindRow* row = find_row(static_cast<int64_t>(kind));
    if (row == nullptr)
        fail(Status::Internal, "there is no kind ", static_cast<int>(kind));
    return *row;
}

bool is_kind(int64_t number) {
    return find_row(number) != nullptr;
}

const char* name_of(Kind kind) {
    const KindRow* row = find_row(static_cast<int64_t>(kind));
    return row == nullptr ? "unknown" : row->word;
}

Kind kind_named(const std::string& word) {
    for (const KindRow& row : kKindRows) {
        if (word == row.word)
            return row.kind;
    }
    fail(Status::BadFile, "'", word.substr(0, 40), "' is no kind of representation");
}

void wrong_payload(Kind kind, const Payload& payload, const char* wanted) {
    fail(Status::Internal, "a ", name_of(kind), " representation ",
         payload.index() != 0 ? "was read as " : "is not resident: wanted ", wanted);
}

const Primitive& held_primitive(Kind kind, const Payload& payload) {
    const auto* primitive = std::get_if<Primitive>(&payload);
    if (primitive == nullptr)
        wrong_payload(kind, payload, "primitive");
    return *primitive;
}

Bound bound_of(Kind kind, const Payload& payload) {
    return visit_payload(kind, payload,
                         Overloaded{[](const Mesh& mesh) { return bound_of(mesh.positions); },
                                    [](const Solid& solid) {
                                        return solid.box ? bound_of_box(solid.primitive)
                                                         : bound_of_ellipsoid(solid.primitive);
                                    },
                                    [](const Composite& composite) { return bound_of(composite); },
                                    [](const Assembly&) -> Bound { refuse_assembly(); }});
}

DrawCost cost_of(Kind kind, const Payload& payload, const CostModel& costs) {
    return visit_payload(
        kind, payload,
        Overloaded{[&](const Mesh& mesh) {
                       const uint64_t triangles = mesh.triangles.size();
                       return DrawCost{triangles, triangles * costs.triangle_bytes};
                   },
                   [&](const Solid&) {
                       return DrawCost{0, costs.primitive_bytes};
                   },
                   [&](const Composite& composite) {
                       return DrawCost{0, composite.solids.size() * costs.primitive_bytes};
                   },
                   [&](const Assembly&) -> DrawCost { refuse_assembly(); }});
}

void add_to_hash(Hasher& hasher, Kind kind, const Payload& payload, std::optional<Hash> mesh_hash) {
    visit_payload(
        kind, payload,
        Overloaded{[&](const Mesh& mesh) { hasher.value(mesh_hash ? *mesh_hash : hash_of(mesh)); },
                   [&](const Solid& solid) { add_solid(hasher, solid); },
                   [&](const Composite& composite) {
                       for (const Solid& solid : composite.solids) {
                           hasher.value(solid.box);
                           add_solid(hasher, solid);
                           hasher.value(solid.slot);
                       }
                   },
                   [](const Assembly&) { refuse_assembly(); }});
}

Mesh tessellated(Kind kind, const Payload& payload, int subdivisions) {
    return visit_payload(
        kind, payload,
        Overloaded{[](const Mesh& mesh) { return mesh; },
                   [&](const Solid& solid) {
                       return solid.box ? tessellate_box(solid.primitive)
                                        : tessellate_ellipsoid(solid.primitive, subdivisions);
                   },
                   [&](const Composite& composite) { return tessellate(composite, subdivisions); },
                   [](const Assembly&) -> Mesh { refuse_assembly(); }});
}

uint64_t solid_triangles(Kind kind, const Payload& payload) {
    return visit_payload(
        kind, payload,
        Overloaded{[](const Mesh&) { return uint64_t{0}; },
                   [](const Solid& solid) {
                       return triangles_of(solid.box ? Kind::Box : Kind::Ellipsoid);
                   },
                   [](const Composite& composite) {  // mostly ellipsoids
                       return composite.solids.size() * triangles_of(Kind::Ellipsoid);
                   },
                   [](const Assembly&) -> uint64_t { refuse_assembly(); }});
}

Payload moved(Kind kind, const Payload& payload, const Affine& place) {
    return visit_payload(
        kind, payload,
        Overloaded{
            [&](const Mesh& mesh) -> Payload {
                Mesh out;
                append(out, mesh, place);
                return std::make_shared<const Mesh>(std::move(out));
            },
            [&](const Solid& solid) -> Payload { return moved_primitive(solid.primitive, place); },
            [&](const Composite& composite) -> Payload {
                Composite out = composite;
                for (Solid& solid : out.solids)
                    solid.primitive = moved_primitive(solid.primitive, place);
                return std::make_shared<const Composite>(std::move(out));
            },
            [](const Assembly&) -> Payload { refuse_assembly(); }});
}

bool is_same(const Payload& a, const Payload& b) {
    return a.index() == b.index() && std::visit(
                                         [&](const auto& one) {
                                             using Held = std::decay_t<decltype(one)>;
                                             const Held& other = std::get<Held>(b);
                                             if constexpr (std::is_same_v<Held, Primitive>)
                                                 return one.center == other.center &&
                                                        one.axes == other.axes &&
                                                        one.half_size == other.half_size;
                                             else
                                                 return one == other;
                                         },
                                         a);
}

}  // namespace lodestone
