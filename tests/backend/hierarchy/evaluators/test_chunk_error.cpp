// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that each chunk of a large surface is as far off as it says, and no more.
#include "geometry/surface_partition.h"
#include "hierarchy/evaluators/chunk_error.h"
#include "hierarchy/evaluators/distance_error.h"
#include "scenes/chunk_truth.h"
#include "scenes/fine_grids.h"
#include "scenes/ridged_terrain.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"
#include "simplify/surface_levels.h"

#include <cmath>
#include <limits>

using namespace lodestone;
using hierarchy::CandidateState;

namespace {

class ChunkErrors : public WithRays {
protected:
    /// The levels of a mesh with their errors by distance, finest first.
    std::vector<hierarchy::StandInCandidate> levels_of(const hierarchy::MeasuredFinest& finest,
                                                       size_t chunk) {
        std::vector<uint16_t> chunks;
        auto tree = std::make_shared<const SurfaceTree>(
            geometry::part_surface(finest.mesh, chunk, 12, chunks));
        std::vector<size_t> targets;
        for (size_t count = finest.mesh.triangles.size() * 2 / 5; count > 40; count = count * 2 / 5)
            targets.push_back(count);
        simplify::SimplifiedSurface surface =
            simplify::simplify_surface(finest.mesh, tree, chunks, targets);
        original_ = surface.original;
        std::vector<hierarchy::StandInCandidate> out;
        for (size_t i = 0; i < surface.levels.size(); ++i) {
            hierarchy::StandInCandidate& level = out.emplace_back();
            level.payload = std::make_shared<const Mesh>(std::move(surface.levels[i]));
            level.materials = finest.materials;
            level.surface = surface.chunks[i];
            hierarchy::measure_mesh(level, finest, {});
        }
        return out;
    }
    hierarchy::MeasuredFinest measured(const Mesh& mesh) {
        return hierarchy::measure_finest(mesh, materials_, texels_, {}, {}, {});
    }
    void measure(std::vector<hierarchy::StandInCandidate>& levels,
                 const hierarchy::MeasuredFinest& finest) const {
        hierarchy::measure_chunks(levels, original_.get(), finest, {});
    }
    /// The same with the errors of their chunks.
    std::vector<hierarchy::StandInCandidate> measured_levels(
        const hierarchy::MeasuredFinest& finest, size_t chunk) {
        std::vector<hierarchy::StandInCandidate> levels = levels_of(finest, chunk);
        measure(levels, finest);
        return levels;
    }
    static double largest(const SurfaceLevel& level) {
        return *std::max_element(level.errors.begin(), level.errors.end());
    }

    std::vector<Material> materials_{models::colored("gray", glm::dvec3(0.5))};
    image::TexelCache texels_;
    std::shared_ptr<const SurfaceLevel> original_;
};

Mesh half_plain(uint32_t side) {
    return terrains::height_field(side, 1000, terrains::half_plain_height_at);
}

}  // namespace

TEST_F(ChunkErrors, WhatHasNoChunksHasNone) {
    const Mesh mesh = shapes::grid(8);
    const hierarchy::MeasuredFinest finest = measured(mesh);
    std::vector<hierarchy::StandInCandidate> none;
    hierarchy::measure_chunks(none, nullptr, finest, {});
    std::vector<hierarchy::StandInCandidate> levels = levels_of(finest, 100000);
    ASSERT_FALSE(levels.empty());
    measure(levels, finest);  // one chunk
    for (const hierarchy::StandInCandidate& level : levels)
        EXPECT_TRUE(level.surface->errors.empty());
}

TEST_F(ChunkErrors, NoChunkIsMuchFartherOffThanItSays) {
    const Mesh mesh = half_plain(129);
    const hierarchy::MeasuredFinest finest = measured(mesh);
    const std::vector<hierarchy::StandInCandidate> levels = measured_levels(finest, 1024);
    size_t looked_at = 0;
    for (const hierarchy::StandInCandidate& level : levels) {
        if (level.surface->errors.empty())
            continue;
        Representation drawn;
        drawn.payload = level.payload;
        drawn.surface = level.surface;
        const std::vector<double> truth = chunks::true_errors(mesh, drawn);
        for (size_t node = 0; node < truth.size(); ++node, ++looked_at)
            EXPECT_LE(truth[node], 1.5 * level.surface->errors[node]) << "node " << node;
    }
    EXPECT_GT(looked_at, 20u);
}

TEST_F(ChunkErrors, AFlatFieldDoesNotPayForTheRoughestCliff) {
    const Mesh mesh = half_plain(129);
    const hierarchy::MeasuredFinest finest = measured(mesh);
    const std::vector<hierarchy::StandInCandidate> levels = measured_levels(finest, 1024);
    const SurfaceLevel& level = *levels[0].surface;
    ASSERT_EQ(level.errors.size(), level.nodes());
    size_t flat = 0;
    for (uint32_t node = 0; node < level.nodes(); ++node) {
        if (level.tree->boxes[(node + 1) * (size_t{1} << level.shift) - 1].high.x > 390)
            continue;
        EXPECT_LT(level.errors[node], levels[0].error / 4) << "node " << node;
        ++flat;
    }
    EXPECT_GE(flat, 3u);
}

