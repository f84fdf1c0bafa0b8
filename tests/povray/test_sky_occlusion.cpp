// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the shade of the sky in POV-Ray's scenes: it is as dark as it must be, makes no ray go on
// more than once, and is found once.
#include "base/findings_file.h"
#include "base/parallel.h"
#include "povray/povray_scenes.h"
#include "povray_export/lamp/placement_grades.h"
#include "povray_export/lamp/sky_occlusion.h"
#include "povray_export/texture/texture_writer.h"
#include "scenes/with_rays.h"

#include <cstring>
#include <regex>
#include <set>
#include <thread>

using namespace lodestone;
using namespace lodestone::povray;
using scenes::Builder;

namespace {

class SkyOcclusionScenes : public WithRays {
protected:
    SkyOcclusionScenes() {
        std::filesystem::remove_all(own_scratch());  // with what an earlier run kept
        builder.model.world.color = glm::dvec3(0.5);
    }

    ExportReport write(const std::string& folder, const Model& model, int rays = 64) {
        ExportOptions options;
        options.folder = own_scratch() / folder;
        options.shading.sky_rays = rays;
        Problems problems;
        const ExportReport report = scenes::write(model, scenes::above(), options, problems);
        EXPECT_TRUE(problems.empty()) << problems.front().message;
        return report;
    }

    /// The texts of all include files that a folder's scene uses.
    std::string includes(const std::string& folder) const {
        const std::filesystem::path path = own_scratch() / folder;
        const std::string scene = read_file(path / "scene.pov");
        std::string out;
        const std::string begin = "#include \"";
        for (size_t at = scene.find(begin); at != std::string::npos;
             at = scene.find(begin, at + 1)) {
            const size_t name = at + begin.size();
            out += read_file(path / scene.substr(name, scene.find('"', name) - name));
        }
        return out;
    }

    /// Places a group of a box of one metre, which is drawn as another mesh.
    void place_group(const Mesh& stand_in, double x) {
        const ObjectIndex box = builder.mesh(shapes::box({0, 0, 0}, {1, 1, 1}));
        const ObjectIndex drawn = builder.mesh(stand_in);
        Object group;
        group.uid = group.name = "group" + std::to_string(x);
        Representation places;
        places.summary.kind = Kind::Assembly;
        Assembly assembly;
        assembly.placements = {{box, {}, "box", 0}};
        places.payload = std::make_shared<const Assembly>(assembly);
        group.representations = {places, builder.model.objects[drawn].representations[0]};
        group.representations[1].summary.error = 1e-9;
        group.representations[1].summary.max_error = 0.02;
        builder.model.objects.push_back(group);
        builder.place(static_cast<ObjectIndex>(builder.model.objects.size() - 1),
                      {glm::dmat3(1.0), {x, 0, 0}});
    }

    /// The sky's shares on the groups that are placed.
    std::vector<light::SkyShares> shares_of_stand_ins() {
        const choose::Cut cut = choose::choose_cut(builder.finish(), scenes::above());
        Problems problems;
        const SkyOcclusion light(builder.model, cut, {}, problems, {});
        EXPECT_TRUE(problems.empty());
        std::vector<light::SkyShares> out;
        for (size_t i = 0; i < cut.chosen.size(); ++i) {
            const choose::CutNode& node = cut.nodes[cut.chosen[i]];
            if (builder.model.objects[node.object].group() && light.of(i))
                out.push_back(*light.of(i)->shares);
        }
        return out;
    }

    Builder builder;
};

/// The different answers to the sky in a text.
std::set<std::string> ambients(const std::string& text) {
    std::set<std::string> found;
    const std::string begin = "finish{ambient rgb ";
    for (size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1))
        found.insert(text.substr(at + begin.size(), text.find('>', at) - at - begin.size()));
    return found;
}

/// The triangles of a text whose corners have textures of their own.
size_t shaded_triangles(const std::string& text) {
    static const std::regex kThree(R"(<\d+,\d+,\d+>,\d+,\d+,\d+)");
    return static_cast<size_t>(
        std::distance(std::sregex_iterator(text.begin(), text.end(), kThree), {}));
}

/// The keys of a file of bakes, and the size of each one's bytes.
std::vector<std::pair<Hash, uint32_t>> kept_bakes(const std::filesystem::path& file) {
    const std::string bytes = read_file(file);
    std::vector<std::pair<Hash, uint32_t>> out;
    // After its magic, each bake is 16 bytes of head, of which the last four are its size.
    for (size_t place = 8; place + 24 <= bytes.size();) {
        auto& [key, size] = out.emplace_back();
        std::memcpy(&key, bytes.data() + place, sizeof key);
        std::memcpy(&size, bytes.data() + place + 12, sizeof size);
        place += 16 + size;
    }
    return out;
}

