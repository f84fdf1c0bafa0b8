// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the collapse engine: modes, costs, fitting to the original, threads, fuzzed meshes.
#include "base/parallel.h"
#include "base/random.h"
#include "geometry/quadric.h"
#include "scenes/fine_grids.h"
#include "scenes/small_meshes.h"
#include "simplify/collapse/adjacency.h"
#include "simplify/collapse/edge_costs.h"
#include "simplify/collapse/edge_neighbors.h"
#include "simplify/simplify.h"

#include <algorithm>
#include <bit>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

using namespace lodestone;
using simplify::simplify_chain;
using simplify::simplify_mesh;
using simplify::SimplifyMode;
using simplify::SimplifyOptions;
using namespace lodestone::shapes;

namespace {

constexpr SimplifyMode kModes[] = {SimplifyMode::Fast, SimplifyMode::Best};

SimplifyOptions in_mode(SimplifyMode mode) {
    SimplifyOptions options;
    options.mode = mode;
    return options;
}

/// A surface of rolling hills over the unit square.
double hill(double x, double y) {
    return 0.06 * std::sin(7 * x) * std::cos(5 * y);
}

Mesh hills(uint32_t cells) {
    Mesh mesh = grid(cells);
    for (glm::vec3& p : mesh.positions)
        p.z = static_cast<float>(hill(p.x, p.y));
    return mesh;
}

/// Root mean square of the height above the hills, at the middles of a fine raster's triangles.
double height_error(const Mesh& level) {
    double sum = 0;
    double area = 0;
    for (const Triangle& t : level.triangles) {
        const glm::dvec3 a(level.positions[t.x]);
        const glm::dvec3 b(level.positions[t.y]);
        const glm::dvec3 c(level.positions[t.z]);
        const double weight = glm::length(glm::cross(b - a, c - a));
        constexpr int kSteps = 6;
        for (int i = 0; i < kSteps; ++i) {
            for (int j = 0; i + j < kSteps; ++j) {
                const double u = (i + 1.0 / 3) / kSteps;
                const double v = (j + 1.0 / 3) / kSteps;
                const glm::dvec3 p = a + u * (b - a) + v * (c - a);
                const double off = p.z - hill(p.x, p.y);
                sum += weight * off * off;
                area += weight;
            }
        }
    }
    return std::sqrt(sum / area);
}

/// Where every result is finite, used, within the target and not empty.
void expect_sane(const Mesh& level, const Mesh& input, size_t target) {
    ASSERT_NO_THROW(check(level));
    EXPECT_GE(level.triangles.size(), 1u);
    EXPECT_LE(static_cast<double>(level.triangles.size()), 1.05 * static_cast<double>(target) + 8);
    EXPECT_EQ(level.uvs.empty(), input.uvs.empty());
    EXPECT_EQ(level.slots.empty(), input.slots.empty());
    for (const glm::vec3& p : level.positions)
        ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
}

}  // namespace

TEST(Collapse, ModesThatAreNoneAreRefused) {
    EXPECT_THROW(simplify_mesh(shapes::cube(), 4, in_mode(static_cast<SimplifyMode>(7))), Error);
}

