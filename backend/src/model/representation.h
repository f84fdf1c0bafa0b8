// SPDX-License-Identifier: GPL-3.0-or-later
// Representation: one way to draw an object. Its summary is always known; its payload may be
// absent.
#pragma once

#include "base/hash.h"
#include "model/composite.h"
#include "model/placement.h"

#include <memory>
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

/// "mesh", "box", ...: the word used in files, reports and panels.
const char* name_of(Kind kind);
/// Throws Error(BadFile) for a word that is no kind.
Kind kind_named(const std::string& word);

using KindMask = uint32_t;
constexpr KindMask mask_of(Kind kind) {
    return KindMask{1} << static_cast<unsigned>(kind);
}
inline constexpr KindMask kAllKinds = ~KindMask{0};

/// What drawing it once costs a consumer that shares it between occurrences.
struct DrawCost {
    uint64_t triangles = 0;  // of the mesh; an assembly: of all it places; a primitive: 0
    uint64_t bytes = 0;      // in the renderer's memory, for one distinct representation
};

struct RepresentationSummary {
    Kind kind = Kind::Mesh;
    double error = 0;      // metres, object's frame; 0 for the finest (docs/architecture.md, Words)
    double max_error = 0;  // the largest distance behind the error's quantile
    Bound bound;           // object's frame
    DrawCost cost;
    Hash hash = 0;  // of the payload and its materials: equal hashes draw the same
    /// Of a group's stand-in: its children do not look like the group together where this is used,
    /// so that it is not opened for them where they cost less.
    bool sealed = false;
};

/// Bytes of a representation for each of `uses` occurrences, besides those of the occurrence
/// itself.
inline double bytes_per_occurrence(Kind kind, uint64_t bytes, uint64_t uses) {
    const double shares = kind == Kind::Composite || uses < 1 ? 1 : static_cast<double>(uses);
    return static_cast<double>(bytes) / shares;
}

/// Children of a group. Shared by value: cheap to copy, never changed once in a representation.
struct Assembly {
    std::vector<Placement> placements;
};

/// monostate = not resident.
using Payload = std::variant<std::monostate, std::shared_ptr<const Mesh>, Primitive,
                             std::shared_ptr<const Assembly>, std::shared_ptr<const Composite>>;

struct Representation {
    RepresentationSummary summary;
    std::vector<uint32_t> materials;  // by slot, into Model::materials; a primitive uses the first
    Payload payload;

    bool resident() const { return payload.index() != 0; }
    /// Each throws Error(Internal) when the payload is another kind or not resident.
    const Mesh& mesh() const;
    const Primitive& primitive() const;
    const Assembly& assembly() const;
    const Composite& composite() const;
};

/// Its triangles, for consumers that know nothing else; ellipsoids as 20 * 4^subdivisions. Throws
/// Error(Internal) for an assembly, and for what is not resident.
Mesh tessellated(const Representation& representation, int subdivisions = 2);

}  // namespace lodestone
