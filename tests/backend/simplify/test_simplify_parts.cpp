// SPDX-License-Identifier: GPL-3.0-or-later
// Guards simplification of what has thousands of parts: which of them go, and when.
#include "simplify/simplify.h"

#include <cmath>
#include <gtest/gtest.h>

using namespace lodestone;
using simplify::simplify_chain;
using simplify::simplify_mesh;

TEST(SimplifyParts, ThousandsOfTilesGoBeforeThePlatesTheyLieOnLoseTheirShape) {
    Mesh mesh;
    const auto add = [&](const glm::dvec3& low, const glm::dvec3& size) {
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        for (const glm::vec3& corner :
             {glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(1, 1, 0), glm::vec3(0, 1, 0),
              glm::vec3(0, 0, 1), glm::vec3(1, 0, 1), glm::vec3(1, 1, 1), glm::vec3(0, 1, 1)})
            mesh.positions.emplace_back(low + glm::dvec3(corner) * size);
        for (const glm::uvec3& t :
             {glm::uvec3(3, 2, 1), glm::uvec3(3, 1, 0), glm::uvec3(4, 5, 6), glm::uvec3(4, 6, 7),
              glm::uvec3(0, 1, 5), glm::uvec3(0, 5, 4), glm::uvec3(1, 2, 6), glm::uvec3(1, 6, 5),
              glm::uvec3(2, 3, 7), glm::uvec3(2, 7, 6), glm::uvec3(3, 0, 4), glm::uvec3(3, 4, 7)})
            mesh.triangles.push_back({first + t.x, first + t.y, first + t.z});
    };
    // More than one chunk of vertices, of which one has few candidates left.
    for (const auto& [x, length] :
         {std::pair(-300, 196), std::pair(-96, 192), std::pair(104, 196)}) {
        for (const int y : {-8, 6}) {
            add({x, y, -0.4}, {length, 2, 0.405});
            for (int i = 0; i < 2 * length; ++i) {
                const int along = x + i / 2;
                const int across = y + i % 2;
                add({along + 0.006, across + 0.006, -0.02}, {0.988, 0.988, 0.04});
            }
        }
    }
    const std::vector<size_t> targets{11240, 4496, 1796, 112};
    for (const Mesh& level : simplify_chain(mesh, targets)) {
        const Box3 box = bound_of(level.positions).box;
        EXPECT_NEAR(box.low.z, -0.4, 0.005) << level.triangles.size() << " triangles";
        EXPECT_NEAR(box.high.z, 0.02, 0.035) << level.triangles.size() << " triangles";
    }
}

TEST(SimplifyParts, ThousandsOfLeavesAreCoarserBeforeTheFirstOfThemGoes) {
    Mesh mesh;
    constexpr uint32_t kSide = 5;
    constexpr uint32_t kLeaves = 2500;
    for (uint32_t leaf = 0; leaf < kLeaves; ++leaf) {
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        const double size = 0.8 + 0.2 * (leaf * 37 % kLeaves) / kLeaves;
        const glm::dvec3 at(2.0 * (leaf % 50), 2.0 * std::floor(leaf / 50.0), 0);
        for (uint32_t i = 0; i <= kSide; ++i) {
            for (uint32_t j = 0; j <= kSide; ++j) {
                const double u = static_cast<double>(i) / kSide - 0.5;
                const double v = static_cast<double>(j) / kSide - 0.5;
                const glm::dvec3 bent(u * (1 - 3 * v * v), v, 0.3 * u * u - 0.2 * v * v);
                mesh.positions.emplace_back(at + size * bent);
            }
        }
        for (uint32_t i = 0; i < kSide; ++i) {
            for (uint32_t j = 0; j < kSide; ++j) {
                const uint32_t a = first + i * (kSide + 1) + j;
                mesh.triangles.push_back({a, a + kSide + 1, a + 1});
                mesh.triangles.push_back({a + 1, a + kSide + 1, a + kSide + 2});
            }
        }
    }
    const auto area = [](const Mesh& of) {
        double sum = 0;
        for (const Triangle& t : of.triangles)
            sum += 0.5 * glm::length(glm::cross(glm::dvec3(of.positions[t.y] - of.positions[t.x]),
                                                glm::dvec3(of.positions[t.z] - of.positions[t.x])));
        return sum;
    };
    // Five triangles for each leaf: none has to go (a twelfth of them went).
    const Mesh out = simplify_mesh(mesh, mesh.triangles.size() / 10);
    EXPECT_NEAR(area(out) / area(mesh), 1, 0.03);
}

TEST(SimplifyParts, ABallThatStandsAloneStaysWhenPlatesOnTheGroundGo) {
    // 200 plates lie on a bent ground, a smaller ball hangs far above it.
    Mesh mesh;
    const auto add_grid = [&](uint32_t side, const auto& place) {
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        for (uint32_t i = 0; i <= side; ++i) {
            for (uint32_t j = 0; j <= side; ++j)
                mesh.positions.emplace_back(
                    place(static_cast<double>(i) / side, static_cast<double>(j) / side));
        }
        for (uint32_t i = 0; i < side; ++i) {
            for (uint32_t j = 0; j < side; ++j) {
                const uint32_t a = first + i * (side + 1) + j;
                mesh.triangles.push_back({a, a + side + 1, a + 1});
                mesh.triangles.push_back({a + 1, a + side + 1, a + side + 2});
            }
        }
    };
    const auto ground = [](double x, double y) { return std::sin(0.7 * x) * std::cos(0.9 * y); };
    add_grid(
        48, [&](double u, double v) { return glm::dvec3(40 * u, 40 * v, ground(40 * u, 40 * v)); });
    for (int plate = 0; plate < 200; ++plate) {
        const double x = 2 * (plate % 20) + 0.3;
        const double y = 4 * std::floor(plate / 20.0) + 0.5;
        add_grid(2, [&](double u, double v) {
            return glm::dvec3(x + 1.4 * u, y + 2.8 * v, ground(x + 1.4 * u, y + 2.8 * v) + 0.02);
        });
    }
    constexpr double kHeight = 30;
    add_grid(6, [](double u, double v) {
        const double up = 3.14159 * (u - 0.5);
        const double around = 2 * 3.14159 * v;
        return glm::dvec3(20, 20, kHeight) + 0.6 * glm::dvec3(std::cos(up) * std::cos(around),
                                                              std::cos(up) * std::sin(around),
                                                              std::sin(up));
    });
    const Mesh level = simplify_mesh(mesh, 600);
    EXPECT_NEAR(bound_of(level.positions).box.high.z, kHeight + 0.6, 0.8);
}
