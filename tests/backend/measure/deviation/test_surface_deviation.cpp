// SPDX-License-Identifier: GPL-3.0-or-later
// Guards SurfaceDeviation, the number every choice of detail rests on: known distances, both directions,
// and that nothing invisible of the finest counts.
#include "base/parallel.h"
#include "base/random.h"
#include "measure/deviation/point_tree.h"
#include "measure/deviation/surface_deviation.h"
#include "scenes/fine_grids.h"
#include "scenes/leaf_cards.h"
#include "scenes/small_meshes.h"

#include <gtest/gtest.h>

using namespace lodestone;
using measure::DeviationOptions;
using measure::DeviationReference;
using measure::SurfaceDeviation;

namespace {

Mesh moved(const Mesh& mesh, const Affine& transform) {
    Mesh out;
    append(out, mesh, transform);
    return out;
}

Mesh shifted(const Mesh& mesh, const glm::dvec3& offset) {
    return moved(mesh, {glm::dmat3(1.0), offset});
}

SurfaceDeviation deviation(const Mesh& finest, const Mesh& stand_in) {
    return DeviationReference(finest, {}).of(stand_in);
}

}  // namespace

TEST(SurfaceDeviation, EmptyMeshesAreTheOthersDiameterApart) {
    EXPECT_EQ(deviation(Mesh{}, Mesh{}).error, 0);
    const double diameter = std::sqrt(3.0);
    EXPECT_NEAR(deviation(shapes::cube(), Mesh{}).error, diameter, 1e-6);
    EXPECT_NEAR(deviation(shapes::cube(), Mesh{}).max, diameter, 1e-6);
    EXPECT_NEAR(deviation(Mesh{}, shapes::cube()).error, diameter, 1e-6);
}

TEST(SurfaceDeviation, OfAMeshFromItselfIsNothing) {
    for (const Mesh& mesh : {shapes::cube(), shapes::sphere(3, 4), shapes::terrain(40),
                             shapes::book(20), shapes::fan()}) {
        const SurfaceDeviation out = deviation(mesh, mesh);
        EXPECT_LT(out.max, 1e-6 * bound_of(mesh.positions).radius);
    }
}

