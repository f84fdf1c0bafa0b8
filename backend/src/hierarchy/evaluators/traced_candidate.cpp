// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/evaluators/traced_candidate.h"

namespace lodestone::hierarchy {
namespace {

// An ellipsoid alone is traced as 1280 triangles, in a composite as 320.
// Taste: no sample of the pictures is as small; one more is four times the triangles.
constexpr int kSubdivisions = 3;
// Taste: no sample of the pictures is as small; one more is four times the triangles.
constexpr int kSubdivisionsInComposite = 2;

}  // namespace

const Mesh& traced_mesh(const StandInCandidate& candidate, Mesh& solid) {
    switch (candidate.kind) {
        case Kind::Mesh:
            return *candidate.mesh;
        case Kind::Composite:
            solid = tessellate(*candidate.composite, kSubdivisionsInComposite);
            return solid;
        case Kind::Box:
            solid = tessellate_box(candidate.primitive);
            return solid;
        default:
            solid = tessellate_ellipsoid(candidate.primitive, kSubdivisions);
            return solid;
    }
}

ray::SkinPtr skin_of(const StandInCandidate& unmatched, const MeasuredFinest& finest) {
    const bool same =
        unmatched.kind == Kind::Mesh && unmatched.materials.size() == finest.materials.size();
    return same ? finest.skin : finest.skin_of(unmatched.materials);
}

}  // namespace lodestone::hierarchy
