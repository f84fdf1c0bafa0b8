// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what a picture needs: what it shows, in mirrors and through leaves too, and what throws
// shadows into it; nothing else.
#include "base/parallel.h"
#include "light/seen/seen_parts.h"
#include "scenes/fine_grids.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"

#include <algorithm>
#include <limits>

using namespace lodestone;
using namespace lodestone::light;
using models::add_leaf;
using models::moved;

namespace {

/// From the origin along +x; 64 x 36 pixels, 45 degrees to both sides.
View along_x() {
    View view;
    view.width = 64;
    view.height = 36;
    view.camera.position = {0, 0, 0};
    view.camera.direction = {1, 0, 0};
    view.camera.right = {0, -2, 0};
    view.camera.up = {0, 0, 1.125};
    return view;
}

Light sun(const glm::dvec3& direction) {
    Light out;
    out.kind = LightKind::Sun;
    out.direction = direction;
    return out;
}

Light lamp(const glm::dvec3& position) {
    Light out;
    out.kind = LightKind::Point;
    out.position = position;
    return out;
}

class SeenPartsTest : public WithRays {
protected:
    /// A box around a point; returns its number.
    size_t add(const glm::dvec3& middle, const glm::dvec3& size, const Material& material = {},
               RayMask hidden = 0) {
        return add(shapes::box(-0.5 * size, 0.5 * size), middle, material, hidden);
    }
    size_t add(const Mesh& mesh, const glm::dvec3& place, const Material& material = {},
               RayMask hidden = 0) {
        const std::string uid = "thing " + std::to_string(model_.objects.size());
        things_.push_back({add_leaf(model_, uid, mesh, material), place, hidden});
        mirrors_.push_back(material.metallic > 0 || material.transmission > 0);
        return things_.size() - 1;
    }
    SeenParts parts() {
        Model model = model_;
        std::vector<Placement> placements;
        RendererSurfaces renderer;
        for (const bool mirror : mirrors_) {
            renderer.reflections.emplace_back();
            renderer.reflections.back().may_mirror = mirror;
        }
        std::vector<DrawnThing> drawn;
        for (const PlacedThing& thing : things_) {
            const Affine world = moved(thing.place.x, thing.place.y, thing.place.z);
            placements.push_back({thing.object, world, "it", thing.hidden});
            drawn.push_back({&model.objects[thing.object].representations[0], world, thing.hidden});
        }
        model.root = models::add_group(model, "all", placements);
        summarize_assemblies(model, bottom_up(model));
        for (DrawnThing& thing : drawn)  // adding moved the objects
            thing.representation =
                &model.objects[things_[static_cast<size_t>(&thing - drawn.data())].object]
                     .representations[0];
        return SeenParts(model, renderer, drawn, view_, model.lights, {});
    }
    uint8_t needs(size_t thing) { return parts().needs(thing); }

    struct PlacedThing {
        ObjectIndex object;
        glm::dvec3 place;
        RayMask hidden;
    };
    Model model_;
    View view_ = along_x();
    std::vector<PlacedThing> things_;
    std::vector<bool> mirrors_;
};

Material mirror() {
    Material out;
    out.metallic = 1;
    out.roughness = 0;
    return out;
}

}  // namespace

TEST_F(SeenPartsTest, NothingNeedsNothing) {
    EXPECT_TRUE(parts().known());
    add({-10, 0, 0}, {1, 1, 1});  // behind the eye
    EXPECT_EQ(needs(0), 0);
}

TEST_F(SeenPartsTest, WhatIsInThePictureIsSeenAndWhatIsBehindAWallIsNot) {
    add({10, 0, 0}, {0.1, 40, 40});
    const size_t behind = add({20, 0, 0}, {1, 1, 1});
    const size_t before = add({5, 1, 1}, {1, 1, 1});
    const SeenParts found = parts();
    EXPECT_EQ(found.needs(0), kSeen);
    EXPECT_EQ(found.needs(behind), 0);
    EXPECT_EQ(found.needs(before), kSeen);
    for (const uint8_t need : found.triangles(behind))
        EXPECT_EQ(need, 0);
}

TEST_F(SeenPartsTest, WhatIsHiddenFromTheCameraHidesNothing) {
    const size_t wall = add({10, 0, 0}, {0.1, 40, 40}, {}, kCameraRays);
    const size_t behind = add({20, 0, 0}, {1, 1, 1});
    EXPECT_EQ(needs(behind), kSeen);
    EXPECT_EQ(needs(wall), 0);
}

