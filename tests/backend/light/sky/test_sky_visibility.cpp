// SPDX-License-Identifier: GPL-3.0-or-later
// Guards how much of the sky surfaces see, by answers that are known.
#include "backend/light/sky/sky_places.h"
#include "base/parallel.h"
#include "light/sky/sky_means.h"
#include "scenes/damaged_files.h"

#include <glm/gtc/matrix_transform.hpp>

#include <limits>

using namespace lodestone;
using namespace lodestone::light;

namespace {

class SkyVisibility : public SkyPlaces {
protected:
    /// The shares of the first of the things, all of which hide the sky.
    SkyShares shares_of_first(const std::vector<std::pair<ObjectIndex, Affine>>& things,
                              size_t splits = 0) {
        const SkyPlace place(*this, things);
        return sky_shares({place.surfaces.of(finest(things[0].first)), things[0].second,
                           &*place.scene, 0, 64, splits},
                          {});
    }
    SkyMeans means_of_first(const std::vector<std::pair<ObjectIndex, Affine>>& things) {
        const SkyPlace place(*this, things);
        return mean_sky_shares(
            {place.surfaces.of(finest(things[0].first)), things[0].second, &*place.scene, 0, 64, 0},
            2048);
    }

    /// The mean of a level of something that hides the sky alone.
    double mean_of_level(const Mesh& mesh, ObjectIndex original, double error) {
        const ObjectIndex level = builder.mesh(mesh);
        SkyPlace place(*this, {{original, {}}});
        const std::vector<const Representation*> more{&finest(level)};
        place.surfaces.add(more, {});
        SkyRequest request{place.surfaces.of(finest(level)), {}, &*place.scene, error, 64, 0};
        request.original = &place.surfaces.of(finest(original));
        return sky_shares(request, {}).mean;
    }

    SkyShares shares_alone(const Mesh& mesh) {
        const ObjectIndex object = builder.mesh(mesh);
        SkySurfaces surfaces(builder.model);
        const std::vector<const Representation*> all{&finest(object)};
        surfaces.add(all, {});
        return sky_shares({surfaces.of(finest(object)), {}, nullptr, 0, 64, 0}, {});
    }
};

Affine moved(const glm::dvec3& offset) {
    return {glm::dmat3(1.0), offset};
}

Mesh turned_inside_out(Mesh mesh) {
    for (Triangle& t : mesh.triangles)
        std::swap(t.y, t.z);
    for (glm::vec3& normal : mesh.normals)
        normal = -normal;
    return mesh;
}

}  // namespace

TEST_F(SkyVisibility, OfAnOpenPlaneIsOne) {
    const SkyShares shares = shares_alone(shapes::quad(4, 4));
    EXPECT_EQ(shares.mean, 1);
    EXPECT_EQ(shares.corners, std::vector<uint8_t>(6, 255));
    EXPECT_TRUE(shares.splits.empty());
}

TEST_F(SkyVisibility, OfAConvexBodyIsOne) {
    EXPECT_EQ(shares_alone(shapes::cube()).mean, 1);
    EXPECT_GT(shares_alone(shapes::sphere(3, 3)).mean, 0.99);
}

TEST_F(SkyVisibility, OfTheInsideOfAClosedBoxIsZero) {
    const SkyShares shares = shares_alone(turned_inside_out(shapes::cube()));
    EXPECT_EQ(shares.mean, 0);
    EXPECT_EQ(shares.corners, std::vector<uint8_t>(36, 0));
}

TEST_F(SkyVisibility, AtTheFootOfAHighWallIsAHalf) {
    const ObjectIndex floor = builder.mesh(shapes::quad(1, 1));
    const ObjectIndex wall = builder.mesh(shapes::box({0, -5000, -1}, {1, 5000, 5000}));
    const SkyShares shares = shares_of_first({{floor, {}}, {wall, moved({1, 0, 0})}});
    EXPECT_NEAR(shares.mean, 0.5, 0.02);
}