TEST(SurfaceDeviation, BoxesOnAWideGroundWereMissedRoughlyForEverySecondCornerIsBelow) {
    Mesh finest = shapes::quad(30, 30);
    const Mesh ground = finest;
    for (int i = 0; i < 4; ++i) {
        Mesh box;
        for (const double x : {0.0, 0.8}) {
            for (const double y : {0.0, 0.8}) {
                for (const double z : {0.0, 0.8})  // bottom, top, as many programs list them
                    box.positions.emplace_back(8 + 3 * i + x, 8 + y, z);
            }
        }
        box.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                         {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
        append(finest, box, {});
    }
    constexpr double kAny = std::numeric_limits<double>::infinity();
    for (uint64_t seed = 1; seed <= 32; ++seed) {
        const DeviationReference reference(finest, {512, 2048, seed});
        EXPECT_NEAR(reference.roughly(ground, {}, {}, kAny, {}).max, 0.8, 1e-6) << seed;
    }
}

TEST(SurfaceDeviation, OfParallelQuadsIsTheirDistance) {
    const Mesh quad = shapes::quad(1, 2);
    for (const double d : {1e-4, 0.25, 3.0}) {
        const SurfaceDeviation out = deviation(quad, shifted(quad, {0, 0, d}));
        EXPECT_NEAR(out.error, d, 1e-6);
        EXPECT_NEAR(out.max, d, 1e-6);
    }
}

TEST(SurfaceDeviation, OfConcentricSpheresIsTheDifferenceOfTheirRadii) {
    const SurfaceDeviation grown = deviation(shapes::sphere(1, 5), shapes::sphere(1.1, 5));
    EXPECT_NEAR(grown.error, 0.1, 1e-3);
    const SurfaceDeviation shrunk = deviation(shapes::sphere(1.1, 5), shapes::sphere(1, 5));
    EXPECT_NEAR(shrunk.error, 0.1, 1e-3);
}

TEST(SurfaceDeviation, OfATranslationIsAtMostItsLengthAndNearlySo) {
    const Mesh sphere = shapes::sphere(1, 5);
    const SurfaceDeviation out = deviation(sphere, shifted(sphere, {0, 0, 0.05}));
    EXPECT_LE(out.max, 0.0501);
    EXPECT_NEAR(out.error, 0.05, 1e-3);
    const Mesh box = shapes::box({0, 0, 0}, {1, 2, 3});
    EXPECT_NEAR(deviation(box, shifted(box, {0.01, 0, 0})).error, 0.01, 1e-6);
}

TEST(SurfaceDeviation, CountsBothDirections) {
    // Missing a part is seen from the finest, adding one from the stand-in.
    const Mesh one = shapes::cube();
    Mesh two = one;
    append(two, shapes::cube(), {glm::dmat3(1.0), {5, 0, 0}});
    EXPECT_NEAR(deviation(two, one).error, 5, 0.05);
    EXPECT_NEAR(deviation(one, two).error, 5, 0.05);
}

TEST(SurfaceDeviation, IgnoresWhatNobodySeesOfTheFinest) {
    const Mesh outer = shapes::box(glm::dvec3(-1), glm::dvec3(1));
    Mesh full = outer;
    append(full, shapes::sphere(0.3, 3), Affine{});
    append(full, shapes::quad(0.5f, 0.5f), Affine{});
    EXPECT_LT(deviation(full, outer).max, 1e-6);
    // A stand-in that keeps the interior is right too: it is compared with all of the finest.
    EXPECT_LT(deviation(full, full).max, 1e-6);
    // Interior that the finest does not have counts: it may shine through elsewhere.
    EXPECT_NEAR(deviation(outer, full).max, 1, 0.05);
}

TEST(SurfaceDeviation, SeesASpikeButNotOneThousandthOfTheWeight) {
    // A flat grid with one vertex pulled up: its six triangles are 6 / (2 n n) of the area.
    const auto spiked = [](uint32_t n) {
        Mesh mesh = shapes::terrain(n);
        for (glm::vec3& position : mesh.positions)
            position.z = 0;
        mesh.positions[(n / 2) * (n + 1) + n / 2].z = 0.01f;
        return mesh;
    };
    const Mesh flat = shapes::quad(1, 1);
    // Of a direction's weight that vertex is 1 / (2 n n): 1/200 and 1/3200.
    EXPECT_NEAR(deviation(flat, spiked(10)).error, 0.01, 1e-6);
    EXPECT_LT(deviation(flat, spiked(40)).error, 0.007);
    EXPECT_NEAR(deviation(flat, spiked(40)).max, 0.01, 1e-6);
    EXPECT_NEAR(deviation(spiked(10), flat).error, 0.01, 1e-6);
}

TEST(SurfaceDeviation, IsExactAsLongAsItIsOfUseAndElseToldToBeMore) {
    const Mesh finest = shapes::sphere(1, 5);
    const Mesh coarse = shapes::sphere(1, 2);
    const DeviationReference reference(finest, {2048, 2048, 1});
    const double error = reference.of(coarse).error;
    for (const double useless : {1e9, 2 * error, 1.001 * error})
        EXPECT_EQ(reference.of(coarse, {}, {}, useless).error, error) << useless;
    for (const double useless : {0.99 * error, 0.9 * error, 0.5 * error})
        EXPECT_GT(reference.of(coarse, {}, {}, useless).error, useless) << useless;
    EXPECT_EQ(reference.of(coarse, {}, {}, 0.1 * error).error,
              std::numeric_limits<double>::infinity());
    EXPECT_EQ(reference.of(coarse, {}, {}, 0).error, std::numeric_limits<double>::infinity());
}

TEST(SurfaceDeviation, WhatSticksOutOfAStandInIsFoundWhereTheOriginalIsNearAllOfIt) {
    const Mesh finest = shapes::sphere(1, 4);
    Mesh spoiled = finest;
    append(spoiled, shapes::sphere(0.5, 3), {glm::dmat3(1.0), {3, 0, 0}});
    const DeviationReference reference(finest, {2048, 2048, 1});
    // From the original to it nothing is far, so that way tells nothing against a useless error.
    for (const double useless : {0.01, 0.1, 2.0})
        EXPECT_GT(reference.of(spoiled, {}, {}, useless).error, useless) << useless;
    EXPECT_NEAR(reference.of(spoiled, {}, {}, 10).error, 2.5, 0.05);
}

TEST(SurfaceDeviation, FindsTheNearestWantedPointLikeLookingAtAll) {
    PcgRandom random(7);
    const auto point = [&] {
        return glm::dvec3(random.uniform(), random.uniform(), 0.1 * random.uniform());
    };
    for (const size_t count : {size_t{1}, size_t{8}, size_t{9}, size_t{300}}) {
        std::vector<glm::dvec3> points;
        std::vector<uint32_t> numbers;
        for (uint32_t i = 0; i < count; ++i) {
            points.push_back(i % 5 == 4 ? points[i / 2] : point());  // some in one place
            numbers.push_back(i);
        }
        const measure::PointTree tree(points, numbers);
        for (int i = 0; i < 50; ++i) {
            const glm::dvec3 from = 2.0 * point() - 0.5;
            const double most = i % 2 == 0 ? 100 : 0.05;
            double square = most;
            for (size_t k = 0; k < count; k += 3) {
                const glm::dvec3 arm = points[k] - from;
                square = std::min(square, glm::dot(arm, arm));
            }
            EXPECT_EQ(tree.nearest(from, most, [](uint32_t k) { return k % 3 == 0; }), square);
        }
    }
    EXPECT_EQ(measure::PointTree().nearest({}, 4, [](uint32_t) { return true; }), 4);
}

TEST(SurfaceDeviation, SubsampledVerticesGiveTheSameError) {
    const Mesh finest = shapes::sphere(1, 5);
    const Mesh coarse = shapes::sphere(1, 2);
    DeviationOptions few;
    few.samples = 2048;
    few.most_vertices = 512;
    const double all = deviation(finest, coarse).error;
    EXPECT_GT(all, 0.01);
    EXPECT_NEAR(DeviationReference(finest, few).of(coarse).error / all, 1, 0.1);
    few.samples = 0;
    few.most_vertices = 0;
    EXPECT_EQ(DeviationReference(finest, few).of(coarse).error, 0);
}

TEST(SurfaceDeviation, OfAFineStandInIsTheSameForAllSeedsWhereAFewVerticesDecide) {
    constexpr int kSide = 80;
    const auto at = [](int x, int y) { return static_cast<uint32_t>(y * kSide + x); };
    PcgRandom random(3);
    Mesh rough;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            rough.positions.emplace_back(x, y, std::sqrt(-std::log(1 - random.uniform())));
    for (int y = 0; y + 1 < kSide; ++y) {
        for (int x = 0; x + 1 < kSide; ++x) {
            rough.triangles.emplace_back(at(x, y), at(x + 1, y), at(x + 1, y + 1));
            rough.triangles.emplace_back(at(x, y), at(x + 1, y + 1), at(x, y + 1));
        }
    }
    Mesh flat = rough;
    for (glm::vec3& position : flat.positions)
        position.z = 0;
    std::vector<double> errors;
    for (uint64_t seed = 1; seed <= 5; ++seed)
        errors.push_back(DeviationReference(flat, {2048, 2048, seed}).of(rough).error);
    const auto [least, most] = std::minmax_element(errors.begin(), errors.end());
    EXPECT_GT(*least, 1);
    EXPECT_LT(*most, 1.02 * *least);
}

TEST(SurfaceDeviation, MovesWithTheMeshesAndGrowsWithTheirSize) {
    const Mesh finest = shapes::sphere(1, 4);
    const Mesh coarse = shapes::sphere(1, 2);
    const double reference = deviation(finest, coarse).error;
    for (const double s : {1e-6, 1e6}) {
        const Affine scaled{glm::dmat3(s), {}};
        EXPECT_NEAR(deviation(moved(finest, scaled), moved(coarse, scaled)).error / (s * reference),
                    1, 0.02)
            << s;
    }
    // A thousand kilometres away single precision is 6 cm; boxes with exact corners keep theirs.
    const glm::dvec3 far(0x1p20);
    const Mesh box = shapes::box(far, far + 1.0);
    const Mesh larger = shapes::box(far - 0.25, far + 1.25);
    EXPECT_NEAR(deviation(box, larger).error, std::sqrt(3.0) / 4, 0.02);
    EXPECT_LT(deviation(box, box).max, 1e-6);
}

TEST(SurfaceDeviation, ZeroAreaTrianglesNeitherCountNorCrash) {
    Mesh finest = shapes::cube();
    Mesh dirty = finest;
    dirty.normals.clear();
    dirty.positions.emplace_back(0.0f, 0.0f, 7.0f);
    const auto last = static_cast<uint32_t>(dirty.positions.size() - 1);
    dirty.triangles.emplace_back(last, last, last);
    dirty.triangles.emplace_back(0, 0, last);
    EXPECT_LT(deviation(finest, dirty).max, 1e-6);
    EXPECT_LT(deviation(dirty, finest).max, 1e-6);
    Mesh line;
    line.positions = {{0, 0, 0}, {1, 0, 0}};
    line.triangles = {{0, 1, 1}};
    EXPECT_NO_THROW(deviation(finest, line));
    EXPECT_EQ(deviation(line, line).max, 0);
}

TEST(SurfaceDeviation, SameBitsOnOneAndManyThreads) {
    const Mesh finest = shapes::terrain(60);
    const Mesh coarse = shapes::terrain(13);
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        const DeviationReference reference(finest, {});
        const SurfaceDeviation out = reference.of(coarse);
        return std::tuple(out.error, out.max, reference.visible_points());
    };
    const auto once = run(1);
    EXPECT_EQ(once, run(0));
    EXPECT_EQ(once, run(2));
    EXPECT_GT(std::get<0>(once), 0);
}

