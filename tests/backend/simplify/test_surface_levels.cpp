// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that chunks of several levels of a large surface close exactly, whatever is chosen.
#include "base/parallel.h"
#include "geometry/closed_surface.h"
#include "geometry/surface_partition.h"
#include "scenes/open_edges.h"
#include "simplify/surface_levels.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <random>

using namespace lodestone;

namespace {

/// A hilly sheet of 2 x size^2 triangles.
Mesh terrain(uint32_t size) {
    Mesh mesh;
    for (uint32_t y = 0; y <= size; ++y) {
        for (uint32_t x = 0; x <= size; ++x) {
            const auto u = static_cast<float>(x) / static_cast<float>(size);
            const auto v = static_cast<float>(y) / static_cast<float>(size);
            mesh.positions.emplace_back(u, v,
                                        0.05f * std::sin(23 * u + 3 * v) * std::cos(17 * v) +
                                            0.01f * std::sin(61 * u) * std::sin(97 * v));
            mesh.uvs.emplace_back(u, v);
        }
    }
    for (uint32_t y = 0; y < size; ++y) {
        for (uint32_t x = 0; x < size; ++x) {
            const uint32_t at = y * (size + 1) + x;
            mesh.triangles.emplace_back(at, at + 1, at + size + 2);
            mesh.triangles.emplace_back(at, at + size + 2, at + size + 1);
        }
    }
    return mesh;
}

/// A closed bumpy torus.
Mesh torus(uint32_t size) {
    Mesh mesh;
    constexpr float kTurn = 6.2831853f;
    for (uint32_t i = 0; i < size; ++i) {
        for (uint32_t j = 0; j < size; ++j) {
            const float u = kTurn * static_cast<float>(i) / static_cast<float>(size);
            const float v = kTurn * static_cast<float>(j) / static_cast<float>(size);
            const float r = 0.4f + 0.03f * std::sin(9 * u) * std::sin(7 * v);
            mesh.positions.emplace_back((1 + r * std::cos(v)) * std::cos(u),
                                        (1 + r * std::cos(v)) * std::sin(u), r * std::sin(v));
        }
    }
    for (uint32_t i = 0; i < size; ++i) {
        for (uint32_t j = 0; j < size; ++j) {
            const auto at = [&](uint32_t a, uint32_t b) { return a % size * size + b % size; };
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    return mesh;
}

struct Surface {
    Mesh mesh;
    simplify::SimplifiedSurface levels;
    std::vector<geometry::SurfaceSource> sources() const {
        std::vector<geometry::SurfaceSource> out{{mesh, *levels.original}};
        for (size_t i = 0; i < levels.levels.size(); ++i)
            out.push_back({levels.levels[i], *levels.chunks[i]});
        return out;
    }
};

Surface simplified(Mesh mesh, size_t chunk) {
    Surface out;
    out.mesh = std::move(mesh);
    std::vector<uint16_t> chunks;
    auto tree = std::make_shared<SurfaceTree>(geometry::part_surface(out.mesh, chunk, 10, chunks));
    std::vector<size_t> targets;
    for (size_t count = out.mesh.triangles.size() * 2 / 5; count > 40; count = count * 2 / 5)
        targets.push_back(count);
    out.levels = simplify::simplify_surface(out.mesh, tree, chunks, targets);
    return out;
}

/// A random choice: nodes of coarse levels are taken, or opened.
std::vector<uint8_t> random_choice(const std::vector<geometry::SurfaceSource>& sources,
                                   std::mt19937& random, double open) {
    std::vector<uint8_t> out(sources.front().level.tree->chunks());
    const std::function<void(size_t, uint32_t, uint32_t)> choose = [&](size_t source,
                                                                       uint32_t first,
                                                                       uint32_t last) {
        const uint32_t shift = sources[source].level.shift;
        for (uint32_t at = first; at < last; at += 1u << shift) {
            const bool opened = source > 0 && std::uniform_real_distribution<>(0, 1)(random) < open;
            if (opened)
                choose(source - 1, at, at + (1u << shift));
            else
                std::fill_n(out.begin() + at, 1u << shift, static_cast<uint8_t>(source));
        }
    };
    choose(sources.size() - 1, 0, static_cast<uint32_t>(out.size()));
    return out;
}

TEST(SurfaceLevels, OneChunkIsTheWholeChain) {
    const Surface surface = simplified(terrain(16), 100000);
    ASSERT_FALSE(surface.levels.levels.empty());
    EXPECT_EQ(surface.levels.original->points.size(), 0u);
    for (const auto& level : surface.levels.chunks)
        EXPECT_EQ(level->nodes(), 1u);
}

TEST(SurfaceLevels, EachLevelFitsItself) {
    const Surface surface = simplified(terrain(128), 1000);
    const auto sources = surface.sources();
    ASSERT_GE(sources.size(), 5u);
    for (size_t i = 0; i < sources.size(); ++i) {
        check(sources[i].level, sources[i].mesh.positions.size(), sources[i].mesh.triangles.size());
        EXPECT_EQ(sources[i].level.step, i);
        const Mesh whole = geometry::closed_surface(
            sources, std::vector<uint8_t>(sources[0].level.tree->chunks(), uint8_t(i)));
        EXPECT_EQ(whole.triangles.size(), sources[i].mesh.triangles.size());
    }
    EXPECT_GT(sources[1].level.nodes(), 8u);
    EXPECT_EQ(sources.back().level.nodes(), 1u);
}

TEST(SurfaceLevels, AnyChoiceOfAClosedSurfaceIsClosed) {
    const Surface surface = simplified(torus(128), 1000);
    const auto sources = surface.sources();
    std::mt19937 random(1);
    size_t mixed = 0;
    for (int i = 0; i < 200; ++i) {
        const std::vector<uint8_t> choice = random_choice(sources, random, 0.75 + 0.001 * i);
        mixed += std::any_of(choice.begin(), choice.end(),
                             [&](uint8_t one) { return one != choice[0]; });
        const Mesh mesh = geometry::closed_surface(sources, choice);
        EXPECT_TRUE(open_edges(mesh).empty()) << "choice " << i;
    }
    EXPECT_GT(mixed, 100u);
}

TEST(SurfaceLevels, AnyChoiceOfASheetIsOpenAtItsOutlineOnly) {
    const Surface surface = simplified(terrain(128), 1000);
    const auto sources = surface.sources();
    std::mt19937 random(2);
    for (int i = 0; i < 200; ++i) {
        const Mesh mesh =
            geometry::closed_surface(sources, random_choice(sources, random, 0.75 + 0.001 * i));
        EXPECT_EQ(loops_of(open_edges(mesh)), 1u) << "choice " << i;
    }
}

TEST(SurfaceLevels, BordersOfCoarseLevelsAreSubsetsOfFinerOnes) {
    const Surface surface = simplified(terrain(128), 1000);
    const auto sources = surface.sources();
    for (size_t i = 0; i + 1 < sources.size(); ++i) {
        std::map<uint32_t, glm::vec3> places;
        const auto place_of = [](const geometry::SurfaceSource& source, const BorderCorner& at) {
            return std::pair(source.level.points[at.point].source,
                             source.mesh.positions[at.vertex]);
        };
        for (const BorderCorner& corner : sources[i].level.corners)
            places.insert(place_of(sources[i], corner));
        for (const BorderCorner& corner : sources[i + 1].level.corners) {
            const auto [source, place] = place_of(sources[i + 1], corner);
            ASSERT_TRUE(places.contains(source));
            EXPECT_EQ(places.at(source), place);
        }
    }
}

TEST(SurfaceLevels, SeamsMaterialsAndNormalsGoOn) {
    Mesh mesh = terrain(128);
    const size_t half = mesh.positions.size();
    for (size_t i = 0; i < half; ++i) {
        mesh.normals.emplace_back(0, 0, 1);
        mesh.colors.emplace_back(mesh.positions[i], 1.0f);
    }
    // The second half of the triangles has texture coordinates and a material of its own.
    std::vector<uint32_t> copy(half, ~uint32_t{0});
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const bool other = mesh.positions[mesh.triangles[t].x].x > 0.4f;
        mesh.slots.push_back(other ? 1 : 0);
        for (int corner = 0; corner < 3 && other; ++corner) {
            uint32_t& vertex = mesh.triangles[t][corner];
            if (copy[vertex] == ~uint32_t{0}) {
                copy[vertex] = static_cast<uint32_t>(mesh.positions.size());
                mesh.positions.push_back(glm::vec3(mesh.positions[vertex]));
                mesh.normals.push_back(glm::vec3(mesh.normals[vertex]));
                mesh.colors.push_back(glm::vec4(mesh.colors[vertex]));
                mesh.uvs.push_back(mesh.uvs[vertex] + 5.0f);
            }
            vertex = copy[vertex];
        }
    }
    const Surface surface = simplified(mesh, 1000);
    const auto sources = surface.sources();
    std::mt19937 random(3);
    for (int i = 0; i < 50; ++i) {
        const Mesh made =
            geometry::closed_surface(sources, random_choice(sources, random, 0.8 + 0.002 * i));
        check(made);
        EXPECT_EQ(loops_of(open_edges(made)), 1u) << "choice " << i;
        ASSERT_EQ(made.slots.size(), made.triangles.size());
        for (size_t t = 0; t < made.triangles.size(); ++t) {
            for (int corner = 0; corner < 3; ++corner)
                // No triangle reaches from one map into the other.
                EXPECT_EQ(made.uvs[made.triangles[t][corner]].x > 3, made.slots[t] == 1);
        }
    }
}

TEST(SurfaceLevels, AnyNumberOfThreadsGivesTheSameBits) {
    const auto hash = [] {
        const Surface surface = simplified(terrain(128), 1000);
        Hasher hasher;
        for (size_t i = 0; i < surface.levels.levels.size(); ++i)
            hasher.value(hash_of(surface.levels.levels[i])).value(surface.levels.chunks[i]->hash);
        return hasher.result();
    };
    const Hash all = hash();
    const ThreadLimit one(1);
    EXPECT_EQ(hash(), all);
}

TEST(SurfaceLevels, ChunksThatDoNotFitAreRefused) {
    const Surface surface = simplified(terrain(64), 1000);
    const Surface other = simplified(torus(64), 1000);
    const auto sources = surface.sources();
    const uint32_t chunks = sources[0].level.tree->chunks();
    std::vector<uint8_t> choice(chunks, 0);
    EXPECT_THROW(geometry::closed_surface({}, choice), Error);
    EXPECT_THROW(geometry::closed_surface(sources, std::vector<uint8_t>(chunks - 1, 0)), Error);
    EXPECT_THROW(geometry::closed_surface(sources, std::vector<uint8_t>(chunks, 99)), Error);
    choice[0] = static_cast<uint8_t>(sources.size() - 1);  // a level whose node is all chunks
    EXPECT_THROW(geometry::closed_surface(sources, choice), Error);
    const std::vector<geometry::SurfaceSource> mixed{sources[0],
                                                     {other.mesh, *other.levels.original}};
    EXPECT_THROW(geometry::closed_surface(mixed, std::vector<uint8_t>(chunks, 0)), Error);
}

}  // namespace
