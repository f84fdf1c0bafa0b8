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
    if (candidate.kind == Kind::Mesh)
        return candidate.mesh();
    solid = tessellated(candidate.kind, candidate.payload,
                        is_copied(candidate.kind) ? kSubdivisionsInComposite : kSubdivisions);
    return solid;
}

ray::SkinPtr skin_of(const StandInCandidate& unmatched, const MeasuredFinest& finest) {
    const bool same =
        unmatched.kind == Kind::Mesh && unmatched.materials.size() == finest.materials.size();
    return same ? finest.skin : finest.skin_of(unmatched.materials);
}

}  // namespace lodestone::hierarchy
