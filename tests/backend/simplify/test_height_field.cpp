// SPDX-License-Identifier: GPL-3.0-or-later
// Guards height fields on a regular grid: which meshes are some, and that sub-sampling fits them.
#include "scenes/small_meshes.h"
#include "simplify/height_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>

using namespace lodestone;
using simplify::find_grid;
using simplify::HeightGrid;
using simplify::subsample;
using namespace lodestone::shapes;

namespace {

template <typename Height>
Mesh field(uint32_t wide, uint32_t high, const Height& height) {
    Mesh mesh;
    for (uint32_t j = 0; j <= high; ++j) {
        for (uint32_t i = 0; i <= wide; ++i)
            mesh.positions.emplace_back(0.5f * static_cast<float>(i), 0.25f * static_cast<float>(j),
                                        static_cast<float>(height(i, j)));
    }
    for (uint32_t j = 0; j < high; ++j) {
        for (uint32_t i = 0; i < wide; ++i) {
            const uint32_t at = j * (wide + 1) + i;
            mesh.triangles.emplace_back(at, at + 1, at + wide + 2);
            mesh.triangles.emplace_back(at, at + wide + 2, at + wide + 1);
        }
    }
    return mesh;
}

Mesh shuffled(const Mesh& mesh) {
    Mesh out = mesh;
    std::vector<uint32_t> to(mesh.positions.size());
    for (uint32_t v = 0; v < to.size(); ++v)
        to[v] = static_cast<uint32_t>((uint64_t{v} * 7919 + 13) % to.size());  // 7919 is prime
    for (uint32_t v = 0; v < to.size(); ++v)
        out.positions[to[v]] = mesh.positions[v];
    for (Triangle& t : out.triangles)
        t = Triangle(to[t.x], to[t.y], to[t.z]);
    std::reverse(out.triangles.begin(), out.triangles.end());
    return out;
}

Mesh subsampled(const Mesh& mesh, size_t triangles) {
    const auto grid = find_grid(mesh);
    EXPECT_TRUE(grid.has_value());
    return grid ? subsample(mesh, *grid, triangles) : Mesh{};
}

}  // namespace

TEST(Grid, NothingAndSolidsAreNone) {
    EXPECT_FALSE(find_grid(Mesh{}));
    EXPECT_FALSE(find_grid(cube()));
    EXPECT_FALSE(find_grid(sphere(1, 3)));
    EXPECT_FALSE(find_grid(fan()));
}

TEST(Grid, AQuadIsTheSmallest) {
    const auto grid = find_grid(quad(3, 2));
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->columns * grid->rows, 4u);
}

TEST(Grid, ATerrainIsFoundWhateverItsOrderAndAxis) {
    const Mesh mesh = shuffled(field(30, 17, [](uint32_t i, uint32_t j) { return i * 0.1 * j; }));
    for (int turn = 0; turn < 3; ++turn) {
        Mesh turned = mesh;
        for (glm::vec3& p : turned.positions)
            p = glm::vec3(p[(3 - turn) % 3], p[(4 - turn) % 3], p[(5 - turn) % 3]);
        const auto grid = find_grid(turned);
        ASSERT_TRUE(grid) << turn;
        EXPECT_EQ(grid->columns, 31u);
        EXPECT_EQ(grid->rows, 18u);
        EXPECT_FALSE(grid->turned);
    }
}

TEST(Grid, WhatIsAlmostAGridIsNone) {
    const Mesh good = terrain(12);
    ASSERT_TRUE(find_grid(good));
    Mesh moved = good;
    moved.positions[40].x += 0.01f;
    EXPECT_FALSE(find_grid(moved));
    Mesh folded = good;
    std::swap(folded.triangles[9].x, folded.triangles[9].y);
    EXPECT_FALSE(find_grid(folded));
    Mesh twice = good;
    twice.triangles[3] = twice.triangles[2];
    EXPECT_FALSE(find_grid(twice));
    Mesh holed = good;
    holed.triangles.resize(holed.triangles.size() - 2);
    EXPECT_FALSE(find_grid(holed));
    Mesh painted = good;
    painted.slots.assign(painted.triangles.size(), 0);
    painted.slots[5] = 1;
    EXPECT_FALSE(find_grid(painted));
    Mesh lost = good;
    lost.positions[3].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(find_grid(lost));
}

TEST(Grid, EveryTargetIsKept) {
    const Mesh mesh = terrain(64);
    for (const size_t target : {8000u, 4000u, 1000u, 333u, 50u, 9u, 2u}) {
        const Mesh level = subsampled(mesh, target);
        EXPECT_NO_THROW(check(level));
        EXPECT_LE(level.triangles.size(), target);
        EXPECT_GE(level.triangles.size() * 3, target);
    }
    EXPECT_EQ(hash_of(subsampled(mesh, 8192)), hash_of(mesh));
}