TEST_F(SkyVisibility, BesideALongWallIsAsItsElevationSays) {
    const ObjectIndex floor = builder.mesh(shapes::quad(0.1f, 0.1f));
    const ObjectIndex wall = builder.mesh(shapes::box({0, -5000, -1}, {1, 5000, 4}));
    for (const double away : {1.0, 2.0, 4.0, 8.0, 16.0}) {
        const SkyMeans means = means_of_first({{floor, {}}, {wall, moved({away + 0.05, 0, 0})}});
        // The cosine-weighted share above an elevation e on one side: (1 + cos e) / 2.
        EXPECT_NEAR(means.placed, (1 + std::cos(std::atan(4 / away))) / 2, 0.015) << away;
        EXPECT_EQ(means.alone, 1);
    }
}

TEST_F(SkyVisibility, UnderACardThatIsHalfClearIsAHalf) {
    Material half;
    half.alpha = 0.5;
    half.alpha_mode = AlphaMode::Blend;
    Material glass;
    glass.transmission = 0.75;
    Material hole;
    hole.alpha = 0.2;
    hole.alpha_mode = AlphaMode::Clip;
    const ObjectIndex floor = builder.mesh(shapes::quad(1, 1));
    const std::pair<Material, double> cases[] = {
        {Material{}, 0}, {half, 0.5}, {glass, 0.75}, {hole, 1}};
    for (const auto& [material, share] : cases) {
        const ObjectIndex card =
            builder.mesh(shapes::quad(4000, 4000), {builder.material(material)});
        const std::vector<std::pair<ObjectIndex, Affine>> things = {{floor, moved({2000, 2000, 0})},
                                                                    {card, moved({0, 0, 1})}};
        EXPECT_NEAR(means_of_first(things).placed, share, 0.03) << share;
        EXPECT_NEAR(shares_of_first(things).mean, share, 0.08) << share;
    }
}

TEST_F(SkyVisibility, OfALeafIsThatOfTheSideThatIsSeenAndOfAWallThatOfItsFront) {
    Material leaf;
    leaf.alpha = 0.99;
    leaf.alpha_mode = AlphaMode::Blend;
    const ObjectIndex ceiling = builder.mesh(shapes::quad(4000, 4000));
    for (const bool clear : {false, true}) {
        const ObjectIndex card = builder.mesh(
            shapes::quad(1, 1), {clear ? builder.material(leaf) : builder.matte({1, 1, 1})});
        const double share = shares_of_first({{card, moved({2000, 2000, -1})}, {ceiling, {}}}).mean;
        EXPECT_NEAR(share, clear ? 1 : 0, 0.03);
    }
}

// A meadow was half as light as one of its flowers.
TEST_F(SkyVisibility, CopiesOfALeafOnTheGroundAreAsLightAsOne) {
    Material leaf;
    leaf.alpha = 0.99;
    leaf.alpha_mode = AlphaMode::Blend;
    const ObjectIndex card = builder.mesh(shapes::quad(1, 1), {builder.material(leaf)});
    const ObjectIndex ground = builder.mesh(shapes::quad(4000, 4000));
    const std::vector<std::pair<ObjectIndex, Affine>> things = {{card, moved({2000, 2000, 0.01})},
                                                                {ground, {}}};
    EXPECT_NEAR(shares_of_first(things).mean, 1, 0.03);
    EXPECT_NEAR(means_of_first(things).placed, 1, 0.03);
    EXPECT_NEAR(means_of_first(things).alone, 1, 1e-6);
}

