// SPDX-License-Identifier: GPL-3.0-or-later
// Representation: one way to draw an object. Its summary is always known; its payload may be
// absent.
#pragma once

#include "model/attributes.h"
#include "model/representation_kinds.h"
#include "model/surface_level.h"

#include <vector>

namespace lodestone {

/// The slots of what a level was made from that the levels' last materials are means of, one list a
/// material; all materials before have the finish of the slot of their number.
using MaterialMeans = std::vector<SlotShares>;

struct RepresentationSummary {
    Kind kind = Kind::Mesh;
    double error = 0;      // metres, object's frame; 0 for the finest (docs/architecture.md, Words)
    double max_error = 0;  // the largest distance behind the error's quantile
    Bound bound;           // object's frame
    DrawCost cost;
    Hash hash = 0;   // of the payload and its materials: equal hashes draw the same
    Hash shape = 0;  // of the finest: the same without the materials' finishes
    /// For a group's stand-in: the children together do not look like the group where this is used,
    /// so that it is not opened for them where they cost less.
    bool sealed = false;
};

/// Bytes of a representation for each of `uses` occurrences, besides those of the occurrence
/// itself.
inline double bytes_per_occurrence(Kind kind, uint64_t bytes, uint64_t uses) {
    const double shares = is_copied(kind) || uses < 1 ? 1 : static_cast<double>(uses);
    return static_cast<double>(bytes) / shares;
}

struct Representation {
    RepresentationSummary summary;
    std::vector<uint32_t> materials;  // by slot, into Model::materials; a primitive uses the first
    MaterialMeans means;              // of a stand-in
    /// The chunks of a mesh that is a level of a large surface; null: it is drawn whole.
    std::shared_ptr<const SurfaceLevel> surface;
    Payload payload;

    bool resident() const { return payload.index() != 0; }
    /// Each throws Error(Internal) when the payload is another kind or not resident.
    const Mesh& mesh() const { return held<Mesh>(summary.kind, payload, "mesh"); }
    const Primitive& primitive() const { return held_primitive(summary.kind, payload); }
    const Assembly& assembly() const { return held<Assembly>(summary.kind, payload, "assembly"); }
    const Composite& composite() const {
        return held<Composite>(summary.kind, payload, "composite");
    }
};

/// Calls a visitor as visit_payload() does.
template <typename Visitor>
decltype(auto) visit(const Representation& representation, Visitor&& visitor) {
    return visit_payload(representation.summary.kind, representation.payload,
                         std::forward<Visitor>(visitor));
}

/// Its triangles, for consumers that know nothing else; ellipsoids as 20 * 4^subdivisions. Throws
/// Error(Internal) for an assembly, and for what is not resident.
inline Mesh tessellated(const Representation& representation, int subdivisions = 2) {
    return tessellated(representation.summary.kind, representation.payload, subdivisions);
}

}  // namespace lodestone
