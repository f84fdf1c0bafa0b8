// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what POV-Ray makes of representations that only some rays meet: no black patches, no light
// through things, nothing that is seen and should not be.
#include "povray/povray_scenes.h"

#include <fstream>

using namespace lodestone;
using namespace lodestone::povray;
using scenes::above;
using scenes::Builder;

namespace {

constexpr double kSteps = 255;

/// A coarser level of an object of the builder.
void add_solid(Builder& builder, ObjectIndex object, const Primitive& solid, double error,
               const std::vector<uint32_t>& materials) {
    Representation level;
    level.summary.kind = Kind::Ellipsoid;
    level.materials = materials;
    level.payload = solid;
    summarize(level, builder.model);
    level.summary.error = error;
    builder.model.objects[object].representations.push_back(std::move(level));
}

/// A ball of 1 m in the air over the ground, seen from the side.
struct Floating {
    Builder builder;
    ObjectIndex ball = kNoObject;
    View view;

    Floating() {
        Material rough;
        rough.roughness = 0.9;
        rough.specular = 0;
        rough.base_color = {0.8, 0.3, 0.2};
        const uint32_t red = builder.material(rough);
        const uint32_t grey = builder.matte(glm::dvec3(0.7));
        ball = builder.mesh(shapes::sphere(1, 3), {red});
        add_solid(builder, ball, {}, 0.09, {red});  // .7 px of .1 m is not enough to see it
        builder.place(ball, {glm::dmat3(1.0), {0, 0, 3}}, "ball");
        builder.place(builder.mesh(shapes::box({-12, -12, -0.5}, {12, 12, 0}), {grey}), {},
                      "ground");
        builder.model.world.color = glm::dvec3(0.1);
        builder.model.lights = {scenes::sun(3, {0.3, 0.2, -1})};
        view.width = 96;
        view.height = 64;
        view.camera.position = {0, -16, 6};
        view.camera.direction = glm::normalize(glm::dvec3(0, -16, 6) * -1.0 + glm::dvec3(0, 0, 2));
        view.camera.right = {0.6, 0, 0};
        view.camera.up =
            0.4 * glm::normalize(glm::cross(glm::dvec3(1, 0, 0), view.camera.direction));
        view.pixel_error = 0.7;
    }

    struct Made {
        std::string text;
        scenes::Image image;
        size_t own = 0;
    };
    Made make(const std::string& name, RayMask rays, const ExportOptions& how = {},
              bool draw = true) {
        view.modifiers.ray_classes = rays;
        const Model& model = builder.finish();
        const choose::Cut cut = choose::choose_cut(model, view);
        const auto met = choose::choose_rays(model, view, cut, choose::shape_of);
        Made made;
        for (const choose::RayCut& own : met)
            made.own += own.own.size();
        ExportOptions options = how;
        options.folder = scratch(name);
        options.antialiasing = Antialiasing::Off;
        options.rays = met;
        Problems problems;
        export_scene(model, cut, view, options, problems);
        EXPECT_TRUE(problems.empty());
        made.text = read_file(options.folder / "scene.pov");
        if (!draw || !scenes::have_povray())
            return made;
        RunOptions run_how;
        run_how.folder = options.folder;
        run_how.output = OutputFormat::Ppm;
        run_how.threads = 1;
        const RunReport report = render_scene(run_how);
        EXPECT_EQ(report.messages, "");
        made.image = scenes::read_ppm(report.picture);
        return made;
    }
};

size_t count(const std::string& text, const std::string& word) {
    size_t found = 0;
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
        ++found;
    return found;
}

/// Pixels that differ by more than so many 255ths.
size_t differing(const scenes::Image& a, const scenes::Image& b, double steps) {
    size_t found = 0;
    for (size_t i = 0; i + 2 < a.values.size(); i += 3) {
        double most = 0;
        for (size_t c = i; c < i + 3; ++c)
            most = std::max(most, std::abs(a.values[c] - b.values.at(c)));
        found += most * kSteps > steps ? 1 : 0;
    }
    return found;
}

}  // namespace

TEST(RayClasses, WithoutAnythingOfItsOwnTheTextIsTheSame) {
    Floating scene;
    scene.view.pixel_error = 0;  // nothing is coarser
    const auto text = [&](const char* name, RayMask rays, const ExportOptions& how) {
        return scene.make(name, rays, how, false).text;
    };
    EXPECT_EQ(text("none", kShadowRays | kReflectionRays, {}), text("off", 0, {}));
    scene.view.pixel_error = 0.7;
    ExportOptions how;
    how.false_color = true;
    EXPECT_EQ(text("false", kShadowRays, how), text("false_off", 0, how));
    how.false_color = false;
    how.covered_only = true;
    EXPECT_EQ(text("covered", kShadowRays, how), text("covered_off", 0, how));
}