Affine at(double x, double y, double z) {
    return {glm::dmat3(1.0), {x, y, z}};
}

}  // namespace

TEST_F(SkyOcclusionScenes, UnderARoofItIsAsDarkAsTheSkyThatIsSeen) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no povray";
    // The roof is hidden from the camera, that looks at the floor through it.
    const ObjectIndex floor = builder.mesh(shapes::quad(1, 1), {builder.matte({.8, .8, .8})});
    const ObjectIndex wall = builder.mesh(shapes::box({0, -500, -1}, {1, 500, 500}));
    builder.place(floor, at(-.5, -.5, 0));
    builder.place(wall, at(.5, 0, 0), "wall", kCameraRays);
    const Model& model = builder.finish();
    ExportOptions options;
    options.folder = own_scratch() / "scene";
    const scenes::Image half = scenes::render(model, scenes::above(), options);
    options.folder = own_scratch() / "open";
    options.shading.sky_rays = -1;
    const scenes::Image open = scenes::render(model, scenes::above(), options);
    EXPECT_NEAR(half.at(32, 32).x / open.at(32, 32).x, 0.5, 0.05);
}

TEST_F(SkyOcclusionScenes, WithoutSkyRaysOrASkyTheTextIsAsBefore) {
    const ObjectIndex floor = builder.mesh(shapes::quad(4, 4), {builder.matte({.8, .8, .8})});
    const ObjectIndex box = builder.mesh(shapes::cube(), {builder.matte({.8, .8, .8})});
    builder.place(floor, at(-2, -2, 0));
    builder.place(box, at(0, 0, .2));
    write("off", builder.finish(), -1);
    EXPECT_EQ(ambients(includes("off")).size(), 1u);
    write("on", builder.model);
    EXPECT_GT(ambients(includes("on")).size(), 3u);
    builder.model.world.color = glm::dvec3(0.0);
    write("dark", builder.model);
    EXPECT_EQ(includes("dark"), includes("off"));
}

// Every hit on a smooth floor sent three rays on, and each of these three more.
TEST_F(SkyOcclusionScenes, WhereRaysGoOnTheCornersOfATriangleShareATexture) {
    Material rough;
    rough.roughness = 0.6;
    Material smooth = rough;
    smooth.roughness = 0.1;
    Material metal = rough;
    metal.metallic = 1;
    metal.roughness = 0.3;
    Material glass = rough;
    glass.transmission = 0.5;
    Material below;
    below.roughness = 1;
    below.other = std::make_shared<const Material>(smooth);
    below.mix = 0.5;
    Material pictured = rough;
    pictured.roughness_texture = scenes::checker(ColorSpace::Linear);
    const std::vector<uint32_t> materials{builder.material(rough)};
    builder.place(builder.mesh(shapes::quad(4, 4), materials), at(-2, -2, 0));
    builder.place(builder.mesh(shapes::box({-1, -1, .2}, {1, 1, 1}), materials));
    builder.finish();
    // Without coordinates of textures a picture makes nothing smooth.
    const std::pair<Material, bool> cases[] = {{rough, false}, {smooth, true}, {metal, true},
                                               {glass, true},  {below, true},  {pictured, false}};
    int number = 0;
    for (const auto& [material, even] : cases) {
        builder.model.materials.back() = material;
        const std::string folder = std::to_string(number++);
        write(folder, builder.model);
        EXPECT_EQ(shaded_triangles(includes(folder)) == 0, even) << material.roughness;
        EXPECT_GT(ambients(includes(folder)).size(), 3u);
    }
    EXPECT_TRUE(rays_go_on(pictured, true));
}

TEST_F(SkyOcclusionScenes, WhatGlowsGlowsAsBefore) {
    Material glow;
    glow.emission = {2, 2, 2};
    glow.specular = 0;  // gloss shows the box, too
    const ObjectIndex floor = builder.mesh(shapes::quad(4, 4), {builder.material(glow)});
    const ObjectIndex box = builder.mesh(shapes::box({-1, -1, .2}, {1, 1, 1}));
    builder.place(floor, at(-2, -2, 0));
    builder.place(box);
    write("on", builder.finish());
    const std::string text = includes("on");
    // The pigment of 0.8 multiplies emission.
    const std::string emission = "emission rgb <2.5,2.5,2.5>";
    size_t count = 0;
    for (size_t found = text.find(emission); found != std::string::npos;
         found = text.find(emission, found + 1))
        ++count;
    EXPECT_GT(count, 2u);
}

