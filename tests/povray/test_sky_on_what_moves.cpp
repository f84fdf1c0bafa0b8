// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the sky's light on what moves in an animation, and on sides under an uneven sky.
#include "povray/povray_scenes.h"
#include "povray_export/lamp/sky_occlusion.h"
#include "scenes/sky_worlds.h"
#include "scenes/with_rays.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>

using namespace lodestone;
using namespace lodestone::povray;
using scenes::Builder;

namespace {

class SkyOnWhatMoves : public WithRays {
protected:
    SkyOnWhatMoves() {
        std::filesystem::remove_all(own_scratch());  // with what an earlier run kept
        builder.model.world.color = glm::dvec3(0.5);
    }

    static Affine at(double x, double y, double z) { return {glm::dmat3(1.0), {x, y, z}}; }
    /// The share of the sky's light on each object, in the mean.
    std::map<ObjectIndex, double> means(const SkyOcclusionOptions& options = {}) {
        const choose::Cut cut = choose::choose_cut(builder.finish(), scenes::above());
        Problems problems;
        const SkyOcclusion light(builder.model, cut, options, problems, {});
        std::map<ObjectIndex, double> out;
        for (const uint32_t node : cut.chosen)
            out[cut.nodes[node].object] = light.mean_of_node(node)->factor;
        return out;
    }

    /// The light on an object, where all things are so many pixels across.
    SkyLightPtr light_on(ObjectIndex object, double pixels) {
        const choose::Cut cut = choose::choose_cut(builder.finish(), scenes::above());
        SkyOcclusionOptions options;
        options.pixels_across = [pixels](const Bound&) { return pixels; };
        Problems problems;
        const SkyOcclusion light(builder.model, cut, options, problems, {});
        for (size_t i = 0; i < cut.chosen.size(); ++i) {
            if (cut.nodes[cut.chosen[i]].object == object)
                return light.of(i);
        }
        return nullptr;
    }

    Builder builder;
};
using SkyOnSides = SkyOnWhatMoves;

}  // namespace

TEST_F(SkyOnWhatMoves, WhatMovesHidesTheSkyFromItselfAlone) {
    const ObjectIndex floor = builder.mesh(shapes::quad(4, 4));
    const ObjectIndex box = builder.mesh(shapes::box({-1, -1, .2}, {1, 1, 1}));
    builder.place(floor, at(-2, -2, 0));
    builder.place(box);
    builder.model.objects[box].deforms = true;
    const choose::Cut cut = choose::choose_cut(builder.finish(), scenes::above());
    Problems problems;
    const SkyOcclusion light(builder.model, cut, {}, problems, {});
    for (size_t i = 0; i < cut.chosen.size(); ++i) {
        if (cut.nodes[cut.chosen[i]].object == floor) {
            EXPECT_EQ(light.of(i)->shares->mean, 1);
        }
    }
}

// Crates with rigid bodies stood on a floor without any shade around them.
TEST_F(SkyOnWhatMoves, InAStillPictureWhatMovesIsAsWhatRests) {
    const ObjectIndex floor = builder.mesh(shapes::quad(4, 4));
    const ObjectIndex crate = builder.mesh(shapes::box({-1, -1, 0}, {1, 1, 1}));
    const ObjectIndex above = builder.mesh(shapes::box({-.5, -.5, 1}, {.5, .5, 2}));
    builder.place(floor, at(-2, -2, 0));
    builder.place(crate);
    builder.place(above);
    SkyOcclusionOptions still;
    still.still = true;
    const std::map<ObjectIndex, double> resting = means();
    EXPECT_LT(resting.at(floor), .95);
    for (const ObjectIndex moving : {crate, above}) {
        builder.model.objects[moving].deforms = true;
        EXPECT_NE(means(), resting);
        EXPECT_EQ(means(still), resting);
    }
}