TEST(Collapse, CostsOfManyEdgesAreThoseOfEach) {
    PcgRandom random(3);
    const auto number = [&] { return 2 * random.uniform() - 1; };
    const auto vector = [&] { return glm::dvec3(number(), number(), number()); };
    constexpr size_t kCount = simplify::EdgeBlock::kSize;
    simplify::EdgeBlock block{};
    std::vector<simplify::VertexAround> ends(2 * kCount);
    std::vector<geometry::CollapseOptimum> expected(kCount);
    std::vector<glm::dvec3> froms(kCount);
    for (size_t i = 0; i < kCount; ++i) {
        geometry::EdgeEnd a{vector(), {}, {}};
        geometry::EdgeEnd b{vector(), {}, {}};
        glm::dvec3 shared(0.0);
        for (int k = 0; k < 5; ++k) {
            // Nearly flat rings for half of them: where the volume decides.
            const glm::dvec3 tilt = vector() * (i % 2 == 0 ? 1.0 : 0.1);
            const glm::dvec3 facet_a = glm::dvec3(0, 0, 1) + tilt;
            const glm::dvec3 facet_b = glm::dvec3(0, 0, 1) - 0.5 * tilt;
            a.facet += facet_a;
            b.facet += facet_b;
            a.quadric.add(facet_a, 1 / glm::length(facet_a));
            b.quadric.add(facet_b, 1 / glm::length(facet_b));
            if (k == 0)
                shared += facet_a;
        }
        const int held = static_cast<int>(i % 4) - 2;  // -1 a, 1 b
        const auto around = [](const geometry::EdgeEnd& end) {
            const geometry::Quadric& q = end.quadric;
            const auto f = [](double value) { return static_cast<float>(value); };
            return simplify::VertexAround{glm::vec3(end.point),
                                          glm::vec3(end.facet),
                                          f(q.xx),
                                          f(q.xy),
                                          f(q.xz),
                                          f(q.yy),
                                          f(q.yz),
                                          f(q.zz)};
        };
        ends[2 * i] = around(a);
        ends[2 * i + 1] = around(b);
        block.in[i] = {&ends[2 * i], &ends[2 * i + 1], glm::vec3(shared),
                       held == -1 ? -1.0f : (held == 1 ? 1.0f : 0.0f)};
        froms[i] = a.point;
        if (held == -1 || held == 1)
            expected[i].cost = collapse_cost(a, b, held == -1 ? a.point : b.point);
        else
            expected[i] = optimal_collapse(a, b, shared);
    }
    edge_costs(block);
    for (size_t i = 0; i < kCount; ++i) {
        EXPECT_NEAR(block.cost[i], expected[i].cost, 2e-3 * expected[i].cost + 1e-4) << i;
        if (block.in[i].held != 0)
            continue;
        const glm::dvec3 point = froms[i] + glm::dvec3(block.x[i], block.y[i], block.z[i]);
        EXPECT_LT(glm::distance(point, expected[i].point), 2e-3) << i;
    }
    // Whatever the processor's vectors are, and how many edges: the same bits.
    for (const size_t count : {size_t{1}, size_t{5}, kCount}) {
        simplify::EdgeBlock by_4{};
        std::copy(std::begin(block.in), std::end(block.in), by_4.in);
        edge_costs_by_4(by_4, count);
        for (size_t i = 0; i < count; ++i) {
            EXPECT_EQ(std::bit_cast<uint32_t>(by_4.cost[i]),
                      std::bit_cast<uint32_t>(block.cost[i]));
            EXPECT_EQ(std::bit_cast<uint32_t>(by_4.z[i]), std::bit_cast<uint32_t>(block.z[i]));
        }
    }
}