TEST_F(ChunkErrors, CoarserChunksAreNoNearer) {
    const Mesh mesh = half_plain(129);
    const hierarchy::MeasuredFinest finest = measured(mesh);
    const std::vector<hierarchy::StandInCandidate> levels = measured_levels(finest, 512);
    size_t compared = 0;
    for (size_t i = 0; i + 1 < levels.size() && !levels[i + 1].surface->errors.empty(); ++i) {
        const SurfaceLevel& finer = *levels[i].surface;
        const SurfaceLevel& coarser = *levels[i + 1].surface;
        EXPECT_EQ(hash_of(coarser), coarser.hash);
        for (uint32_t node = 0; node < finer.nodes(); ++node, ++compared)
            EXPECT_LE(finer.errors[node], coarser.errors[node >> (coarser.shift - finer.shift)]);
    }
    EXPECT_GT(compared, 30u);
}

TEST_F(ChunkErrors, GulliesThatAreGoneFromTheShadingCountInTheirChunk) {
    // Waves of 1.6 m, 4 cm high, in the west of a square of 20 m: a level of a plain is near them,
    // and shows none.
    Mesh mesh = shapes::grid(160);
    Mesh plain = mesh;
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        const double x = 20.0 * mesh.positions[i].x;
        plain.positions[i] = 20.0f * mesh.positions[i];
        mesh.positions[i] = plain.positions[i];
        mesh.positions[i].z = x < 10 ? static_cast<float>(0.04 * std::sin(3.927 * x)) : 0;
    }
    const hierarchy::MeasuredFinest finest = measured(mesh);
    std::vector<hierarchy::StandInCandidate> levels = levels_of(finest, 6400);
    ASSERT_GE(levels[0].surface->nodes(), 4u);
    // The finest's own triangles, flattened, in the order of the level's nodes.
    SurfaceLevel surface = *levels[0].surface;
    Mesh flat = plain;
    flat.triangles.clear();
    surface.before = {0};
    for (uint32_t node = 0; node < surface.nodes(); ++node) {
        for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            if (surface.tree->chunk_of(mesh, t) >> surface.shift == node)
                flat.triangles.push_back(mesh.triangles[t]);
        }
        surface.before.push_back(static_cast<uint32_t>(flat.triangles.size()));
    }
    levels.resize(1);
    levels[0].payload = std::make_shared<const Mesh>(std::move(flat));
    levels[0].surface = std::make_shared<const SurfaceLevel>(std::move(surface));
    levels[0].error = 0.2;
    measure(levels, finest);
    const SurfaceLevel& level = *levels[0].surface;
    for (uint32_t node = 0; node < level.nodes(); ++node) {
        const Box3& box = level.tree->boxes[size_t{node} << level.shift];
        if (box.low.x > 10) {
            EXPECT_LT(level.errors[node], 0.001) << "node " << node;
        } else if (box.high.x < 10) {
            EXPECT_GT(level.errors[node], 0.08) << "node " << node << " is 4 cm off by distance";
            EXPECT_LE(level.errors[node], 0.2) << "node " << node;
        }
    }
}

TEST_F(ChunkErrors, WhatHasNoPlaceCountsInAllChunks) {
    const Mesh mesh = half_plain(129);
    const hierarchy::MeasuredFinest finest = measured(mesh);
    std::vector<hierarchy::StandInCandidate> levels = levels_of(finest, 1024);
    levels.resize(1);
    levels[0].moved = levels[0].error = 50;
    measure(levels, finest);
    for (const double error : levels[0].surface->errors)
        EXPECT_EQ(error, 50);
}

TEST_F(ChunkErrors, WhatOneSideShowsCountsWhereAnythingIsAsFarOff) {
    const Mesh mesh = half_plain(129);
    const hierarchy::MeasuredFinest finest = measured(mesh);
    std::vector<hierarchy::StandInCandidate> levels = levels_of(finest, 1024);
    levels.resize(1);
    std::vector<hierarchy::StandInCandidate> seen = levels;
    seen[0].seen = seen[0].error = 50;
    measure(levels, finest);
    measure(seen, finest);
    for (size_t node = 0; node < levels[0].surface->errors.size(); ++node) {
        EXPECT_GE(seen[0].surface->errors[node], levels[0].surface->errors[node]);
        EXPECT_LT(seen[0].surface->errors[node], 10) << "nothing is 50 m off";
    }
    EXPECT_GT(largest(*seen[0].surface), largest(*levels[0].surface));
}

TEST_F(ChunkErrors, ALevelThatIsMadeAsBrightKeepsItsOwnError) {
    const Mesh mesh = half_plain(65);
    const hierarchy::MeasuredFinest finest = measured(mesh);
    std::vector<hierarchy::StandInCandidate> levels = levels_of(finest, 512);
    come_to(levels[0], CandidateState::Matched);
    measure(levels, finest);
    EXPECT_TRUE(levels[0].surface->errors.empty());
}