namespace {

Material colored(double r, double g, double b) {
    Material material;
    material.base_color = {r, g, b};
    return material;
}

/// 20 x 20 m of grass (slot 0) with a road (slot 1) of 2 x 20 m, 2 cm above its middle.
Mesh field_with_road() {
    Mesh mesh = shapes::quad(20, 20);
    Affine above;
    above.offset = {9, 0, 0.02};
    append(mesh, shapes::quad(2, 20), above, 1);
    return mesh;
}

SurfaceDeviation of_looks(const Mesh& finest, const std::vector<Material>& materials,
                          const Mesh& stand_in, const std::vector<Material>& own) {
    measure::LookPalette palette;
    const std::vector<uint16_t> looks = palette.of(finest, materials);
    const DeviationReference reference(finest, {}, {looks, &palette, nullptr});
    const std::vector<uint16_t> theirs = palette.of(stand_in, own);
    return reference.of(stand_in, {theirs, &palette, nullptr});
}

}  // namespace

TEST(DeviationLooks, RoadThatIsGoneIsAsWrongAsHalfItsWidth) {
    const std::vector<Material> materials{colored(0.1, 0.5, 0.1), colored(0.1, 0.1, 0.1)};
    const Mesh finest = field_with_road();
    const SurfaceDeviation gone = of_looks(finest, materials, shapes::quad(20, 20), materials);
    EXPECT_NEAR(gone.error, 1, 0.25);
    EXPECT_LT(of_looks(finest, materials, finest, materials).error, 1e-5);
}