TEST(Collapse, FansAreFoundAndPutInOrder) {
    using simplify::VertexNeighbors;
    // Around vertex 0: triangles (0, a, b), in no order.
    const auto around = [](const std::vector<std::pair<uint32_t, uint32_t>>& pairs) {
        simplify::CollapseMesh mesh;
        uint32_t turn = 0;
        for (const auto& [a, b] : pairs) {
            const Triangle turned[] = {{0, a, b}, {a, b, 0}, {b, 0, a}};
            mesh.triangles.push_back(turned[turn++ % 3]);
        }
        return mesh;
    };
    const auto fan_of = [](const simplify::CollapseMesh& mesh, std::vector<uint32_t>& ring,
                           bool& single) {
        ring.resize(mesh.triangles.size());
        std::iota(ring.begin(), ring.end(), 0u);
        VertexNeighbors neighbors;
        const VertexNeighbors::FanKind fan = neighbors.find_fan(mesh, ring, 0);
        single = fan != VertexNeighbors::FanKind::None && neighbors.order(ring);
        return fan;
    };
    std::vector<uint32_t> ring;
    bool single = false;
    EXPECT_EQ(fan_of(around({}), ring, single), VertexNeighbors::FanKind::None);
    EXPECT_EQ(fan_of(around({{1, 2}}), ring, single), VertexNeighbors::FanKind::Open);
    EXPECT_TRUE(single);
    const auto closed = around({{1, 2}, {4, 1}, {2, 3}, {3, 4}});
    EXPECT_EQ(fan_of(closed, ring, single), VertexNeighbors::FanKind::Closed);
    ASSERT_TRUE(single);
    for (size_t i = 0; i < ring.size(); ++i)
        EXPECT_EQ(simplify::ends_of(closed.triangles[ring[i]], 0).last,
                  simplify::ends_of(closed.triangles[ring[(i + 1) % ring.size()]], 0).next);
    const auto open = around({{3, 4}, {1, 2}, {2, 3}});
    EXPECT_EQ(fan_of(open, ring, single), VertexNeighbors::FanKind::Open);
    EXPECT_TRUE(single);
    EXPECT_EQ(ring, (std::vector<uint32_t>{1, 2, 0}));
    // Two closed fans, one of them next to all there are; an open and a closed one; turned over;
    // three on an edge.
    EXPECT_EQ(fan_of(around({{1, 2}, {4, 5}, {2, 3}, {5, 6}, {3, 1}, {6, 4}}), ring, single),
              VertexNeighbors::FanKind::Closed);
    EXPECT_FALSE(single);
    EXPECT_EQ(fan_of(around({{7, 8}, {1, 2}, {2, 3}, {3, 1}}), ring, single),
              VertexNeighbors::FanKind::Open);
    EXPECT_FALSE(single);
    EXPECT_EQ(fan_of(around({{1, 2}, {2, 3}, {7, 8}, {3, 1}}), ring, single),
              VertexNeighbors::FanKind::Open);
    EXPECT_FALSE(single);
    // Neighbors whose lowest bits are the same, as far as they are looked up by these.
    EXPECT_EQ(fan_of(around({{1, 2}, {2, 1 + (1u << 20)}, {1 + (1u << 20), 1}}), ring, single),
              VertexNeighbors::FanKind::Closed);
    EXPECT_TRUE(single);
    EXPECT_EQ(fan_of(around({{1, 2}, {3, 2}}), ring, single), VertexNeighbors::FanKind::None);
    EXPECT_EQ(fan_of(around({{1, 2}, {2, 3}, {2, 4}}), ring, single),
              VertexNeighbors::FanKind::None);
}

TEST(Collapse, CompactingFillsTheListsThatBuildingMakes) {
    const Mesh mesh = hills(20);
    simplify::CollapseMesh working = simplify::open_collapse_mesh(mesh, {});
    for (size_t i = 0; i < working.triangles.size(); i += i % 7 + 2)
        working.triangles[i].x = simplify::kNone;
    simplify::Adjacency filled;
    compact(working, &filled);
    simplify::Adjacency built;
    built.build(working);
    EXPECT_EQ(filled.first, built.first);
    EXPECT_EQ(filled.triangles, built.triangles);
}

TEST(Collapse, KeysSortAsCostsDo) {
    EXPECT_LT(simplify::key_of_cost(0.0f), simplify::key_of_cost(1e-30f));
    EXPECT_LT(simplify::key_of_cost(1e-30f), simplify::key_of_cost(2.0f));
    EXPECT_EQ(simplify::key_of_cost(-0.0f), simplify::key_of_cost(0.0f));
    for (const float none :
         {-1.0f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()})
        EXPECT_EQ(simplify::key_of_cost(none), simplify::kImpossible);
}

TEST(Collapse, BothModesComeNearTheSurface) {
    const Mesh mesh = hills(64);
    const size_t target = mesh.triangles.size() / 20;
    const double fast = height_error(simplify_mesh(mesh, target, in_mode(SimplifyMode::Fast)));
    const double best = height_error(simplify_mesh(mesh, target, in_mode(SimplifyMode::Best)));
    EXPECT_LT(fast, 4e-4);
    EXPECT_LT(best, 4e-4);
}