// Crowns were darker than Cycles': a leaf's open side had the mean with the one that faces inward.
TEST_F(SkyVisibility, SidesOfALeafThatAreAlikeHaveTheirMean) {
    Material clear;
    clear.alpha = 0.99;
    clear.alpha_mode = AlphaMode::Blend;
    const ObjectIndex leaf = builder.mesh(shapes::quad(1, 1), {builder.material(clear)});
    EXPECT_NEAR(shares_of_first({{leaf, {}}}).mean, 1, 0.001);
    // Beside a wall that is high and deep each side sees half of the sky.
    const ObjectIndex wall = builder.mesh(shapes::box({-4000, 1, -4000}, {4000, 2, 4000}));
    EXPECT_NEAR(shares_of_first({{leaf, {}}, {wall, {}}}).mean, 0.5, 0.04);
}

TEST_F(SkyVisibility, DoesNotDependOnPlaceTurnAndScale) {
    const ObjectIndex torus = builder.mesh(shapes::torus(16, 12));
    const ObjectIndex box = builder.mesh(shapes::box({-1, -1, -1}, {1, 1, 1}));
    const auto shares_at = [&](const Affine& all) {
        return shares_of_first({{torus, all}, {box, all * moved({1.5, 0, 1.4})}});
    };
    const SkyShares plain = shares_at({});
    EXPECT_LT(plain.mean, 0.9);
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), 1.1, glm::normalize(glm::dvec3(1, 2, 3))));
    for (const Affine& all : {moved({1e4, -2e4, 300}), Affine{turn, {1, 2, 3}},
                              Affine{1e-3 * turn, {}}, Affine{1e4 * turn, {5, 5, 5}}}) {
        const SkyShares shares = shares_at(all);
        EXPECT_NEAR(shares.mean, plain.mean, 0.02);  // 3 sigma of two sets of 8,000 rays
        ASSERT_EQ(shares.corners.size(), plain.corners.size());
        double difference = 0;
        for (size_t i = 0; i < plain.corners.size(); ++i)
            difference +=
                std::abs(share_of_byte(shares.corners[i]) - share_of_byte(plain.corners[i]));
        EXPECT_LT(difference / static_cast<double>(plain.corners.size()),
                  0.08);  // rays in other directions
    }
}

// Rays began a millionth of the whole scene above everything: 60 mm here, above the shelf.
TEST_F(SkyVisibility, AFarThingErasesNoContactShade) {
    const ObjectIndex floor = builder.mesh(shapes::quad(1, 1));
    const ObjectIndex shelf = builder.mesh(shapes::box({-1, -1, .005}, {2, 2, .02}));
    const ObjectIndex far = builder.mesh(shapes::cube());
    const std::vector<std::pair<ObjectIndex, Affine>> near = {{floor, {}}, {shelf, {}}};
    auto all = near;
    all.emplace_back(far, moved({6e4, 0, 0}));
    EXPECT_LT(shares_of_first(near).mean, 0.01);
    EXPECT_NEAR(shares_of_first(all).mean, shares_of_first(near).mean, 1e-3);
    EXPECT_NEAR(means_of_first(all).placed, means_of_first(near).placed, 1e-3);
}

TEST_F(SkyVisibility, RoundingFarAwayHidesNothing) {
    const ObjectIndex floor = builder.mesh(shapes::quad(1, 1));
    const ObjectIndex here = builder.mesh(shapes::cube());
    for (const double away : {1e2, 1e4, 1e6}) {
        for (int i = 0; i < 8; ++i) {
            const glm::dmat3 turn(
                glm::rotate(glm::dmat4(1.0), 0.7 * i, glm::normalize(glm::dvec3(1, i, 3))));
            const SkyShares shares = shares_of_first({{floor, {turn, {away, away / 3, away / 7}}},
                                                      {here, moved({0, 0, -9})},
                                                      {here, moved({0, 0, -5})}});
            EXPECT_GT(shares.mean, 0.999) << away << ' ' << i;
        }
    }
}