TEST(RayClasses, AShadowOfItsOwnDarkensTheGroundAndNotItsBall) {
    Floating scene;
    const Floating::Made off = scene.make("shadow_off", 0);
    const Floating::Made on = scene.make("shadow_on", kShadowRays);
    ASSERT_EQ(on.own, 1u);
    EXPECT_EQ(count(off.text, "no_"), 0u);
    EXPECT_EQ(count(on.text, "no_shadow"), 1u);
    EXPECT_EQ(count(on.text, "no_image no_reflection no_radiosity"), 1u);
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    // Only the shadow's edge is elsewhere, by less than a pixel: some 30 pixels around
    EXPECT_LE(differing(off.image, on.image, 5), 40u);
    // Without the one inside there would be light where the shadow was
    std::string bare = on.text;
    const size_t at = bare.rfind("object{", bare.find("no_image"));
    bare.erase(at, bare.find('\n', at) - at);
    RunOptions how;
    how.folder = own_scratch() / "shadow_on";
    write_file(how.folder / "scene.pov", bare);
    how.output = OutputFormat::Ppm;
    how.threads = 1;
    EXPECT_GT(differing(off.image, scenes::read_ppm(render_scene(how).picture), 40), 60u);
}

TEST(RayClasses, FlagsAreNeverUnderAnythingThatLosesThem) {
    Floating scene;
    // Enough lamps to group what they light, and to cut what many light
    for (int i = 0; i < 12; ++i) {
        Light lamp;
        lamp.kind = LightKind::Point;
        lamp.power = 40;
        lamp.position = {-11.0 + 2 * i, 3.0 * (i % 3) - 3, 8};
        scene.builder.model.lights.push_back(lamp);
    }
    const Floating::Made off = scene.make("flags_off", 0);
    const Floating::Made on = scene.make("flags_on", kShadowRays);
    ASSERT_EQ(on.own, 1u);
    for (size_t at = on.text.find(" no_"); at != std::string::npos;
         at = on.text.find(" no_", at + 1)) {
        const size_t begin = on.text.rfind('\n', at);
        const std::string line = on.text.substr(begin, on.text.find('\n', at) - begin);
        EXPECT_EQ(line.find("clipped_by"), std::string::npos) << line;
        EXPECT_EQ(line.find("\nobject{LDS_R_"), 0u) << line;
    }
    for (const char* lossy : {"bounded_by", "split_union", "intersection", "difference", "merge{"})
        EXPECT_EQ(on.text.find(lossy), std::string::npos) << lossy;
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    EXPECT_LE(differing(off.image, on.image, 8), 60u);
}

TEST(RayClasses, OnlyTheMirrorShowsWhatIsAroundTheBall) {
    Floating scene;
    Material chrome;
    chrome.metallic = 1;
    chrome.roughness = 0;
    chrome.base_color = glm::dvec3(0.9);
    const uint32_t mirror = scene.builder.material(chrome);
    const Affine upright{{{20, 0, 0}, {0, 0, 10}, {0, -1, 0}}, {-10, 5, 0.5}};
    scene.builder.place(scene.builder.mesh(shapes::quad(1, 1), {mirror}), upright, "mirror");
    const Floating::Made off = scene.make("mirror_off", 0);
    // A ball of another color would be seen where it is met
    const uint32_t green = scene.builder.matte({0, 1, 0});
    scene.builder.model.objects[scene.ball].representations[1].materials = {green};
    const Floating::Made on = scene.make("mirror_on", kReflectionRays);
    ASSERT_EQ(on.own, 1u);
    EXPECT_EQ(count(on.text, "no_image no_shadow no_radiosity"), 1u);
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    const size_t different = differing(off.image, on.image, 40);
    EXPECT_GT(different, 20u);
    // The ball itself is red as ever: a column of pixels from the middle down meets it
    size_t red = 0;
    size_t turned_green = 0;
    for (int y = 0; y < on.image.height; ++y) {
        for (int x = 0; x < on.image.width; ++x) {
            const glm::dvec3 was = off.image.at(x, y);
            const glm::dvec3 is = on.image.at(x, y);
            const bool ball = was.x > 2 * was.y;
            red += ball && is.x > 2 * is.y ? 1 : 0;
            turned_green += ball && is.y > 2 * is.x ? 1 : 0;
        }
    }
    EXPECT_GT(red, turned_green);
    EXPECT_GT(turned_green, 20u);
}

TEST(RayClasses, SharperLightsThanChosenForMeetTheOriginal) {
    Floating scene;
    Light lamp;
    lamp.kind = LightKind::Area;
    lamp.power = 500;
    lamp.position = {0, 0, 9};
    lamp.edge_u = {3, 0, 0};
    lamp.edge_v = {0, 3, 0};
    scene.builder.model.lights = {lamp};
    scene.view.pixel_error = 0.4;
    ExportOptions how;
    how.shading.area_samples = 9;
    const Floating::Made soft = scene.make("soft", kShadowRays, how, false);
    ASSERT_EQ(soft.own, 1u);
    EXPECT_EQ(count(soft.text, "no_shadow"), 1u);
    how.shading.area_samples = 1;
    EXPECT_EQ(count(scene.make("sharp", kShadowRays, how, false).text, "no_shadow"), 0u);
}
