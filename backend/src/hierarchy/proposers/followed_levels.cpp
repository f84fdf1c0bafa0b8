// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/followed_levels.h"

#include "deform/level_binding.h"
#include "hierarchy/counted_error.h"
#include "hierarchy/evaluators/distance_error.h"
#include "hierarchy/evaluators/patch_error.h"
#include "hierarchy/proposers/collapse_levels.h"
#include "simplify/simplify.h"

#include <algorithm>
#include <optional>

namespace lodestone::hierarchy {
namespace {

/// Tells whether a level's error is one of materials: larger than that of the bare shape.
class LookError {
public:
    LookError(const Mesh& finest, const std::vector<Material>& materials,
              const BuildSettings& settings, uint64_t seed, const Job& job) {
        const bool alike = materials.size() == 1 && finest.colors.empty() &&
                           !textured(materials[0]) && !materials[0].other;
        if (!alike)
            bare_.emplace(finest,
                          measure::DeviationOptions{settings.samples, settings.samples, seed},
                          measure::SurfaceLooks{}, job);
    }

    /// Metres; 0 where the shape decides.
    double of(const Mesh& level, const MeasuredFinest& finest, const Job& job) const {
        if (!bare_)
            return 0;
        StandInCandidate candidate;
        candidate.payload = std::make_shared<const Mesh>(level);
        candidate.materials = finest.materials;
        measure_mesh(candidate, finest, job);
        const double bare = bare_->of(level, {}, job).error;
        return candidate.error > 1.01 * bare ? candidate.error : 0;
    }

private:
    std::optional<measure::DeviationReference> bare_;
};

}  // namespace

segment::BoundLevels bound_levels_of_leaf(const PoseBinding& bind, const BuildSettings& settings,
                                          const MeshSource& source, image::TexelCache& texels,
                                          const Job& job) {
    segment::BoundLevels out;
    const Representation& finest = bind.object->representations.at(0);
    const std::shared_ptr<const Mesh> mesh = source(finest);
    if (mesh->empty())
        return out;
    const std::vector<size_t> targets = targets_of(*mesh, settings);
    if (targets.empty())
        return out;
    const std::vector<Material> materials = materials_of(*bind.model, finest);
    FinestOptions options{bind.hash};
    options.environment = bind.object->role == ObjectRole::Environment;
    const MeasuredFinest original =
        measure_finest(*mesh, materials, texels, settings, options, job);
    if (original.attributes.empty())
        return out;
    std::vector<std::vector<glm::vec3>> others;
    const std::vector<uint32_t> points = deform::points_of(*mesh, *bind.object->pose);
    for (const PosedSurface* pose : bind.others) {
        std::vector<glm::vec3>& positions = others.emplace_back();
        for (const uint32_t point : points)
            positions.push_back(pose->points.at(point));
    }
    Mesh plain;
    const Mesh& visible = without_unseen_colors(*mesh, materials, plain);
    const deform::PoseSurface surface(*bind.object->pose);
    const deform::LevelBinder binder(visible, surface);
    const LookError look_error(visible, materials, settings, bind.hash, job);
    for (simplify::TracedLevel& level :
         simplify::simplify_traced(visible, others, targets, {}, job)) {
        if (level.mesh.empty())
            continue;
        repaint(level.mesh, original, job);
        if (!shows_as_much(level.mesh, original, job))
            continue;
        std::optional<deform::BoundLevel> bound = binder.bind(std::move(level));
        if (!bound)
            continue;
        bound->look_error = look_error.of(bound->mesh, original, job);
        out.push_back(std::move(*bound));
    }
    return out;
}

std::vector<StandInCandidate> followed_levels(const Model& model, const Object& object,
                                              const segment::BoundLevels& levels, const Job& job) {
    // The least factor between the errors of two levels. A coarser level may be the better one in
    // some frame, but levels keep their numbers.
    // Law: more than 1 by the least that rounding of doubles keeps, with a large margin.
    constexpr double kRise = 1 + 1e-9;
    std::vector<StandInCandidate> out;
    const Representation& finest = object.representations.at(0);
    if (levels.empty() || object.pose == nullptr)
        return out;
    const std::vector<Material> materials = materials_of(model, finest);
    const deform::PoseSurface surface(*object.pose);
    const auto counted = [&](double error) {
        return counted_error(error, object.role == ObjectRole::Environment,
                             finest.summary.bound.radius);
    };
    for (const deform::BoundLevel& level : levels) {
        job.check();
        std::optional<Mesh> followed = deform::follow(level, surface);
        if (!followed || followed->triangles.size() >= finest.summary.cost.triangles)
            continue;
        const deform::PoseError pose_error = deform::pose_error(level, *followed, surface);
        StandInCandidate candidate;
        candidate.payload = std::make_shared<const Mesh>(std::move(*followed));
        candidate.materials = materials;
        candidate.error = counted(
            std::max(pose_error.error, level.look_error * std::max(1.0, pose_error.growth)));
        if (!out.empty())
            candidate.error = std::max(candidate.error, kRise * out.back().error);
        candidate.max_error = std::max(counted(pose_error.max), candidate.error);
        out.push_back(std::move(candidate));
    }
    return out;
}

}  // namespace lodestone::hierarchy
