// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/evaluators/chunk_error.h"

#include "base/parallel.h"
#include "hierarchy/evaluators/patch_error.h"
#include "hierarchy/evaluators/traced_candidate.h"
#include "hierarchy/evaluators/view_error.h"
#include "measure/deviation/part_deviations.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lodestone::hierarchy {
namespace {

/// The triangles of the finest, chunk by chunk.
std::vector<uint32_t> order_by_chunk(const Mesh& mesh, const SurfaceLevel& original) {
    std::vector<uint16_t> chunks(mesh.triangles.size());
    parallel_for((chunks.size() + kBlock - 1) / kBlock, [&](size_t block) {
        for (size_t t = block * kBlock; t < std::min(chunks.size(), (block + 1) * kBlock); ++t)
            chunks[t] = static_cast<uint16_t>(original.tree->chunk_of(mesh, t));
    });
    std::vector<uint32_t> next(original.before.begin(), original.before.end() - 1);
    std::vector<uint32_t> order(chunks.size());
    for (uint32_t t = 0; t < chunks.size(); ++t)
        order[next[chunks[t]]++] = t;
    return order;
}

class ChunkMeasurer {
public:
    ChunkMeasurer(const SurfaceLevel& original, const MeasuredFinest& finest, const Job& job)
        : original_(original),
          finest_(finest),
          job_(job),
          order_(order_by_chunk(finest.mesh, original)) {}

    /// The errors of a level's nodes.
    std::vector<double> errors_of(const StandInCandidate& candidate) const {
        const SurfaceLevel& level = *candidate.surface;
        const Mesh& mesh = candidate.mesh();
        const ray::SkinPtr skin = skin_of(candidate, finest_);
        const ray::MeshScene scene(mesh, skin);
        std::vector<double> errors;
        for (const measure::SurfaceDeviation& off : deviations(level, mesh, scene)) {
            const double farthest = finest_.error_at(off.max);
            // The level was looked at from all sides, where that could show more than its error.
            errors.push_back(std::max({finest_.error_at(off.error),
                                       std::min(farthest / kFartherInView, candidate.error),
                                       std::min(farthest, candidate.seen), candidate.moved}));
        }
        if (finest_.shading)
            count_shading(candidate, scene, errors);
        double everywhere = 0;
        if (finest_.patches) {
            const double least = *std::min_element(errors.begin(), errors.end());
            everywhere = kPatches * finest_.patches->largest_unlike_patch(mesh, scene, *skin, false,
                                                                          least / kPatches);
        }
        for (double& error : errors) {
            error = std::max(error, everywhere);
            if (!std::isfinite(error))  // nothing of the level can be seen
                error = candidate.error;
        }
        return errors;
    }

private:
    std::vector<measure::SurfaceDeviation> deviations(const SurfaceLevel& level, const Mesh& mesh,
                                                      const ray::MeshScene& scene) const {
        std::vector<uint32_t> before;  // of the finest's triangles, by the level's nodes
        for (uint32_t node = 0; node <= level.nodes(); ++node)
            before.push_back(original_.before[size_t{node} << level.shift]);
        std::vector<uint32_t> own(mesh.triangles.size());
        std::iota(own.begin(), own.end(), 0);
        return measure::part_deviations({finest_.mesh, finest_.scene(), order_, before},
                                        {mesh, scene, own, level.before}, finest_.options.seed,
                                        job_);
    }

    /// A level is shaded like the finest in the mean of its patches: a chunk that is shaded worse
    /// counts no more than all of it.
    void count_shading(const StandInCandidate& candidate, const ray::MeshScene& scene,
                       std::vector<double>& errors) const {
        const SurfaceLevel& level = *candidate.surface;
        std::vector<double> least;
        least.reserve(errors.size());
        for (const double error : errors)
            least.push_back(error / kShading);
        const std::vector<double> unlike = finest_.shading->largest_unlike_patches(
            candidate.mesh(), scene,
            [&](uint32_t triangle) {
                return level.tree->chunk_of(finest_.mesh, triangle) >> level.shift;
            },
            least);
        for (size_t node = 0; node < errors.size(); ++node)
            errors[node] =
                std::max(errors[node], std::min(kShading * unlike[node], candidate.error));
    }

    const SurfaceLevel& original_;
    const MeasuredFinest& finest_;
    const Job& job_;
    std::vector<uint32_t> order_;
};

/// Makes no chunk's error less than those of a finer level in it.
void raise_to_finer(const SurfaceLevel& finer, SurfaceLevel& level) {
    for (uint32_t node = 0; node < finer.errors.size(); ++node) {
        double& own = level.errors[node >> (level.shift - finer.shift)];
        own = std::max(own, finer.errors[node]);
    }
}

}  // namespace

void measure_chunks(std::vector<StandInCandidate>& levels, const SurfaceLevel* original,
                    const MeasuredFinest& finest, const Job& job) {
    if (original == nullptr)
        return;
    const ChunkMeasurer measurer(*original, finest, job);
    std::shared_ptr<const SurfaceLevel> finer;
    for (StandInCandidate& candidate : levels) {
        if (candidate.surface == nullptr || candidate.surface->nodes() < 2 ||
            candidate.state != CandidateState::Measured)
            continue;
        auto level = std::make_shared<SurfaceLevel>(*candidate.surface);
        level->errors = measurer.errors_of(candidate);
        if (finer != nullptr)
            raise_to_finer(*finer, *level);
        level->hash = hash_of(*level);
        candidate.surface = finer = std::move(level);
    }
}

}  // namespace lodestone::hierarchy