TEST(DeviationLooks, RoadThatMovedIsWrongByAsMuch) {
    const std::vector<Material> materials{colored(0.1, 0.5, 0.1), colored(0.1, 0.1, 0.1)};
    Mesh moved = field_with_road();
    for (glm::vec3& position : moved.positions) {
        if (position.z > 0)
            position.x += 0.3f;
    }
    EXPECT_NEAR(of_looks(field_with_road(), materials, moved, materials).error, 0.3, 0.06);
}

TEST(DeviationLooks, BoardsAreRepaintedLikeTheTilesThatLayOnThem) {
    Mesh roof = shapes::quad(4, 4);  // boards, slot 0
    for (int i = 0; i < 16; ++i) {
        Affine place;
        place.offset = {i % 4, i / 4, 0.05};
        append(roof, shapes::box({0, 0, 0}, {1, 1, 0.02}), place, 1);
    }
    const DeviationReference reference(roof, {});
    Mesh boards = shapes::quad(4, 4);
    boards.slots = {0, 0};
    reference.repaint(boards);
    EXPECT_EQ(boards.slots, (std::vector<uint16_t>{1, 1}));
    Mesh same = roof;
    reference.repaint(same);
    EXPECT_EQ(same.slots, roof.slots);
}

TEST(DeviationLooks, OfARepaintedLevelIsTheSameWithWhatRepaintingFound) {
    const std::vector<Material> materials{colored(0.1, 0.5, 0.1), colored(0.1, 0.1, 0.1)};
    const Mesh finest = field_with_road();
    measure::LookPalette palette;
    const std::vector<uint16_t> looks = palette.of(finest, materials);
    const DeviationReference reference(finest, {2048, 2048, 1}, {looks, &palette, nullptr});
    Mesh level = shapes::quad(20, 20);
    append(level, shapes::quad(3, 20), Affine{}, 1);  // another road, at the edge
    Mesh second = level;
    const DeviationReference::RepaintResult known = reference.repaint(level);
    ASSERT_EQ(known.nearest.size(), reference.visible_points());
    const std::vector<uint16_t> theirs = palette.of(level, materials);
    const measure::SurfaceLooks surface{theirs, &palette, nullptr};
    const double never = std::numeric_limits<double>::infinity();
    const SurfaceDeviation told = reference.of(level, surface, known, never, {});
    EXPECT_NEAR(told.error, reference.of(level, surface).error, 1e-9);
    EXPECT_GT(told.error, 0.5);
    const SurfaceDeviation rough = reference.roughly(level, surface, known, never, {});
    EXPECT_NEAR(rough.error, told.error, 0.2 * told.error);
    EXPECT_GE(rough.max, rough.error);
    // What is no use is left as it is, and nothing else.
    for (const double useless : {0.001, 1000.0}) {
        for (const bool half : {false, true}) {
            Mesh again = second;
            again.positions[0].z += 5;
            const std::vector<uint16_t> before = again.slots;
            const bool none = reference.repaint(again, nullptr, {}, half, useless).surely_useless;
            EXPECT_EQ(none, useless < 1);
            EXPECT_EQ(none, again.slots == before);
        }
    }
}