TEST_F(SeenPartsTest, ShadowsAreSeenOfThingsThatAreNot) {
    model_.lights = {sun({1, 0, -1})};
    const size_t floor = add({10, 0, -2}, {30, 30, 0.1});
    const size_t behind_the_eye = add({-4, 0, 8}, {1, 1, 1});  // its shadow falls on x = 6
    const size_t far_behind = add({-40, 0, 8}, {1, 1, 1});     // on x = -30
    const SeenParts found = parts();
    EXPECT_NE(found.needs(floor) & kSeen, 0);
    EXPECT_EQ(found.needs(behind_the_eye), kShades);
    EXPECT_EQ(found.needs(far_behind), 0);
    model_.lights[0].shadow = false;
    EXPECT_EQ(needs(behind_the_eye), 0);
    model_.lights[0].shadow = true;
    things_[behind_the_eye].hidden = kShadowRays;
    EXPECT_EQ(needs(behind_the_eye), 0);
}

TEST_F(SeenPartsTest, AThingInTheShadowOfAnotherThrowsNone) {
    model_.lights = {sun({0, 0, -1})};
    add({10, 0, -2}, {30, 30, 0.1});
    add({10, 0, 40}, {60, 60, 0.1});  // out of the picture, and over all of it
    const size_t above = add({10, 0, 42}, {1, 1, 1});
    const size_t below = add({10, 0, 38}, {1, 1, 1});
    EXPECT_EQ(needs(above), 0);
    EXPECT_EQ(needs(1), kShades);
    EXPECT_EQ(needs(below), kShades);
}

TEST_F(SeenPartsTest, AMirrorShowsWhatIsBehindTheEye) {
    add({10, 0, 0}, {0.1, 4, 4}, mirror());
    const size_t behind = add({-10, 0, 0}, {3, 3, 3});
    const size_t aside = add({-10, 80, 0}, {3, 3, 3});
    const size_t unmirrored = add({-10, 2, 2}, {1, 1, 1}, {}, kReflectionRays);
    const SeenParts found = parts();
    EXPECT_TRUE(found.known());
    EXPECT_EQ(found.needs(behind), kSeen);
    EXPECT_EQ(found.needs(aside), 0);
    EXPECT_EQ(found.needs(unmirrored), 0);
}

TEST_F(SeenPartsTest, WhereOnlyTheRendererKnowsWhereRaysGoEverythingIsNeeded) {
    Material glass;
    glass.transmission = 1;
    add({10, 0, 0}, {1, 1, 1}, glass);
    const size_t behind_the_eye = add({-10, 0, 0}, {1, 1, 1});
    EXPECT_FALSE(parts().known());
    EXPECT_EQ(needs(behind_the_eye), kSeen | kShades);
    things_[0].place = {-30, 0, 0};  // no ray meets it
    EXPECT_TRUE(parts().known());
    EXPECT_EQ(needs(behind_the_eye), 0);
    Material bumpy = mirror();
    bumpy.bump_texture.picture = models::checker();
    add({10, 0, 0}, {1, 1, 1}, bumpy);
    EXPECT_FALSE(parts().known());
}

TEST_F(SeenPartsTest, ClearThingsAreSeenAndSeenThrough) {
    Material pane;
    pane.alpha_mode = AlphaMode::Blend;
    pane.alpha = 0.3;
    Material hole = pane;
    hole.alpha = 0;
    const size_t first = add({5, 0, 0}, {0.1, 20, 20}, pane);
    const size_t nothing = add({6, 0, 0}, {0.1, 20, 20}, hole);
    const size_t behind = add({9, 0, 0}, {1, 1, 1});
    const SeenParts found = parts();
    EXPECT_EQ(found.needs(first), kSeen);
    EXPECT_EQ(found.needs(nothing), 0);
    EXPECT_EQ(found.needs(behind), kSeen);
}

// A lamp of two pixels far away could lie between the rays of a large picture.
TEST_F(SeenPartsTest, NoSmallThingIsMissed) {
    std::vector<size_t> small;
    for (int i = 0; i < 300; ++i) {  // a tenth of a pixel each
        const double y = (i % 20 - 9.5) * 8;
        const int row = i / 20;
        const double z = (row - 7) * 5;
        small.push_back(add({100, y, z}, glm::dvec3(0.3)));
    }
    const SeenParts found = parts();
    for (const size_t i : small)
        EXPECT_EQ(found.needs(i), kSeen) << i;
}