TEST_F(SkyOcclusionScenes, TheSecondPictureFindsNothingAgain) {
    const ObjectIndex floor = builder.mesh(shapes::quad(4, 4));
    const ObjectIndex box = builder.mesh(shapes::cube());
    builder.place(floor, at(-2, -2, 0));
    builder.place(box, at(0, 0, .2));
    const Model& model = builder.finish();
    const ExportReport first = write("scene", model);
    const std::filesystem::path file = own_scratch() / "scene" / "sky_light.bin";
    ASSERT_TRUE(std::filesystem::exists(file));
    std::filesystem::last_write_time(file, {});
    const std::string text = includes("scene");
    const ExportReport second = write("scene", model);
    EXPECT_EQ(second.bytes, first.bytes);
    EXPECT_EQ(second.written, 2u);  // scene.pov and scene.ini
    EXPECT_EQ(std::filesystem::last_write_time(file), std::filesystem::file_time_type{});
    EXPECT_EQ(includes("scene"), text);
}

// A file of such bytes made every export fail.
TEST_F(SkyOcclusionScenes, KeptLightOnAnotherMeshIsFoundAnew) {
    builder.place(builder.mesh(shapes::quad(4, 4)), at(-2, -2, 0));
    builder.place(builder.mesh(shapes::cube()), at(0, 0, .2));
    const Model& model = builder.finish();
    write("scene", model);
    const std::string text = includes("scene");
    const std::filesystem::path file = own_scratch() / "scene" / "sky_light.bin";
    const std::vector<std::pair<Hash, uint32_t>> kept = kept_bakes(file);
    FindingsFile bakes(file, kSkyVersion);
    for (const auto& [key, size] : kept) {
        light::SkyShares other;
        other.splits = {{geometry::welded_edge(0, 1)}};
        other.corners.assign(300, 128);
        bakes.add(key, other.bytes());
    }
    EXPECT_EQ(kept.size(), 2u);
    bakes.save();
    std::filesystem::remove_all(own_scratch() / "scene" / "r");
    write("scene", model);
    EXPECT_EQ(includes("scene"), text);
}

TEST_F(SkyOcclusionScenes, AMovedHouseMakesOtherShade) {
    const ObjectIndex floor = builder.mesh(shapes::quad(4, 4));
    const ObjectIndex box = builder.mesh(shapes::cube());
    builder.place(floor, at(-2, -2, 0));
    builder.place(box, at(0, 0, .2));
    write("scene", builder.finish());
    const std::string before = includes("scene");
    Object& root = builder.model.objects[0];
    Assembly placed = root.representations[0].assembly();
    placed.placements[1].transform.offset.x = -1;
    root.representations[0].payload = std::make_shared<const Assembly>(placed);
    summarize_assemblies(builder.model, bottom_up(builder.model));
    write("scene", builder.model);
    EXPECT_NE(includes("scene"), before);
}

TEST_F(SkyOcclusionScenes, ManyCopiesHaveAtMostFourGrades) {
    Mesh mesh = shapes::sphere(1, 4);
    const ObjectIndex ball = builder.mesh(mesh);
    const ObjectIndex roof = builder.mesh(shapes::box({-20, -20, 2}, {20, 20, 3}));
    for (int x = 0; x < 80; x += 8) {
        for (int y = 0; y < 80; y += 8)
            builder.place(ball, at(x, y, 0));
    }
    builder.place(roof);
    const ExportReport report = write("scene", builder.finish());
    EXPECT_GE(report.sky_copies, 1u);
    EXPECT_LE(report.sky_copies, 3u);
    EXPECT_EQ(report.representations, 2 + report.sky_copies);
}

