// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/environment_stand_ins.h"

#include "hierarchy/evaluators/distance_error.h"
#include "measure/visible/visible_attributes.h"
#include "simplify/simplify.h"
#include "solids/composite_replacement.h"
#include "solids/keep_on_floor.h"
#include "solids/solid_replacement.h"
#include "solids/stand_in_material.h"

#include <algorithm>
#include <limits>

namespace lodestone::hierarchy {
namespace {

// How finely an ellipsoid beside environment is drawn: 80 triangles.
// Taste: one more is four times the triangles.
constexpr int kBesideSubdivisions = 1;
// The most solids beside environment.
// Taste: more come nearer and take longer to fit.
constexpr size_t kMostBeside = 8;

struct SolidsInEnvironment {
    Composite composite;
    std::vector<Attributes> attributes;  // by slot
};

/// A box and an ellipsoid of all that is no environment, standing where it stands.
std::vector<SolidsInEnvironment> singles(const Attributes& attributes, const Bound& bound) {
    std::vector<SolidsInEnvironment> out;
    for (const bool box : {true, false}) {
        const auto found =
            box ? solids::fit_box(attributes, bound) : solids::fit_ellipsoid(attributes, bound);
        if (!found)
            continue;
        const Primitive standing = solids::kept_above(*found, box, bound.box.low.z);
        out.push_back({{{{box, standing, 0}}}, {attributes}});
    }
    return out;
}

}  // namespace

void propose_environment_stand_ins(ProposalRound& round) {
    const std::vector<uint8_t>& environment = round.limits.environment;
    const MeasuredFinest& finest = round.finest;
    const std::vector<Material>& materials = finest.materials;
    const Job& job = round.job;
    if (environment.empty())
        return;
    std::vector<uint8_t> others;
    others.reserve(environment.size());
    for (const uint8_t one : environment)
        others.push_back(one != 0 ? 0 : 1);
    const Mesh around = subset(finest.mesh, environment);
    const Mesh rest = subset(finest.mesh, others);
    if (around.empty() || rest.empty() || finest.refracts())
        return;
    const Attributes attributes =
        measure::measure_visible(rest, ray::MeshScene(rest, finest.skin), finest.skin,
                                 finest.visible_options(finest.rays), {}, job)
            .attributes;
    if (attributes.empty())
        return;
    std::vector<SolidsInEnvironment> all = singles(attributes, bound_of(rest.positions));
    solids::CompositeOptions rough{finest.options.seed};
    rough.shape = false;
    rough.rounds = 0;
    rough.rays = static_cast<uint32_t>(finest.rays / 4);
    rough.most = kMostBeside;
    for (solids::ClusteredComposite& level :
         solids::composites(rest, finest.skin, attributes, rough, job))
        all.push_back({std::move(level.composite), std::move(level.attributes)});
    for (const SolidsInEnvironment& beside : all) {
        job.check();
        if (materials.size() + beside.attributes.size() > std::numeric_limits<uint16_t>::max())
            return;
        const Mesh solids = tessellate(beside.composite, kBesideSubdivisions);
        Mesh both = around.triangles.size() > solids.triangles.size()
                        ? simplify::simplify_mesh(around, solids.triangles.size(), {}, job)
                        : around;
        both.slots.resize(both.triangles.size(), 0);
        append(both, solids, {}, static_cast<uint16_t>(materials.size()));
        StandInCandidate candidate;
        candidate.payload = std::make_shared<const Mesh>(std::move(both));
        candidate.state = CandidateState::Unproven;
        candidate.materials = materials;
        for (const Attributes& own : beside.attributes) {
            candidate.materials.push_back(solids::mean_material(own));
            candidate.means.push_back(own.shares);
        }
        measure_mesh(candidate, finest, job);
        round.candidates.push_back(std::move(candidate));
    }
}

}  // namespace lodestone::hierarchy