// Boxes that move were lit from below, through the ground that they stand on.
TEST_F(SkyOnWhatMoves, AGroundHidesTheSkyBelowWhatMoves) {
    Primitive primitive;
    primitive.half_size = {.5, .5, .5};
    const ObjectIndex solid = builder.primitive(Kind::Box, primitive, {builder.matte({1, 1, 1})});
    const ObjectIndex box = builder.mesh(shapes::box({-1, -1, -1}, {1, 1, 1}));
    builder.place(solid, at(0, 0, .5));
    builder.place(box, at(9, 0, 1));
    for (const ObjectIndex moving : {solid, box})
        builder.model.objects[moving].deforms = true;
    const std::map<ObjectIndex, double> alone = means();
    EXPECT_NEAR(alone.at(solid), 1, .02);
    EXPECT_NEAR(alone.at(box), 1, .02);
    builder.place(builder.mesh(shapes::quad(200, 200)), at(-100, -100, -.01));
    const std::map<ObjectIndex, double> on_ground = means();
    // Of six sides the upper one sees all of the sky, four see half of it and one none.
    EXPECT_NEAR(on_ground.at(solid), .5, .05);
    EXPECT_NEAR(on_ground.at(box), .5, .05);
}

TEST_F(SkyOnWhatMoves, WhatTumblesHasAboutTheSameLightInAllFrames) {
    const ObjectIndex box = builder.mesh(shapes::box({-1, -1, -1}, {1, 1, 1}));
    builder.model.objects[box].deforms = true;
    const glm::dmat4 turn =
        glm::rotate(glm::rotate(glm::dmat4(1.0), .96, {1, 0, 0}), .79, {0, 1, 0});
    builder.place(box, {glm::dmat3(turn), {0, 0, 3}});
    builder.place(builder.mesh(shapes::quad(200, 200)), at(-100, -100, 0));
    EXPECT_NEAR(means().at(box), .5, .05);
}

TEST_F(SkyOnWhatMoves, OnlyWhatIsWiderAndBelowIsAGround) {
    const ObjectIndex box = builder.mesh(shapes::box({-1, -1, -1}, {1, 1, 1}));
    builder.model.objects[box].deforms = true;
    builder.place(box, at(0, 0, 5));
    builder.place(builder.mesh(shapes::quad(5, 5)), at(-2.5, -2.5, 3));  // a table
    builder.place(builder.mesh(shapes::quad(50, 50)), at(-25, -25, 9));  // a roof
    builder.place(builder.mesh(shapes::quad(51, 50)), at(100, -25, 0));  // beside it
    EXPECT_NEAR(means().at(box), 1, .02);
    builder.place(builder.mesh(shapes::quad(52, 50)), at(-25, -25, -90));
    EXPECT_NEAR(means().at(box), .5, .05);
}

// A sky of two sides lit everything by 24 suns, each a ray at every point.
TEST_F(SkyOnSides, ASideIsLitByTheSkyThatItFacesWithoutRays) {
    builder.model.world = world_of_sky([](const glm::dvec3& d) {
        const double x = d.x / std::hypot(d.x, d.y);
        return glm::dvec3(1 + x, 1.0, 1 - x);  // red toward X, then blue
    });
    builder.place(builder.mesh(shapes::box({-1, -1, -1}, {1, 1, 1})));
    ExportOptions options;
    options.folder = own_scratch();
    Problems problems;
    const ExportReport report = scenes::write(builder.finish(), scenes::above(), options, problems);
    EXPECT_EQ(report.sky_lights, 0u);
    const std::string scene = read_file(own_scratch() / "scene.pov");
    EXPECT_EQ(scene.find("light_source"), std::string::npos);
    const size_t name = scene.find("#include \"") + 10;
    const std::string mesh =
        read_file(own_scratch() / scene.substr(name, scene.find('"', name) - name));
    std::vector<double> reddish;  // red beside blue, by texture
    const std::regex ambient("ambient rgb <([^,]*),([^,]*),([^>]*)>");
    for (std::sregex_iterator found(mesh.begin(), mesh.end(), ambient), end; found != end; ++found)
        reddish.push_back(std::stod((*found)[1]) / std::stod((*found)[3]));
    ASSERT_FALSE(reddish.empty());
    // What faces X receives five times as much red as blue, or more: (1 + 2/3) / (1 - 2/3).
    EXPECT_GT(*std::max_element(reddish.begin(), reddish.end()), 3);
    EXPECT_LT(*std::min_element(reddish.begin(), reddish.end()), 1.0 / 3);
}