// Strips of a level that lay behind the boards of a house were black.
TEST_F(SkyVisibility, OfALevelBehindItsOriginalIsThatOfTheOriginal) {
    // A thin board above a ground, and levels below and above it.
    const ObjectIndex board = builder.mesh(shapes::box({0, 0, 1}, {1, 1, 1.02}));
    const ObjectIndex ground = builder.mesh(shapes::quad(60, 60));
    const Affine beside = moved({-30, -30, 0.99});
    SkySurfaces surfaces(builder.model);
    const std::vector<SkyOccluder> occluders{{&finest(board), {}}, {&finest(ground), beside}};
    for (const double height : {0.95, 1.07}) {
        Mesh sheet = shapes::quad(1, 1);
        for (glm::vec3& position : sheet.positions)
            position.z = static_cast<float>(height);
        const Mesh under = turned_inside_out(sheet);
        const ObjectIndex top = builder.mesh(sheet);
        const ObjectIndex bottom = builder.mesh(under);
        const std::vector<const Representation*> all{&finest(board), &finest(ground), &finest(top),
                                                     &finest(bottom)};
        surfaces.add(all, {});
        const SkyScene scene(builder.model, surfaces, occluders, {});
        const auto mean = [&](ObjectIndex level, bool known) {
            SkyRequest request{surfaces.of(finest(level)), {}, &scene, 0.1, 64, 0};
            request.original = known ? &surfaces.of(finest(board)) : nullptr;
            return sky_shares(request, {}).mean;
        };
        // What faces up has the light of the top, which is all, and not of the dark side, which is
        // nearer; what faces down has that one.
        EXPECT_GT(mean(top, true), 0.98) << height;
        EXPECT_LT(mean(bottom, true), 0.05) << height;
    }
}

// A copy has the light of its own shape alone.
TEST_F(SkyVisibility, OfALevelAloneIsThatOfItsOriginalAlone) {
    const ObjectIndex original = builder.mesh(shapes::sphere(1, 3));
    const ObjectIndex inner = builder.mesh(shapes::sphere(0.8, 1));
    SkySurfaces surfaces(builder.model);
    const std::vector<const Representation*> all{&finest(original), &finest(inner)};
    surfaces.add(all, {});
    SkyRequest request{surfaces.of(finest(inner)), {}, nullptr, 0.3, 64, 0};
    request.original = &surfaces.of(finest(original));
    EXPECT_GT(sky_shares(request, {}).mean, 0.98);
}

// A level showed the wall behind the boards, and was black, for the boards hide the sky.
TEST_F(SkyVisibility, OfTheWallBehindBoardsIsThatOfTheBoards) {
    Mesh house = shapes::box({0, 0, 0}, {1, 1, 1});
    append(house, shapes::box({-0.1, -0.1, 0.98}, {1.1, 1.1, 1.05}), {});
    const ObjectIndex original = builder.mesh(house);
    for (const double height : {0.97, 1.0, 1.03, 1.08}) {
        Mesh sheet = shapes::quad(1, 1);
        for (glm::vec3& position : sheet.positions)
            position.z = static_cast<float>(height);
        EXPECT_GT(mean_of_level(sheet, original, 0.05), 0.98) << height;
    }
}

// A ceiling faces as the roof above it does, and is nearer to a level of the roof that lies below.
TEST_F(SkyVisibility, OfRoofsAboveCeilingsWasThatOfTheCeilings) {
    Mesh house = shapes::box({0, 0, 0}, {1, 1, 1});
    append(house, shapes::box({-0.1, -0.1, 1.1}, {1.1, 1.1, 1.2}), {});
    const ObjectIndex original = builder.mesh(house);
    Mesh sheet = shapes::quad(1, 1);
    for (glm::vec3& position : sheet.positions)
        position.z = 1.04F;
    EXPECT_GT(mean_of_level(sheet, original, 0.16), 0.98);
}