TEST(Collapse, FittingLeavesFlatFacesAndTheirEdgesExact) {
    for (const SimplifyMode mode : kModes) {
        const Mesh level = simplify_mesh(fine_cube(16), 60, in_mode(mode));
        EXPECT_NEAR(surface_area(level), 6, 1e-5);
        EXPECT_TRUE(closed(level));
        for (const glm::vec3& p : level.positions) {
            const glm::vec3 off = glm::abs(p - 0.5f);
            EXPECT_TRUE(
                std::abs(std::max({off.x, off.y, off.z}) - 0.5f) < 1e-5f ||
                std::abs(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) - 1.0f) < 1e-5f ||
                std::abs(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) - 0.5f) < 1e-5f);
        }
    }
}

TEST(Collapse, OutlineOfAnOpenDiskKeepsItsArea) {
    Mesh disk;
    disk.positions.emplace_back(0, 0, 0);
    constexpr uint32_t kAround = 96;
    constexpr uint32_t kRings = 16;
    for (uint32_t ring = 1; ring <= kRings; ++ring) {
        for (uint32_t i = 0; i < kAround; ++i) {
            const double a = 2 * 3.14159265358979 * i / kAround;
            const double r = static_cast<double>(ring) / kRings;
            disk.positions.emplace_back(r * std::cos(a), r * std::sin(a), 0);
        }
    }
    for (uint32_t i = 0; i < kAround; ++i) {
        const uint32_t j = (i + 1) % kAround;
        disk.triangles.emplace_back(0, 1 + i, 1 + j);
        for (uint32_t ring = 0; ring + 1 < kRings; ++ring) {
            const uint32_t at = 1 + ring * kAround;
            disk.triangles.emplace_back(at + i, at + kAround + i, at + kAround + j);
            disk.triangles.emplace_back(at + i, at + kAround + j, at + j);
        }
    }
    for (const SimplifyMode mode : kModes) {
        const Mesh level = simplify_mesh(disk, 14, in_mode(mode));
        EXPECT_NEAR(surface_area(level) / surface_area(disk), 1, 0.02);
    }
}

TEST(Collapse, OneThreadAndManyGiveTheSameBits) {
    const Mesh mesh = hills(130);  // several chunks
    const size_t targets[] = {12000, 900};
    for (const SimplifyMode mode : kModes) {
        std::vector<Mesh> one;
        {
            const ThreadLimit limit(1);
            one = simplify_chain(mesh, targets, in_mode(mode));
        }
        const ThreadLimit limit(4);
        const std::vector<Mesh> many = simplify_chain(mesh, targets, in_mode(mode));
        ASSERT_EQ(one.size(), many.size());
        for (size_t i = 0; i < one.size(); ++i)
            EXPECT_EQ(hash_of(one[i]), hash_of(many[i]));
    }
}

TEST(Collapse, ManySheetsThatCoincideAroundOneVertexAreAllKept) {
    constexpr uint32_t kCorners = 80;
    constexpr size_t kSheets = 3;
    Mesh mesh;
    mesh.positions.emplace_back(0, 0, 1);
    for (uint32_t i = 0; i < kCorners; ++i) {
        const double angle = 2 * 3.14159265358979 * i / kCorners;
        mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
    }
    for (size_t sheet = 0; sheet < kSheets; ++sheet) {
        for (uint32_t i = 0; i < kCorners; ++i)
            mesh.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % kCorners);
    }
    const double area = surface_area(mesh);
    const Mesh level = simplify_mesh(mesh, kSheets * kCorners / 3);
    EXPECT_LE(level.triangles.size(), kSheets * kCorners / 3);
    EXPECT_NEAR(surface_area(level), area, 0.05 * area);
}

TEST(Collapse, ScalesByPowersOfTwoAndMovesGiveTheSameTriangles) {
    const Mesh mesh = hills(40);
    const Mesh level = simplify_mesh(mesh, 300);
    for (const double scale : {0x1p-99, 0x1p99}) {
        Mesh other = mesh;
        for (glm::vec3& p : other.positions)
            p = glm::vec3(scale * glm::dvec3(p));
        EXPECT_EQ(simplify_mesh(other, 300).triangles, level.triangles) << scale;
    }
    // What floats can hold of it there is the same surface, not the same bits.
    const glm::dvec3 far(3000, -2000, 1000);
    Mesh moved = mesh;
    for (glm::vec3& p : moved.positions)
        p = glm::vec3(glm::dvec3(p) + far);
    Mesh back = simplify_mesh(moved, 300);
    EXPECT_LE(back.triangles.size(), 300u);
    for (glm::vec3& p : back.positions)
        p = glm::vec3(glm::dvec3(p) - far);
    EXPECT_LT(height_error(back), 1.5 * height_error(level) + 3e-4);
}