// A cube that was drawn as a box was as light on its sides as above.
TEST_F(SkyOnSides, SidesOfABoxThatIsLargeInThePictureHaveLightOfTheirOwn) {
    Primitive primitive;
    primitive.half_size = {1, 1, 1};
    const ObjectIndex box = builder.primitive(Kind::Box, primitive, {builder.matte({1, 1, 1})});
    builder.place(box, at(0, 0, 1));
    builder.place(builder.mesh(shapes::quad(40, 40)), at(-20, -20, -.01));
    const SkyLightPtr even = light_on(box, 1);
    ASSERT_TRUE(even);
    EXPECT_FALSE(even->shares);
    EXPECT_NEAR(even->factor, .5, .05);
    const SkyLightPtr sides = light_on(box, 100);
    ASSERT_TRUE(sides && sides->shares);
    const Mesh mesh = tessellate_box(primitive);
    ASSERT_EQ(sides->shares->corners.size(), 3 * mesh.triangles.size());
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const double up = glm::normalize(area_vector(mesh, i)).z;
        const double expected = up > .5 ? 1 : up < -.5 ? 0 : .5;
        for (int corner = 0; corner < 3; ++corner)
            EXPECT_NEAR(sides->share(i, corner, mesh.positions[mesh.triangles[i][corner]]),
                        expected, .1);
    }
    ExportOptions options;
    options.folder = own_scratch();
    Problems problems;
    scenes::write(builder.model, scenes::above(), options, problems);
    std::string text;
    for (const auto& entry : std::filesystem::directory_iterator(own_scratch() / "r"))
        text += read_file(entry.path());
    EXPECT_EQ(text.find("box{"), std::string::npos);  // it is as wide as the picture
    View far = scenes::above();
    far.camera.right *= 20;  // orthographic: 3 pixels
    far.camera.up *= 20;
    options.folder = own_scratch() / "far";
    scenes::write(builder.model, far, options, problems);
    text.clear();
    for (const auto& entry : std::filesystem::directory_iterator(options.folder / "r"))
        text += read_file(entry.path());
    EXPECT_NE(text.find("box{"), std::string::npos);
}

// Spheres that became ellipsoids were as light below as above.
TEST_F(SkyOnSides, AnEllipsoidThatIsLargeInThePictureIsShaded) {
    const ObjectIndex ball =
        builder.primitive(Kind::Ellipsoid, Primitive{}, {builder.matte({1, 1, 1})});
    builder.place(ball, at(0, 0, 1));
    builder.place(builder.mesh(shapes::quad(400, 400)), at(-200, -200, -.01));
    const SkyLightPtr even = light_on(ball, 10);
    ASSERT_TRUE(even);
    EXPECT_FALSE(even->shares);
    EXPECT_NEAR(even->factor, 0.5, 0.05);
    const SkyLightPtr shaded = light_on(ball, 100);
    ASSERT_TRUE(shaded && shaded->shares);
    const Mesh mesh = light::drawn_mesh(builder.model.objects[ball].representations[0]);
    ASSERT_EQ(mesh.triangles.size(), 1280u);
    const auto split = light::split_for_sky(mesh, *shaded->shares);
    ASSERT_TRUE(split);
    for (size_t i = 0; i < split->mesh.triangles.size(); ++i) {
        const double up = glm::normalize(area_vector(split->mesh, i)).z;
        double share = 0;
        for (size_t corner = 0; corner < 3; ++corner)
            share += light::share_of_byte(shaded->shares->corners[3 * i + corner]) / 3;
        EXPECT_NEAR(share, (1 + up) / 2, 0.15);  // as an open hill of that slope
    }
}
