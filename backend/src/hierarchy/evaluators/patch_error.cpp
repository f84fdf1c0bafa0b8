// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/evaluators/patch_error.h"

#include "hierarchy/evaluators/brightness_match.h"
#include "hierarchy/evaluators/distance_error.h"
#include "hierarchy/evaluators/traced_candidate.h"
#include "hierarchy/evaluators/view_error.h"

#include <algorithm>
#include <cmath>

namespace lodestone::hierarchy {
namespace {

// A level that shows this much more or less surface than the original is no simplification of it
// (foliage gone bald), however near its remaining points are.
// Taste: a larger value allows foliage that is balder.
constexpr double kMostAreaChange = 0.25;

void raise_to(StandInCandidate& candidate, double seen) {
    candidate.error = std::max(candidate.error, seen);
    candidate.max_error = std::max(candidate.max_error, seen);
}

bool shows_as_much_in(const Mesh& level, const ray::MeshScene& scene, const MeasuredFinest& finest,
                      const Job& job) {
    // Few rays tell levels that are nearly alike from those that are far off. They are not sure
    // where the change is within this distance of the limit.
    // Taste: a larger value casts more rays.
    constexpr double kUnsure = 0.15;
    // Rays that are surer for the finest are surer for a level that resembles it: no pilot is cast.
    const auto casting = finest.sampler().from_surface() ? measure::CastMethod::FromSurface
                                                         : measure::CastMethod::FromBound;
    const measure::VisibleSampler sampler(level, scene, finest.options.seed, casting);
    double change = 0;
    for (const uint64_t share : {8, 2}) {
        const double visible = measure::visible_area(sampler, finest.rays / share, job);
        change = std::abs(visible / finest.attributes.visible_area - 1);
        if (std::abs(change - kMostAreaChange) > kUnsure)
            break;
    }
    return change <= kMostAreaChange;
}

}  // namespace

bool shows_as_much(const Mesh& level, const MeasuredFinest& finest, const Job& job) {
    return shows_as_much_in(level, ray::MeshScene(level, finest.skin), finest, job);
}

bool prove(StandInCandidate& candidate, const MeasuredFinest& finest, double used_to,
           const Job& job) {
    const bool is_mesh = candidate.kind == Kind::Mesh;
    Mesh solid;
    const Mesh& mesh = traced_mesh(candidate, solid);
    const ray::SkinPtr skin = skin_of(candidate, finest);
    const ray::MeshScene scene(mesh, skin);
    come_to(candidate, CandidateState::Measured);
    if (is_mesh && !shows_as_much_in(mesh, scene, finest, job))
        return false;
    measure_to_the_end(candidate, finest, job);
    count_views(candidate, mesh, scene, finest, job);
    const double child_error = finest.options.child_error;
    if (finest.shading) {
        const double least = (candidate.error - child_error) / kShading;
        const double shaded = kShading * finest.shading->largest_unlike_patch(mesh, scene, least);
        // Nothing that is a pixel wide shows its relief.
        raise_to(candidate, std::min(shaded, 2 * finest.size) + child_error);
    }
    if (!finest.patches)
        return true;
    const double own = candidate.error - child_error;
    const double unlike = finest.patches->largest_unlike_patch(
        mesh, scene, *skin, is_matched(finest, used_to), own / kPatches);
    raise_to(candidate, kPatches * unlike + child_error);
    return true;
}

}  // namespace lodestone::hierarchy