// Boards that became flat face into the house here and there, and were black.
TEST_F(SkyVisibility, OfALevelThatFacesIntoItsOriginalIsThatOfItsBack) {
    const ObjectIndex original = builder.mesh(shapes::box({0, 0, 0}, {1, 1, 0.5}));
    Mesh sheet = turned_inside_out(shapes::quad(1, 1));
    for (glm::vec3& position : sheet.positions)
        position.z = 0.5F;
    EXPECT_GT(mean_of_level(sheet, original, 0.02), 0.98);
}

TEST_F(SkyVisibility, IsTheSameOnAnyNumberOfThreads) {
    const ObjectIndex ground = builder.mesh(shapes::terrain(24));
    const ObjectIndex box = builder.mesh(shapes::box({.4, .4, -1}, {.6, .6, 1}));
    const auto bytes = [&](int threads) {
        const ThreadLimit limit(threads);
        return shares_of_first({{ground, {}}, {box, {}}}, 500).bytes();
    };
    const std::string alone = bytes(1);
    EXPECT_EQ(bytes(2), alone);
    EXPECT_EQ(bytes(7), alone);
}

TEST_F(SkyVisibility, LargeTrianglesAreSplitWhereItVaries) {
    const ObjectIndex ground = builder.mesh(shapes::quad(40, 40));
    const ObjectIndex house = builder.mesh(shapes::box({18, 18, -1}, {22, 22, 6}));
    const std::vector<std::pair<ObjectIndex, Affine>> things = {{ground, {}}, {house, {}}};
    const SkyShares coarse = shares_of_first(things);
    const SkyShares fine = shares_of_first(things, 1000);
    EXPECT_TRUE(coarse.splits.empty());
    ASSERT_FALSE(fine.splits.empty());
    const auto split = split_for_sky(finest(ground).mesh(), fine);
    ASSERT_TRUE(split);
    const Mesh& mesh = split->mesh;
    EXPECT_LE(mesh.triangles.size(), 1100u);
    EXPECT_NEAR(surface_area(mesh), 1600, 0.01);
    // Far corners see nearly all, those at the wall about a half.
    double far = 0;
    double near = 1;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 at(mesh.positions[mesh.triangles[i][corner]]);
            const double away = std::max(std::abs(at.x - 20), std::abs(at.y - 20));
            const double share = share_of_byte(fine.corners[3 * i + static_cast<size_t>(corner)]);
            if (away > 15)
                far = std::max(far, share);
            if (away > 2.2 && away < 3)
                near = std::min(near, share);
        }
    }
    EXPECT_GT(far, 0.97);
    EXPECT_LT(near, 0.72);
    EXPECT_GT(near, 0.3);
}

TEST_F(SkyVisibility, WhatLiesInTheGroundDarkensNothingAbove) {
    // A post of eight rings, three of which are below the ground.
    Mesh post;
    for (int ring = 0; ring <= 8; ++ring) {
        for (int i = 0; i < 12; ++i) {
            const double turn = i * kPi / 6;
            post.positions.emplace_back(std::cos(turn), std::sin(turn), ring - 3);
        }
    }
    for (uint32_t ring = 0; ring < 8; ++ring) {
        for (uint32_t i = 0; i < 12; ++i) {
            const uint32_t a = 12 * ring + i;
            const uint32_t b = 12 * ring + (i + 1) % 12;
            post.triangles.emplace_back(a, b, b + 12);
            post.triangles.emplace_back(a, b + 12, a + 12);
        }
    }
    const ObjectIndex object = builder.mesh(post);
    const ObjectIndex ground = builder.mesh(shapes::quad(400, 400));
    const SkyShares shares = shares_of_first({{object, {}}, {ground, moved({-200, -200, 0})}});
    for (size_t i = 0; i < post.triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            const double share = share_of_byte(shares.corners[3 * i + static_cast<size_t>(corner)]);
            const bool above = post.positions[post.triangles[i][corner]].z >= 0;
            EXPECT_TRUE(!above || std::abs(share - 0.5) < 0.2) << share;
        }
    }
}