TEST(SurfaceDeviation, WhatIsHiddenIsToldByTriangleAndNotComparedAt) {
    Mesh nested = shapes::sphere(1, 3);
    const size_t outer = nested.triangles.size();
    append(nested, shapes::sphere(0.5, 3), Affine{});
    const DeviationReference reference(nested, {2048, 2048, 1, 16});
    ASSERT_EQ(reference.seen_triangles().size(), nested.triangles.size());
    for (size_t i = 0; i < nested.triangles.size(); ++i)
        EXPECT_EQ(reference.seen_triangles()[i] != 0, i < outer) << i;
    EXPECT_EQ(reference.visible_points(),
              DeviationReference(nested, {2048, 2048, 1}).visible_points());
    EXPECT_TRUE(DeviationReference(nested, {}).seen_triangles().empty());
}

TEST(SurfaceDeviation, NoVertexOfHiddenTrianglesAloneIsVisible) {
    const Mesh sphere = shapes::sphere(1, 2);
    const ray::MeshScene scene(sphere);
    const measure::OutsideSides sides = measure::sides_of(sphere, scene);
    const auto visible = [&](const std::vector<uint8_t>& seen) {
        std::vector<measure::SurfaceSample> out;
        measure::add_visible_vertices(sphere, scene, sides, seen,
                                      measure::weighted_vertices(sphere, 1000, 1), 1e-6, 1, {},
                                      out);
        return out.size();
    };
    std::vector<uint8_t> seen(sphere.triangles.size(), 0);
    EXPECT_EQ(visible(seen), 0u);
    seen[7] = 1;
    EXPECT_EQ(visible(seen), 3u);
    EXPECT_EQ(visible({}), sphere.positions.size());
}