TEST_F(SeenPartsTest, OfALargeMeshTheSeenPartsAreNeeded) {
    const Mesh ground = shapes::grid(100);  // 1 x 1
    Mesh wide = ground;
    for (glm::vec3& at : wide.positions)
        at = {200 * (at.x - 0.5f), 200 * (at.y - 0.5f), -2};
    const size_t floor = add(wide, {0, 0, 0});
    const SeenParts found = parts();
    const std::span<const uint8_t> needs = found.triangles(floor);
    size_t seen = 0;
    for (size_t i = 0; i < needs.size(); ++i) {
        glm::vec3 middle(0.0f);
        for (int corner = 0; corner < 3; ++corner)
            middle += wide.positions[wide.triangles[i][corner]] / 3.0f;
        seen += needs[i];
        if (middle.x < -12) {
            EXPECT_EQ(needs[i], 0) << middle.x;
        }
        // Below the picture's lower edge it begins at 3.6 m, and is as wide as far.
        if (middle.x > 8 && std::abs(middle.y) < middle.x - 4) {
            EXPECT_EQ(needs[i], kSeen) << middle.x << ", " << middle.y;
        }
    }
    EXPECT_LT(seen, needs.size() / 3);
    EXPECT_GT(seen, needs.size() / 8);
}

TEST_F(SeenPartsTest, LampsShadeByWhereTheirShadowsCanBe) {
    model_.lights = {lamp({5, 0, 10})};
    add({10, 0, -2}, {30, 30, 0.1});
    const size_t below = add({5, 0, 8}, {1, 1, 1});
    const size_t above = add({5, 0, 20}, {1, 1, 1});
    EXPECT_EQ(needs(below), kShades);
    EXPECT_EQ(needs(above), 0);
}

// A forest with a lantern was written as a whole: the lantern's shadows could be anywhere.
TEST_F(SeenPartsTest, WhatALampMayShadeBehindAWallWasNeeded) {
    model_.lights = {lamp({5, 0, 4})};
    add({10, 0, -2}, {30, 30, 0.1});
    add({12, 0, 10}, {0.1, 60, 60});
    const size_t before = add({8, 0, 3}, {0.5, 0.5, 0.5});
    std::vector<size_t> behind;
    behind.reserve(20);
    for (int i = 0; i < 20; ++i)
        behind.push_back(add({16, i - 10.0, 0}, {0.5, 0.5, 0.5}));
    const SeenParts found = parts();
    EXPECT_NE(found.needs(before) & kShades, 0);
    for (const size_t tree : behind)
        EXPECT_EQ(found.needs(tree), 0);
}

TEST_F(SeenPartsTest, TheShadowOfASlatBelowManyLampsIsFound) {
    add({10, 0, -2}, {30, 30, 0.1});
    for (int i = 0; i < 40; ++i)
        model_.lights.push_back(lamp({8, i - 20.0, 2}));
    const size_t above = add({8, 0, 40}, {0.5, 0.5, 0.5});
    const size_t slat = add({8, 0, 1}, {0.3, 60, 0.1}, {}, kCameraRays);
    const SeenParts found = parts();
    EXPECT_EQ(found.needs(above), 0);
    EXPECT_EQ(found.needs(slat), kShades);
}