// The bar stood still, and a picture that was stopped began from nothing again.
TEST_F(SkyOcclusionScenes, WhatIsFinishedIsKeptWhenItIsStopped) {
    for (int i = 0; i < 40; ++i)
        builder.place(builder.mesh(shapes::torus(8, 8 + static_cast<uint32_t>(i))),
                      at(2 * i, 0, 0));
    const choose::Cut cut = choose::choose_cut(builder.finish(), scenes::above());
    const std::filesystem::path file = own_scratch() / "sky_light.bin";
    volatile int32_t cancel = 0;
    volatile int32_t stage = 0;
    volatile double part = 0;
    Problems problems;
    // One thread stops when the other one has found something.
    std::jthread watcher([&](const std::stop_token& stop) {
        while (!stop.stop_requested() && part == 0)
            std::this_thread::yield();
        cancel = 1;
    });
    SkyOcclusionOptions options;
    options.file = file;
    options.rays = 1024;
    EXPECT_THROW(SkyOcclusion(builder.model, cut, options, problems, {&cancel, &stage, &part}),
                 Error);
    EXPECT_GT(part, 0);
    EXPECT_LT(part, 1);
    const size_t kept = kept_bakes(file).size();
    EXPECT_GE(kept, 1u);
    EXPECT_LT(kept, 40u);
}

// It was walked through for ever: its groups place the next one twice, 40 times over.
TEST_F(SkyOcclusionScenes, AModelOfEmptyGroupsHasAnEnd) {
    builder.place(builder.mesh(shapes::cube()));
    builder.finish();
    Model& model = builder.model;
    Object stand_in = model.objects[1];
    const auto first = static_cast<ObjectIndex>(model.objects.size());
    for (uint32_t i = 0; i < 40; ++i) {
        Object group;
        group.uid = group.name = "group" + std::to_string(i);
        Representation places;
        places.summary.kind = Kind::Assembly;
        Assembly assembly;
        if (i < 39)
            assembly.placements.assign(2, {first + i + 1, {}, "next", 0});
        places.payload = std::make_shared<const Assembly>(assembly);
        group.representations = {places};
        model.objects.push_back(group);
    }
    model.objects[first].representations.push_back(stand_in.representations[0]);
    model.objects[first].representations[1].summary.error = 1e-9;
    builder.place(first);
    builder.finish();
    const choose::Cut cut = choose::choose_cut(model, scenes::above());
    ASSERT_EQ(cut.chosen.size(), 2u);
    Problems problems;
    const SkyOcclusion light(model, cut, {}, problems, {});
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].code, "sky_not_occluded");
}

// A house that is drawn as its group's stand-in had black strips.
TEST_F(SkyOcclusionScenes, StandInsBehindWhatTheyStandForAreAsLightAsThat) {
    const Mesh inner = shapes::box({.05, .05, .05}, {.95, .95, .95});
    const Mesh outer = shapes::box({-.05, -.05, -.05}, {1.05, 1.05, 1.05});
    Mesh turned = shapes::cube();
    for (Triangle& t : turned.triangles)
        std::swap(t.y, t.z);
    double x = 0;
    for (const Mesh& stand_in : {inner, outer, turned})
        place_group(stand_in, x += 100);
    const std::vector<light::SkyShares> found = shares_of_stand_ins();
    ASSERT_EQ(found.size(), 3u);
    for (const light::SkyShares& shares : found) {
        ASSERT_FALSE(shares.corners.empty());
        for (const uint8_t corner : shares.corners)
            EXPECT_GT(light::share_of_byte(corner), 0.95);
    }
}

TEST_F(SkyOcclusionScenes, TheLightOnStandInsIsTheSameOnAnyNumberOfThreads) {
    builder.place(builder.mesh(shapes::quad(900, 900)), at(-450, -450, -.2));
    for (int i = 0; i < 3; ++i)
        place_group(shapes::box({.05, .05, .05}, {.95, .95, .9 + .01 * i}), 2 * i);
    const auto bytes = [&](int threads) {
        const ThreadLimit limit(threads);
        std::string all;
        for (const light::SkyShares& shares : shares_of_stand_ins())
            all += shares.bytes();
        return all;
    };
    const std::string alone = bytes(1);
    EXPECT_FALSE(alone.empty());
    EXPECT_EQ(bytes(2), alone);
    EXPECT_EQ(bytes(7), alone);
}

// Levels for classes of rays had a file for each of up to 257 factors.
TEST_F(SkyOcclusionScenes, OtherLevelsOfCopiesHaveFewFactors) {
    const ObjectIndex ball = builder.mesh(shapes::sphere(1, 1));
    builder.place(builder.mesh(shapes::box({-20, -20, 2}, {20, 20, 3})));
    for (int i = 0; i < 60; ++i)
        builder.place(ball, at(i * 0.7, 0, 0));
    const choose::Cut cut = choose::choose_cut(builder.finish(), scenes::above());
    Problems problems;
    const SkyOcclusion light(builder.model, cut, {}, problems, {});
    std::set<Hash> hashes;
    for (const uint32_t node : cut.chosen) {
        ASSERT_TRUE(light.mean_of_node(node));
        hashes.insert(light.mean_of_node(node)->hash);
    }
    EXPECT_GE(hashes.size(), 3u);
    EXPECT_LE(hashes.size(), 1u + kPlacementGrades);
}