TEST(SurfaceDeviation, RoughlyIsNearTheSame) {
    const Mesh finest = shapes::sphere(1, 4);
    const DeviationReference reference(finest, {2048, 2048, 1});
    const double never = std::numeric_limits<double>::infinity();
    for (const int subdivisions : {0, 1, 2, 3}) {
        const Mesh level = shapes::sphere(1, subdivisions);
        const double error = reference.of(level).error;
        EXPECT_NEAR(reference.roughly(level, {}, {}, never, {}).error, error, 0.04 * error);
    }
    EXPECT_EQ(reference.roughly(Mesh{}, {}, {}, never, {}).error, reference.of(Mesh{}).error);
}

TEST(DeviationLooks, ColorsThatNobodyCanTellApartDoNotCount) {
    const std::vector<Material> alike{colored(0.1, 0.5, 0.1), colored(0.11, 0.5, 0.1)};
    EXPECT_NEAR(of_looks(field_with_road(), alike, shapes::quad(20, 20), alike).error, 0.02, 1e-3);
}

TEST(DeviationLooks, MeanColorIsRightFromWhereTheColorsMix) {
    // A chessboard of 1 m fields, and the same board in the mean color.
    const std::vector<Material> materials{colored(0, 0, 0), colored(1, 1, 1)};
    Mesh board;
    for (int i = 0; i < 16; ++i) {
        for (int j = 0; j < 16; ++j) {
            Affine place;
            place.offset = {i, j, 0};
            append(board, shapes::quad(1, 1), place, static_cast<uint16_t>((i + j) % 2));
        }
    }
    const std::vector<Material> gray{colored(0.5, 0.5, 0.5)};  // of the light
    const double error = of_looks(board, materials, shapes::quad(16, 16), gray).error;
    EXPECT_GT(error, 0.4);
    EXPECT_LT(error, 5);
}

TEST(SurfaceDeviation, CancelledJobsStop) {
    const int32_t cancel = 1;
    const Job job(&cancel, nullptr, nullptr);
    EXPECT_THROW(DeviationReference(shapes::cube(), {}, {}, job), Error);
    const DeviationReference reference(shapes::cube(), {});
    EXPECT_THROW((void)reference.of(shapes::cube(), {}, job), Error);
}

TEST(DeviationLooks, WhatMixesToAColorIsTheSameForTheFirstStandInAndForLaterOnes) {
    const std::vector<Material> materials{colored(0.1, 0.5, 0.1), colored(0.6, 0.1, 0.1)};
    Mesh finest = shapes::terrain(40);
    for (size_t i = 0; i < finest.triangles.size(); ++i)
        finest.slots.push_back(static_cast<uint16_t>(i / 97 % 2));
    const Mesh coarse = shapes::terrain(5);
    const std::vector<Material> brown{colored(0.35, 0.3, 0.1)};
    const std::vector<Material> dull{colored(0.3, 0.25, 0.1)};
    measure::LookPalette palette;
    const std::vector<uint16_t> looks = palette.of(finest, materials);
    const auto reference = [&] {
        return std::make_unique<DeviationReference>(
            finest, measure::DeviationOptions{}, measure::SurfaceLooks{looks, &palette, nullptr});
    };
    const auto error = [&](const DeviationReference& of, const std::vector<Material>& own) {
        const std::vector<uint16_t> theirs = palette.of(coarse, own);
        return of.of(coarse, {theirs, &palette, nullptr}).error;
    };
    const auto one = reference();
    const double first = error(*one, brown);
    EXPECT_GT(first, deviation(finest, coarse).error) << "colors decide";
    EXPECT_EQ(error(*one, brown), first);
    const double other = error(*one, dull);
    EXPECT_EQ(error(*one, brown), first) << "after another color";
    EXPECT_EQ(error(*reference(), brown), first);
    EXPECT_EQ(error(*reference(), dull), other);
}