TEST_F(SeenPartsTest, OfTooManyLightsEverythingThrowsShadows) {
    model_.lights.assign(120'000, sun({0, 0, -1}));
    add({10, 0, 0}, {1, 1, 1});
    const size_t behind_the_eye = add({-10, 0, 0}, {1, 1, 1});
    EXPECT_EQ(needs(behind_the_eye), kShades);
    model_.lights.resize(2);
    EXPECT_EQ(needs(behind_the_eye), 0);
}

TEST_F(SeenPartsTest, OrthographicPicturesShowWhatIsBeforeThem) {
    view_.camera.orthographic = true;
    view_.camera.right = {0, -10, 0};
    view_.camera.up = {0, 0, 5.625};
    const size_t before = add({50, 4, 2}, {1, 1, 1});
    const size_t aside = add({50, 6, 0}, {1, 1, 1});
    const size_t small = add({50, -3, 1}, glm::dvec3(0.02));
    const SeenParts found = parts();
    EXPECT_EQ(found.needs(before), kSeen);
    EXPECT_EQ(found.needs(aside), 0);
    EXPECT_EQ(found.needs(small), kSeen);
}

TEST_F(SeenPartsTest, AnyNumberOfThreadsFindsTheSame) {
    model_.lights = {sun({1, 0.2, -1})};
    model_.lights[0].angle = 0.05;
    add({10, 0, -2}, {30, 30, 0.1});
    add(shapes::sphere(2, 5), {12, 0, 0});
    add(shapes::torus(60, 30), {8, 2, 0}, mirror());
    for (int i = 0; i < 40; ++i)
        add({6.0 + i, 0.7 * (i % 7) - 2, 0.3 * (i % 5)}, glm::dvec3(0.4));
    const auto all = [&] {
        const SeenParts found = parts();
        std::vector<uint8_t> out;
        for (size_t i = 0; i < things_.size(); ++i) {
            const auto of_thing = found.triangles(i);
            out.insert(out.end(), of_thing.begin(), of_thing.end());
        }
        return out;
    };
    const std::vector<uint8_t> many = all();
    const ThreadLimit alone(1);
    EXPECT_EQ(all(), many);
    EXPECT_NE(std::count(many.begin(), many.end(), kSeen | kShades), 0);
}

TEST_F(SeenPartsTest, ItCanBeStopped) {
    add({10, 0, 0}, {1, 1, 1});
    int32_t cancel = 1;
    Model model = model_;
    RendererSurfaces renderer;
    renderer.reflections.emplace_back();
    const std::vector<DrawnThing> drawn = {
        {&model.objects[0].representations[0], moved(10, 0, 0), 0}};
    EXPECT_THROW(
        SeenParts(model, renderer, drawn, view_, model.lights, Job(&cancel, nullptr, nullptr)),
        Error);
}

TEST_F(SeenPartsTest, StrangeMeshesAreSurvived) {
    Mesh strange = shapes::sphere(1, 4);
    for (size_t i = 0; i < strange.positions.size(); i += 5)
        strange.positions[i].x = i % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : 1e38f;
    add(strange, {8, 0, 0});
    Mesh empty = shapes::quad(1, 1);
    empty.triangles.clear();
    add(empty, {8, 0, 0});
    Mesh flat = shapes::quad(1, 1);
    flat.positions.assign(flat.positions.size(), {0, 0, 0});
    add(flat, {8, 0, 0});
    const size_t seen = add({6, 1, 0}, {1, 1, 1});
    model_.lights = {sun({1, 0, -1})};
    model_.lights.push_back(sun({0, 0, 0}));
    model_.lights.push_back(sun({std::numeric_limits<double>::quiet_NaN(), 0, 1}));
    const SeenParts found = parts();
    EXPECT_NE(found.needs(seen) & kSeen, 0);
    EXPECT_EQ(found.needs(1), 0);
}

TEST_F(SeenPartsTest, ShadowsThroughASkylightWereLost) {
    model_.lights = {sun({0, 0, -1})};
    add({10, 0, -2}, {30, 30, 0.1});
    Material glass;
    glass.transmission = 1;
    add({10, 0, 40}, {60, 60, 0.1}, glass);  // out of the picture
    const size_t tree = add({10, 0, 45}, {3, 3, 3});
    const SeenParts found = parts();
    EXPECT_TRUE(found.known());
    EXPECT_EQ(found.needs(tree), kShades);
}

TEST_F(SeenPartsTest, OfManySunsTheStrongestIsAlwaysLookedAt) {
    for (int i = 0; i < 40; ++i) {
        model_.lights.push_back(sun({0.01 * i, 0, -1}));
        model_.lights.back().power = 0.01;
    }
    model_.lights.push_back(sun({1, 0, -1}));
    add({10, 0, -2}, {30, 30, 0.1});
    const Mesh fine = shapes::grid(30);  // its shadow lies in the picture
    const size_t sheet = add(fine, {-2, -0.5, 8});
    const SeenParts found = parts();
    const std::span<const uint8_t> needs = found.triangles(sheet);
    EXPECT_EQ(std::count(needs.begin(), needs.end(), kShades),
              static_cast<std::ptrdiff_t>(needs.size()));
    model_.lights.back().power = -1;  // takes light away where it is not hidden
    EXPECT_EQ(parts().needs(sheet), kShades);
}

TEST_F(SeenPartsTest, AHalfClearMirrorShowsWhatIsBehindTheEye) {
    Material pane = mirror();
    pane.alpha_mode = AlphaMode::Blend;
    pane.alpha = 0.3;
    add({10, 0, 0}, {0.1, 4, 4}, pane);
    const size_t behind_the_eye = add({-10, 0, 0}, {3, 3, 3});
    const size_t behind_the_pane = add({15, 0, 0}, {1, 1, 1});
    const SeenParts found = parts();
    EXPECT_EQ(found.needs(behind_the_eye), kSeen);
    EXPECT_EQ(found.needs(behind_the_pane), kSeen);
}

TEST_F(SeenPartsTest, AWallCloseBehindAHalfClearLayerIsSeen) {
    Material layer;
    layer.alpha_mode = AlphaMode::Blend;
    layer.alpha = 0.5;
    add({0, 0, -1000}, {4000, 4000, 1});  // makes single precision coarse
    add(shapes::quad(40, 40), {0, 0, 0});
    things_.back().place = {-20, -20, -3.001};
    const size_t poster = things_.size() - 1;
    add({12, 0, 0}, {0.001, 8, 4}, layer);
    const size_t wall = add({12.002, 0, 0}, {0.001, 8, 4});
    const SeenParts found = parts();
    EXPECT_EQ(found.needs(wall) & kSeen, kSeen);
    EXPECT_EQ(found.needs(poster) & kSeen, kSeen);
}