// The rays of each were as many as what was not known yet left time for.
TEST_F(SkyOcclusionScenes, TheLightOnCopiesDoesNotDependOnWhatIsKept) {
    const ObjectIndex things[] = {builder.mesh(shapes::quad(1, 1)),
                                  builder.mesh(shapes::quad(2, 1))};
    builder.place(builder.mesh(shapes::box({-20, -20, 2}, {20, 20, 3})));
    const int copies = 4500;
    for (const ObjectIndex thing : things) {
        for (int i = 0; i < copies; ++i)
            builder.place(thing, at(i % 67, i % 69, 0.001 * i));
    }
    write("scene", builder.finish());
    const std::filesystem::path file = own_scratch() / "scene" / "sky_light.bin";
    FindingsFile all(file, kSkyVersion);
    FindingsFile some(own_scratch() / "some" / "sky_light.bin", kSkyVersion);
    int means = 0;
    for (const auto& [key, size] : kept_bakes(file)) {
        // A horizon is five numbers of four bytes, a mean eight; those of one thing are left out.
        if (size != 20 + 32 * copies || ++means > 1)
            some.add(key, std::string(*all.find(key)));
    }
    EXPECT_EQ(means, 2);
    some.save();
    write("some", builder.model);
    EXPECT_TRUE(includes("some") == includes("scene"));
}

// Splits follow all that is there, and what was kept those of another scene.
TEST_F(SkyOcclusionScenes, SharesOfOtherSplitsAreNotTaken) {
    builder.place(builder.mesh(shapes::quad(40, 40)), at(-20, -20, 0));
    builder.place(builder.mesh(shapes::box({-1, -1, -1}, {1, 1, 9})));
    write("scene", builder.finish());
    const ObjectIndex moving = builder.mesh(shapes::torus(64, 64));
    builder.model.objects[moving].deforms = true;
    builder.place(moving, at(0, 0, 90));
    builder.finish();
    write("scene", builder.model);
    write("fresh", builder.model);
    EXPECT_EQ(includes("scene"), includes("fresh"));
}

// A street of ten million placed triangles was left out, and nobody told how much is too much.
TEST_F(SkyOcclusionScenes, AProblemTellsHowMuchIsTooMuch) {
    builder.place(builder.mesh(shapes::torus(10, 10)));
    for (int i = 0; i < 20; ++i)
        builder.place(builder.mesh(shapes::torus(8, 8)), at(3 * i, 0, 0));
    const choose::Cut cut = choose::choose_cut(builder.finish(), scenes::above());
    SkyOcclusionOptions options;
    options.most_triangles = 327;  // however often they are placed
    Problems problems;
    const SkyOcclusion none(builder.model, cut, options, problems, {});
    EXPECT_FALSE(none.of(0));
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].code, "sky_not_occluded");
    EXPECT_NE(problems[0].message.find("328 distinct triangles, of 327 at most"), std::string::npos)
        << problems[0].message;
    options.most_triangles = 328;
    const SkyOcclusion some(builder.model, cut, options, problems, {});
    EXPECT_TRUE(some.of(0));
    EXPECT_EQ(problems.size(), 1u);
}

TEST_F(SkyOcclusionScenes, ABoxUnderARoofIsDarkerAsAWhole) {
    Primitive primitive;
    primitive.half_size = {.5, .5, .5};
    const ObjectIndex box = builder.primitive(Kind::Box, primitive, {builder.matte({1, 1, 1})});
    const ObjectIndex roof = builder.mesh(shapes::box({-50, -50, 2}, {50, 50, 3}));
    builder.place(box);
    builder.place(roof);
    builder.place(box, at(500, 0, 0));
    write("scene", builder.finish());
    const choose::Cut cut = choose::choose_cut(builder.model, scenes::above());
    Problems problems;
    const SkyOcclusion light(builder.model, cut, {}, problems, {});
    ASSERT_TRUE(light.of(0) && light.of(2));
    EXPECT_LT(light.of(0)->factor, 0.75);
    EXPECT_GT(light.of(2)->factor, 0.95);
    EXPECT_NE(light.of(0)->hash, light.of(2)->hash);
}
