// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/evaluators/distance_error.h"

#include "hierarchy/evaluators/traced_candidate.h"

#include <algorithm>

namespace lodestone::hierarchy {
namespace {

void set_error(StandInCandidate& candidate, const measure::SurfaceDeviation& deviation,
               const MeasuredFinest& finest, double useless) {
    candidate.error = finest.error_at(deviation.error);
    candidate.at_least = candidate.error > useless;
    candidate.max_error = std::max(candidate.error, finest.error_at(deviation.max));
    candidate.moved = finest.error_at(deviation.moved);
}

}  // namespace

measure::DeviationReference::RepaintResult repaint(Mesh& level, const MeasuredFinest& finest,
                                                   const Job& job, double useless) {
    return finest.reference->repaint(level, finest.skin.get(), job, finest.options.group,
                                     finest.distance_for(useless));
}

void measure_mesh(StandInCandidate& candidate, const MeasuredFinest& finest, const Job& job,
                  double useless, const measure::DeviationReference::RepaintResult& known) {
    if (known.surely_useless) {
        candidate.error = candidate.max_error = std::numeric_limits<double>::infinity();
        return;
    }
    const Mesh& mesh = candidate.mesh();
    const std::vector<uint16_t> looks = finest.looks->of(mesh, candidate.materials);
    const measure::SurfaceLooks surface{looks, finest.looks.get(), skin_of(candidate, finest)};
    const double most = finest.distance_for(useless);
    set_error(candidate,
              finest.options.group ? finest.reference->roughly(mesh, surface, known, most, job)
                                   : finest.reference->of(mesh, surface, known, most, job),
              finest, useless);
}

void measure_primitive(StandInCandidate& candidate, const MeasuredFinest& finest, double useless,
                       const Job& job) {
    const Solid solid{candidate.kind == Kind::Box, candidate.primitive()};
    set_error(candidate,
              finest.reference->of(solid, finest.looks->of(candidate.materials[0]),
                                   finest.distance_for(useless), job),
              finest, useless);
}

void measure_to_the_end(StandInCandidate& candidate, const MeasuredFinest& finest, const Job& job) {
    if (!candidate.at_least)
        return;
    if (candidate.kind == Kind::Mesh)
        measure_mesh(candidate, finest, job);
    else
        measure_primitive(candidate, finest, std::numeric_limits<double>::infinity(), job);
}

}  // namespace lodestone::hierarchy