// Pumpkins that lay a little in the ground were half as bright as they had to be.
TEST_F(SkyVisibility, TheMeanOfWhatStandsInTheGroundIsThatOfWhatIsSeenOfIt) {
    const ObjectIndex box = builder.mesh(shapes::box({-1, -1, -1}, {1, 1, 1}));
    const ObjectIndex ground = builder.mesh(shapes::quad(400, 400));
    const SkyMeans means = means_of_first({{box, {}}, {ground, moved({-200, -200, 0})}});
    // The top of 4 m2 sees all, sides of 8 m2 above the ground a half.
    EXPECT_NEAR(means.placed, 8.0 / 12, 0.04);
    EXPECT_NEAR(means.alone, 1, 0.01);
}

// The walls of a cave were black where they were seen from outside.
TEST_F(SkyVisibility, AnOpenSheetThatIsDarkInFrontHasHalfOfItsBack) {
    Mesh cave = turned_inside_out(shapes::cube());
    cave.triangles.erase(cave.triangles.begin());  // a little hole
    const SkyShares shares = shares_alone(cave);
    EXPECT_GT(shares.mean, 0.1);
    EXPECT_LT(shares.mean, 0.55);
}

TEST_F(SkyVisibility, StrangeMeshesAreSurvived) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Mesh strange = shapes::quad(1, 1);
    strange.positions.emplace_back(nan, 0, 0);
    strange.positions.emplace_back(1e30f, 0, 0);
    strange.triangles.emplace_back(0, 1, 4);
    strange.triangles.emplace_back(0, 0, 1);
    strange.triangles.emplace_back(0, 1, 5);
    EXPECT_EQ(shares_alone(strange).corners.size(), 15u);
    EXPECT_TRUE(shares_alone(Mesh{}).corners.empty());
    const ObjectIndex object = builder.mesh(shapes::cube());
    EXPECT_EQ(shares_of_first({{object, {glm::dmat3(0.0), {}}}}, 10).corners.size(), 36u);
}

// Rays to one side of a leaf began at one half of it, those to the other side at the other half.
TEST_F(SkyVisibility, RaysToEachSideOfALeafBeginAllOverIt) {
    Material clear;
    clear.alpha = 0.99;
    clear.alpha_mode = AlphaMode::Blend;
    const ObjectIndex leaf = builder.mesh(shapes::quad(1, 1), {builder.material(clear)});
    // Close above the half that is near the first corner of both triangles.
    const auto half = static_cast<float>(std::sqrt(0.5));
    const ObjectIndex roof = builder.mesh(shapes::box({0, 0, .001f}, {half, half, .002f}));
    // One side sees half of the sky, the other all: they count as much as they see.
    EXPECT_NEAR(means_of_first({{leaf, {}}, {roof, {}}}).placed, (0.25 + 1) / 1.5, 0.02);
}

// The normals of what is flattened were not numbers, so that it was as light as in the open.
TEST_F(SkyVisibility, OfAFlattenedBoxBesideAWallIsAHalf) {
    const ObjectIndex box = builder.mesh(shapes::cube());
    const ObjectIndex wall = builder.mesh(shapes::box({0, -5000, -5000}, {1, 5000, 5000}));
    const Affine flat{glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0.0)),
                      {-1.5, 0, 0}};
    const SkyShares shares = shares_of_first({{box, flat}, {wall, {}}});
    EXPECT_NEAR(shares.mean, 0.5, 0.05);
    const SkyMeans means = means_of_first({{box, flat}, {wall, {}}});
    EXPECT_NEAR(means.placed, 0.5, 0.05);
    EXPECT_EQ(means.alone, 1);
}