TEST(Collapse, CustomNormalsAndUvsStayTrueInBothModes) {
    Mesh mesh = hills(48);
    for (const glm::vec3& p : mesh.positions) {
        const double sx = 0.42 * std::cos(7.0 * p.x) * std::cos(5.0 * p.y);
        const double sy = -0.3 * std::sin(7.0 * p.x) * std::sin(5.0 * p.y);
        mesh.normals.emplace_back(glm::normalize(glm::dvec3(-sx, -sy, 1)));
        mesh.uvs.emplace_back(p.x, 1 - p.y);
    }
    for (const SimplifyMode mode : kModes) {
        const Mesh level = simplify_mesh(mesh, 400, in_mode(mode));
        ASSERT_FALSE(level.uvs.empty());
        double worst = 0;
        for (size_t i = 0; i < level.positions.size(); ++i) {
            const glm::vec3& p = level.positions[i];
            worst = std::max({worst, std::abs(static_cast<double>(level.uvs[i].x - p.x)),
                              std::abs(static_cast<double>(level.uvs[i].y - 1 + p.y))});
            EXPECT_NEAR(glm::length(level.normals[i]), 1, 1e-4);
        }
        EXPECT_LT(worst, 0.02);
    }
}

TEST(Collapse, FuzzedMeshesEndWithinTheirTargets) {
    PcgRandom random(11);
    const auto below = [&](uint32_t count) {
        return static_cast<uint32_t>(random.uniform() * count);
    };
    for (int run = 0; run < 60; ++run) {
        SCOPED_TRACE(run);
        Mesh mesh = run % 3 == 0 ? hills(10) : run % 3 == 1 ? shapes::sphere(1, 2) : boxes(20);
        mesh.normals.clear();
        mesh.uvs.clear();
        mesh.colors.clear();
        mesh.slots.clear();
        const auto vertices = static_cast<uint32_t>(mesh.positions.size());
        const auto any = [&] { return below(static_cast<uint32_t>(mesh.triangles.size())); };
        for (int damage = 0; damage < 12; ++damage) {
            switch (below(6)) {
                case 0:  // random corners
                    mesh.triangles[any()][static_cast<int>(below(3))] = below(vertices);
                    break;
                case 1:
                    mesh.triangles.push_back(Triangle(mesh.triangles[any()]));
                    break;
                case 2: {
                    const Triangle t = mesh.triangles[any()];
                    mesh.triangles.emplace_back(t.z, t.y, t.x);
                    break;
                }
                case 3:
                    mesh.positions[below(vertices)].y = std::numeric_limits<float>::quiet_NaN();
                    break;
                case 4:
                    mesh.positions[below(vertices)] = mesh.positions[below(vertices)];
                    break;
                default:
                    mesh.positions[below(vertices)] *= run % 2 == 0 ? 1e30f : 1e-30f;
            }
        }
        const size_t count = mesh.triangles.size();
        const Mesh level = simplify_mesh(mesh, count / 4, in_mode(kModes[run % 2]));
        expect_sane(level, mesh, count / 4);
    }
}

TEST(Collapse, HourglassAndManySmallPartsReachTheirTargets) {
    Mesh hourglass = shapes::sphere(1, 3);
    hourglass.normals.clear();
    Mesh upper = hourglass;
    for (glm::vec3& p : upper.positions)
        p.z += 2;  // they touch in one point
    append(hourglass, upper, Affine{});
    for (const SimplifyMode mode : kModes) {
        expect_sane(simplify_mesh(hourglass, 200, in_mode(mode)), hourglass, 200);
        const Mesh many = boxes(600);
        expect_sane(simplify_mesh(many, 90, in_mode(mode)), many, 90);
    }
}
