// SPDX-License-Identifier: GPL-3.0-or-later
// The kinds of representations: a row for each with its name and numbers, and a visitor for what
// draws them.
#pragma once

#include "base/error.h"
#include "base/hash.h"
#include "model/composite.h"
#include "model/cost_model.h"
#include "model/placement.h"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace lodestone {

/// Numbers are those of the C interface and of files; new kinds are appended.
enum class Kind : uint8_t {
    Mesh = 1,
    Box = 3,
    Ellipsoid = 4,
    Composite = 7,
    Assembly = 8,
};

/// The facts about a kind that are known without its payload.
struct KindRow {
    Kind kind;
    const char* word;  // in files and reports
    bool drawn;        // false: it is drawn by what it places
    /// POV-Ray keeps a mesh once for all its occurrences, but copies the solids of a union for
    /// each, and forgets in clipped unions which rays see them.
    bool copied;
    /// Viewers draw meshes: ellipsoids as 20 * 4^subdivisions triangles, so many triangles in all.
    /// For a composite it is a guess from above, 32 ellipsoids; none: as many as its summary says.
    /// Taste: more subdivisions are rounder and four times the triangles each.
    int viewer_subdivisions;
    std::optional<uint64_t> viewer_triangles;
    /// The color of false-color pictures, sRGB; none: by level. Taste: told apart at a glance.
    std::optional<std::array<double, 3>> false_color;
};

/// Law: the words and numbers are those of files, a box has 12 triangles, an icosahedron 20.
inline constexpr std::array kKindRows{
    KindRow{Kind::Mesh, "mesh", true, false, 0, {}, {}},
    KindRow{Kind::Box, "box", true, false, 0, 12, {{0.93, 0.45, 0.13}}},
    KindRow{Kind::Ellipsoid, "ellipsoid", true, false, 1, 80, {{0.82, 0.20, 0.58}}},
    KindRow{Kind::Composite, "composite", true, true, 0, 32 * 20, {{0.55, 0.34, 0.76}}},
    KindRow{Kind::Assembly, "assembly", false, false, 0, 0, {}},
};
/// Law: one more than the largest number of a kind.
inline constexpr size_t kKindLimit = static_cast<size_t>(kKindRows.back().kind) + 1;

/// Throws Error(Internal) for a number that is no kind.
const KindRow& row_of(Kind kind);
/// Whether it is the number of a kind.
bool is_kind(int64_t number);
/// "mesh", "box", ...: the word used in files, reports and panels.
const char* name_of(Kind kind);
/// Throws Error(BadFile) for a word that is no kind.
Kind kind_named(const std::string& word);

using KindMask = uint32_t;
constexpr KindMask mask_of(Kind kind) {
    return KindMask{1} << static_cast<unsigned>(kind);
}
inline constexpr KindMask kAllKinds = ~KindMask{0};

/// The kinds of which a fact is true.
constexpr KindMask kinds_where(bool KindRow::*fact) {
    KindMask kinds = 0;
    for (const KindRow& row : kKindRows)
        kinds |= row.*fact ? mask_of(row.kind) : 0;
    return kinds;
}
inline constexpr KindMask kDrawnKinds = kinds_where(&KindRow::drawn);
inline constexpr KindMask kCopiedKinds = kinds_where(&KindRow::copied);
/// Whether POV-Ray keeps it anew for each occurrence.
constexpr bool is_copied(Kind kind) {
    return (kCopiedKinds & mask_of(kind)) != 0;
}

/// Children of a group. Shared by value: cheap to copy, never changed once in a representation.
struct Assembly {
    std::vector<Placement> placements;
};

/// monostate = not resident.
using Payload = std::variant<std::monostate, std::shared_ptr<const Mesh>, Primitive,
                             std::shared_ptr<const Assembly>, std::shared_ptr<const Composite>>;

/// Throws Error(Internal): a payload is not what its kind says, or not resident.
[[noreturn]] void wrong_payload(Kind kind, const Payload& payload, const char* wanted);

/// The Held of a payload; throws Error(Internal) when it is another kind's or not resident.
template <typename Held>
const Held& held(Kind kind, const Payload& payload, const char* wanted) {
    const auto* pointer = std::get_if<std::shared_ptr<const Held>>(&payload);
    if (pointer == nullptr || *pointer == nullptr)
        wrong_payload(kind, payload, wanted);
    return **pointer;
}
const Primitive& held_primitive(Kind kind, const Payload& payload);

/// Calls a visitor with what a kind draws: a Mesh, a Solid (a box or an ellipsoid, in slot 0), a
/// Composite or an Assembly. It is an overload for each, so that a new kind does not compile until
/// everything that draws has a word on it. Throws as held() does.
template <typename Visitor>
decltype(auto) visit_payload(Kind kind, const Payload& payload, Visitor&& visitor) {
    switch (kind) {
        case Kind::Mesh:
            return visitor(held<Mesh>(kind, payload, "mesh"));
        case Kind::Box:
            return visitor(Solid{true, held_primitive(kind, payload), 0});
        case Kind::Ellipsoid:
            return visitor(Solid{false, held_primitive(kind, payload), 0});
        case Kind::Composite:
            return visitor(held<Composite>(kind, payload, "composite"));
        case Kind::Assembly:
            return visitor(held<Assembly>(kind, payload, "assembly"));
    }
    wrong_payload(kind, payload, "a kind");
}

/// A visitor made of one function for each type.
template <typename... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <typename... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

/// The cost of drawing it once, for a consumer that shares it between occurrences.
struct DrawCost {
    uint64_t triangles = 0;  // those of the mesh; an assembly: of all it places; a primitive: 0
    uint64_t bytes = 0;      // the renderer's memory for one distinct representation
};

// The functions that follow are for kinds that are drawn: each throws Error(Internal) for an
// assembly.

Bound bound_of(Kind kind, const Payload& payload);
DrawCost cost_of(Kind kind, const Payload& payload, const CostModel& costs);
/// `mesh_hash`: that of the mesh, where it is known.
void add_to_hash(Hasher& hasher, Kind kind, const Payload& payload,
                 std::optional<Hash> mesh_hash = {});

/// Its triangles, for consumers that know nothing else; ellipsoids as 20 * 4^subdivisions.
Mesh tessellated(Kind kind, const Payload& payload, int subdivisions = 2);
/// The triangles that viewers draw for its solids; 0 for a mesh.
uint64_t solid_triangles(Kind kind, const Payload& payload);

/// The same elsewhere; `place` turns and moves.
Payload moved(Kind kind, const Payload& payload, const Affine& place);

/// Whether two payloads are one: the same mesh in memory, a primitive of the same size and axes
/// at the same place.
bool is_same(const Payload& a, const Payload& b);

}  // namespace lodestone