TEST(Grid, APlaneStaysThatPlane) {
    Mesh mesh = field(37, 23, [](uint32_t i, uint32_t j) { return 0.3 * i - 0.7 * j + 2; });
    for (const glm::vec3& p : mesh.positions) {
        mesh.uvs.emplace_back(p.x / 18.5f, p.y / 5.75f);
        mesh.normals.emplace_back(0, 0, 1);
        mesh.colors.emplace_back(p.x / 20, 0.5f, 0.5f, 1);
    }
    const Mesh level = subsampled(mesh, 180);
    for (size_t v = 0; v < level.positions.size(); ++v) {
        const glm::vec3& p = level.positions[v];
        EXPECT_NEAR(p.z, 0.6f * p.x - 2.8f * p.y + 2, 1e-4);
        EXPECT_NEAR(level.uvs[v].x, p.x / 18.5f, 1e-5);
        EXPECT_NEAR(level.uvs[v].y, p.y / 5.75f, 1e-5);
        EXPECT_NEAR(level.colors[v].x, p.x / 20, 1e-5);
        EXPECT_NEAR(glm::dot(level.normals[v], glm::normalize(glm::vec3(-0.6f, 2.8f, 1))), 1, 1e-4);
    }
}

TEST(Grid, FacesKeepTheirSideAndBordersAndCornersStay) {
    Mesh mesh = terrain(40);
    for (Triangle& t : mesh.triangles)
        std::swap(t.y, t.z);
    const Mesh level = subsampled(mesh, 300);
    for (size_t i = 0; i < level.triangles.size(); ++i)
        EXPECT_LT(area_vector(level, i).z, 0);
    for (const uint32_t corner : {0u, 40u, 40u * 41, 41u * 41 - 1}) {
        const auto same = [&](const glm::vec3& p) {
            return glm::distance(p, mesh.positions[corner]) < 1e-5f;
        };
        EXPECT_TRUE(std::any_of(level.positions.begin(), level.positions.end(), same)) << corner;
    }
}

TEST(Grid, NeighborsGoOnFitting) {
    const auto land = [](double x, double y) { return std::sin(0.7 * x) * std::cos(0.4 * y); };
    const Mesh left = field(32, 32, [&](uint32_t i, uint32_t j) { return land(i, j); });
    Mesh right = field(32, 32, [&](uint32_t i, uint32_t j) { return land(i + 32.0, j); });
    const Mesh a = subsampled(left, 200);
    const Mesh b = subsampled(right, 200);
    size_t compared = 0;
    for (const glm::vec3& p : a.positions) {
        for (const glm::vec3& q : b.positions) {
            if (p.x > 15.999f && q.x < 0.001f && std::abs(p.y - q.y) < 1e-4f) {
                EXPECT_FLOAT_EQ(p.z, q.z);
                ++compared;
            }
        }
    }
    EXPECT_EQ(compared, 11u);
}

TEST(Grid, DetailBelowTheSamplesDoesNotAlias) {
    // Every fourth vertex alone would see nothing but crests.
    const Mesh mesh = field(128, 128, [](uint32_t i, uint32_t) { return i % 4 == 0 ? 1.0 : 0.0; });
    const Mesh level = subsampled(mesh, 2048);
    double sum = 0;
    size_t count = 0;
    for (const glm::vec3& p : level.positions) {
        if (p.x > 4 && p.x < 60) {
            sum += p.z;
            ++count;
        }
    }
    EXPECT_NEAR(sum / static_cast<double>(count), 0.25, 0.02);
}

TEST(Grid, HeightsFitBetterThanEverySecondOnes) {
    const auto height = [](double i, double j) { return std::sin(0.9 * i) * std::cos(0.8 * j); };
    const Mesh mesh = field(48, 48, height);
    const Mesh level = subsampled(mesh, 1152);
    ASSERT_EQ(level.positions.size(), 25u * 25);
    double ours = 0;
    double every = 0;
    const auto off = [&](const auto& coarse, uint32_t i,
                         uint32_t j) {  // bilinear, on edges' middles
        const uint32_t a = i / 2;
        const uint32_t b = j / 2;
        const uint32_t c = std::min(24u, a + i % 2);
        const uint32_t d = std::min(24u, b + j % 2);
        const double z = 0.25 * (coarse(a, b) + coarse(c, b) + coarse(a, d) + coarse(c, d));
        return (z - height(i, j)) * (z - height(i, j));
    };
    const auto at = [&](uint32_t x, uint32_t y) {
        for (const glm::vec3& p : level.positions) {
            if (std::abs(p.x - static_cast<float>(x)) < 0.1f &&
                std::abs(p.y - 0.5f * static_cast<float>(y)) < 0.1f)
                return double{p.z};
        }
        return 1e9;
    };
    for (uint32_t j = 2; j < 46; ++j) {
        for (uint32_t i = 2; i < 46; ++i) {
            ours += off(at, i, j);
            every += off([&](uint32_t x, uint32_t y) { return height(2.0 * x, 2.0 * y); }, i, j);
        }
    }
    EXPECT_LT(ours, 0.7 * every);
}