TEST_F(SkyVisibility, MeansThatCannotBeAreRefused) {
    const PlacedMeans good{{{0, 1, 0}, 0.25}, {{0.25, 0.5, {1, 0, -2}, {0, 3, 0}}, {1, 1}, {0, 0}}};
    const auto back = PlacedMeans::of_bytes(good.bytes(), 3);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->horizon.up, glm::dvec3(0, 1, 0));
    EXPECT_EQ(back->horizon.below, 0.25);
    EXPECT_EQ(back->means[0].placed, 0.25);
    EXPECT_EQ(back->means[0].alone, 0.5);
    EXPECT_EQ(back->means[0].slope, glm::dvec3(1, 0, -2));
    EXPECT_EQ(back->means[0].middle, glm::dvec3(0, 3, 0));
    EXPECT_FALSE(PlacedMeans::of_bytes(good.bytes(), 2));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const SkyMeans bad : {SkyMeans{nan, 1},
                               {0, nan},
                               {1, 1e-30},
                               {0.5, 2},
                               {-0.5, 1},
                               {kInfinity, kInfinity},
                               {0.5, 1, {nan, 0, 0}},
                               {0.5, 1, {}, {0, 0, kInfinity}}})
        EXPECT_FALSE(PlacedMeans::of_bytes(PlacedMeans{{}, {bad}}.bytes(), 1))
            << bad.placed << ' ' << bad.alone;
    for (const SkyHorizon bad : {SkyHorizon{{nan, 0, 1}, 1}, {{0, 0, 1}, nan}, {{0, 0, 1}, 2}})
        EXPECT_FALSE(PlacedMeans::of_bytes(PlacedMeans{bad, {}}.bytes(), 0)) << bad.below;
}

TEST_F(SkyVisibility, SharesComeBackFromBytesAndDamagedOnesAreRefused) {
    const ObjectIndex ground = builder.mesh(shapes::quad(40, 40));
    const ObjectIndex house = builder.mesh(shapes::box({18, 18, -1}, {22, 22, 6}));
    const SkyShares shares = shares_of_first({{ground, {}}, {house, {}}}, 200);
    ASSERT_FALSE(shares.splits.empty());
    const std::string bytes = shares.bytes();
    const auto back = SkyShares::of_bytes(bytes, 2);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->bytes(), bytes);
    const Mesh& mesh = finest(ground).mesh();
    PcgRandom random(3);
    for (int i = 0; i < 2000; ++i) {
        const auto damaged = SkyShares::of_bytes(hostile::mutated(bytes, random), 2);
        if (damaged)
            split_for_sky(mesh, *damaged);
    }
    EXPECT_FALSE(SkyShares::of_bytes("", 2));
    EXPECT_FALSE(split_for_sky(shapes::torus(64, 64), shares));
}

// Slabs of a pavement with many bolts were tinted, each by the few rays of a large mesh.
TEST_F(SkyVisibility, LargeTrianglesOfFineMeshesHaveMoreRays) {
    Mesh mesh = shapes::quad(4, 4);
    for (int i = 0; i < 200; ++i)
        append(mesh, shapes::quad(0.01F, 0.01F), moved({5 + 0.02 * i, 0, 0}));
    const ObjectIndex pavement = builder.mesh(mesh);
    const ObjectIndex wall = builder.mesh(shapes::box({-1, 0, 0}, {0, 4, 2}));
    const SkyPlace place(*this, {{pavement, {}}, {wall, {}}});
    const auto corners = [&](int rays, int most) {
        const SkyRequest request{
            place.surfaces.of(finest(pavement)), {}, &*place.scene, 0, rays, 0, most};
        return sky_shares(request, {}).corners;
    };
    const std::vector<uint8_t> truth = corners(2048, 0);
    const auto error = [&](const std::vector<uint8_t>& found) {
        int sum = 0;
        for (size_t i = 0; i < 6; ++i)  // those of the slab
            sum += std::abs(found[i] - truth[i]);
        return sum;
    };
    EXPECT_LT(2 * error(corners(16, 512)), error(corners(16, 0)));
    EXPECT_EQ(corners(16, 16), corners(16, 0));
    EXPECT_EQ(corners(128, 64), corners(128, 0));
}
