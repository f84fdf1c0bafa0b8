// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the exported text: sharing, rounding, hostile input.
#include "base/parallel.h"
#include "povray/povray_scenes.h"
#include "povray_export/scene/povray_number.h"
#include "povray_export/scene/representation_writer.h"
#include "povray_export/texture/surface_finish.h"

#include <fstream>
#include <limits>

using namespace lodestone;
using namespace lodestone::povray;
using scenes::above;
using scenes::Builder;
using scenes::rich_sphere;

namespace {

size_t count(const std::string& text, const std::string& part) {
    size_t found = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++found;
    return found;
}

std::string scene_text(const std::filesystem::path& folder) {
    return read_file(folder / "scene.pov");
}

std::vector<std::filesystem::path> includes(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "r"))
        out.push_back(entry.path());
    std::sort(out.begin(), out.end());
    return out;
}

std::string include_text(const Model& model, ObjectIndex object,
                         const RepresentationOptions& options = {}) {
    PictureWriter pictures;
    MaskOutlines outlines;
    return representation_text(model, model.objects[object].representations[0], "X", options,
                               pictures, outlines, {});
}

std::string number(const DecimalLattice& lattice, double value) {
    char text[DecimalLattice::kMostCharacters];
    return {text, lattice.write(text, lattice.round(value))};
}

}  // namespace

TEST(PovrayWriter, NumbersAreShortAndExactToTheStep) {
    const DecimalLattice metre(1e-6, 100);
    EXPECT_EQ(number(metre, 0), "0");
    EXPECT_EQ(number(metre, 0.5), ".5");
    EXPECT_EQ(number(metre, -12.25), "-12.25");
    EXPECT_EQ(number(metre, -0.000002), "-.000002");
    EXPECT_EQ(number(metre, 1.0000004), "1");
    EXPECT_EQ(number(metre, 100), "100");
    EXPECT_EQ(number(DecimalLattice(1e-7, 1), 0.1000001), ".1000001");
    EXPECT_EQ(number(DecimalLattice(1, 99), -7), "-7");
    const DecimalLattice fine(0, 1e-1);
    EXPECT_EQ(number(fine, 0.100000000000003), ".100000000000003");
    for (const uint64_t count : {0u, 9u, 10u, 99u, 100u, 101u, 65535u, 999999u, 4294967295u}) {
        char text[20];
        EXPECT_EQ(std::string(text, write_count(text, count)), std::to_string(count));
    }
    char most[20];
    EXPECT_EQ(std::string(most, write_count(most, ~uint64_t{0})), "18446744073709551615");
    EXPECT_EQ(std::stod(number(DecimalLattice(1e24, 3e38), 3e38)), 3e38);
    EXPECT_NEAR(std::stod(number(DecimalLattice(1e-46, 1e-40), 1e-40)), 1e-40, 1e-46);
    for (const double size : {1e-3, 0.7, 1.0, 2.0, 5.0, 900.0, 1e7}) {
        const DecimalLattice lattice(size * 1e-6, size);
        for (int i = 0; i < 100; ++i) {
            const double value = size * std::sin(i * 1.7);
            EXPECT_LE(std::abs(std::stod(number(lattice, value)) - value), size * 1e-6);
        }
    }
    EXPECT_THROW(metre.round(std::numeric_limits<double>::quiet_NaN()), Error);
    EXPECT_THROW(metre.round(std::numeric_limits<double>::infinity()), Error);
    std::string out;
    EXPECT_THROW(append_number(out, std::numeric_limits<double>::infinity()), Error);
}

TEST(PovrayWriter, NumbersAreThoseOfPrintfWhateverTheirSize) {
    std::vector<double> values = {
        1,    0.1,     0.5,       2.5,    1e-4,   9.9999e-5, 9999999999.4,
        1e10, 1e15,    0.1 + 0.2, 1e-300, 1e300,  123456.5,  0.99999999995,
        1e9,  1 / 3.0, 2 / 3.0,   1e22,   5e-324, 0.000125,  999999.99999999,
        1e14, 4.5e9};
    for (int i = 1; i < 4000; ++i)
        values.push_back(std::sin(i * 12.9898) * std::pow(10.0, i % 31 - 12));
    for (int i = 1; i < 2000; ++i)  // as Blender's transforms are, and what lies between two texts
        values.insert(values.end(),
                      {double{static_cast<float>(std::sin(i * 0.7) * i)}, i + 0.5,
                       i * 1e-10 + 0.5e-10, std::nextafter(std::pow(10.0, i % 15), 0)});
    for (const int digits : {1, 2, 6, 9, 10, 15, 17}) {
        for (const double value : values) {
            for (const double signed_value : {value, -value}) {
                char expected[64];
                (void)std::snprintf(expected, sizeof expected, "%.*g", digits, signed_value);
                std::string out;
                append_number(out, signed_value, digits);
                ASSERT_EQ(out, expected) << digits << " digits";
            }
        }
    }
}

TEST(PovrayWriter, AnEmptyModelIsASceneWithoutObjects) {
    ExportOptions options;
    options.folder = scratch("empty");
    Problems problems;
    const ExportReport report = export_scene(Model{}, choose::Cut{}, above(), options, problems);
    EXPECT_EQ(report.files, 2u);
    EXPECT_EQ(report.occurrences, 0u);
    EXPECT_EQ(count(scene_text(options.folder), "object{"), 0u);
    EXPECT_EQ(count(scene_text(options.folder), "camera{"), 1u);
}

TEST(PovrayWriter, ACubeIsOneDeclarationWithWeldedCornersAndNoNormals) {
    Builder builder;
    const ObjectIndex cube = builder.mesh(shapes::cube(), {builder.matte(glm::dvec3(1.0))});
    const std::string text = include_text(builder.model, cube);
    EXPECT_EQ(count(text, "vertex_vectors{8,"), 1u);
    EXPECT_EQ(count(text, "face_indices{12,"), 1u);
    EXPECT_EQ(count(text, "normal_vectors"), 0u);  // its normals are those of its faces
    EXPECT_EQ(count(text, "texture_list"), 0u);
    EXPECT_EQ(count(text, "texture{"), 1u);
}

TEST(PovrayWriter, SmoothNormalsAndUvsNeedNoIndicesOfTheirOwn) {
    Builder builder;
    const uint32_t checker = builder.material(scenes::textured(scenes::checker()));
    Mesh mesh = shapes::sphere(1, 2);
    for (size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.uvs.emplace_back(mesh.positions[i].x, mesh.positions[i].z);
    const std::string count_text = text(mesh.positions.size(), ",");
    const std::string out = include_text(builder.model, builder.mesh(mesh, {checker}));
    EXPECT_EQ(count(out, "vertex_vectors{" + count_text), 1u);
    EXPECT_EQ(count(out, "normal_vectors{" + count_text), 1u);
    EXPECT_EQ(count(out, "uv_vectors{" + count_text), 1u);
    EXPECT_EQ(count(out, "_indices{"), 1u);
    EXPECT_EQ(count(include_text(builder.model, 1, {true, false}), "uv_"), 0u);
}

TEST(PovrayWriter, UvsOfACubesSidesAreSharedWithIndices) {
    Builder builder;
    Mesh mesh = shapes::cube();
    for (size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.uvs.emplace_back((i % 4) % 3 != 0, (i % 4) / 2);
    const uint32_t checker = builder.material(scenes::textured(scenes::checker()));
    const std::string out = include_text(builder.model, builder.mesh(mesh, {checker}));
    EXPECT_EQ(count(out, "vertex_vectors{8,"), 1u);
    EXPECT_EQ(count(out, "uv_vectors{4,"), 1u);
    EXPECT_EQ(count(out, "uv_indices{12,"), 1u);
    // Nothing looks them up: they would only be parsed.
    EXPECT_EQ(count(include_text(builder.model, builder.mesh(mesh)), "uv_"), 0u);
}

TEST(PovrayWriter, OnlySeveralLooksNeedATextureList) {
    Builder builder;
    const uint32_t red = builder.matte({1, 0, 0});
    const uint32_t blue = builder.matte({0, 0, 1});
    const std::string two = include_text(builder.model, builder.mesh(rich_sphere(1), {red, blue}));
    EXPECT_EQ(count(two, "texture_list{2,"), 1u);
    EXPECT_EQ(count(two, ">,1"), 40u);
    const std::string one = include_text(builder.model, builder.mesh(rich_sphere(1), {red, red}));
    EXPECT_EQ(count(one, "texture_list"), 0u);
    EXPECT_THROW(builder.mesh(rich_sphere(1), {red, 7}), std::exception);
}

TEST(PovrayWriter, TwoOccurrencesShareOneDeclarationAndEqualMeshesOneFile) {
    Builder builder;
    const ObjectIndex first = builder.mesh(shapes::cube());
    const ObjectIndex same = builder.mesh(shapes::cube());
    builder.place_at(first, {0, 0, 0});
    builder.place_at(first, {1, 0, 0});
    builder.place_at(same, {0, 1, 0});
    ExportOptions options;
    options.folder = scratch("sharing");
    Problems problems;
    const ExportReport report = scenes::write(builder.finish(), above(), options, problems);
    EXPECT_EQ(report.occurrences, 3u);
    EXPECT_EQ(report.representations, 1u);
    EXPECT_EQ(count(scene_text(options.folder), "#include"), 1u);
    EXPECT_EQ(count(scene_text(options.folder), "object{LDS_R_"), 3u);
    EXPECT_EQ(includes(options.folder).size(), 1u);
}

TEST(PovrayWriter, ASecondExportWritesNoRepresentationAgain) {
    Builder builder;
    builder.place(builder.mesh(shapes::cube()));
    builder.place(builder.primitive(Kind::Box, {}));
    ExportOptions options;
    options.folder = scratch("reuse");
    Problems problems;
    const Model& model = builder.finish();
    const ExportReport first = scenes::write(model, above(), options, problems);
    const auto file = includes(options.folder).at(0);
    const auto time = std::filesystem::last_write_time(file);
    const ExportReport second = scenes::write(model, above(), options, problems);
    EXPECT_EQ(first.written, 4u);
    EXPECT_EQ(second.written, 2u);  // scene.pov and scene.ini
    EXPECT_EQ(first.bytes, second.bytes);
    EXPECT_EQ(first.files, second.files);
    EXPECT_EQ(time, std::filesystem::last_write_time(file));
}

TEST(PovrayWriter, SameBytesFromOneThreadAndFromAll) {
    Builder builder;
    for (int i = 1; i <= 4; ++i)
        builder.place(builder.mesh(rich_sphere(i)));
    const Model& model = builder.finish();
    Problems problems;
    std::vector<std::string> bytes[2];
    for (const int threads : {0, 1}) {
        const ThreadLimit limit(threads);
        ExportOptions options;
        options.folder = scratch(text("threads", threads));
        scenes::write(model, above(), options, problems);
        bytes[threads].push_back(scene_text(options.folder));
        for (const auto& path : includes(options.folder))
            bytes[threads].push_back(path.filename().string() + read_file(path));
    }
    EXPECT_EQ(bytes[0].size(), 5u);
    EXPECT_EQ(bytes[0], bytes[1]);
}

TEST(PovrayWriter, ACompositeIsOneUnionAndOneOfASingleSolidIsNone) {
    Model model;
    model.materials = {Material{}, Material{}};
    model.materials[1].base_color = {1, 0, 0};
    const auto text_of = [&](std::vector<Solid> solids) {
        Representation level;
        level.summary.kind = Kind::Composite;
        level.materials = {0, 1};
        level.payload = std::make_shared<const Composite>(Composite{std::move(solids)});
        summarize(level, model);
        PictureWriter pictures({});
        MaskOutlines outlines;
        return representation_text(model, level, "LDS_R_0", {}, pictures, outlines, {});
    };
    Solid flat{false, {}, 1};
    flat.primitive.half_size.z = 0;
    const std::string two = text_of({{true, {}, 0}, {false, {}, 1}, flat});
    EXPECT_NE(two.find("#declare LDS_R_0 = union{\nbox{"), std::string::npos) << two;
    EXPECT_NE(two.find("sphere{"), std::string::npos);
    EXPECT_EQ(two.find("sphere{", two.find("sphere{") + 1), std::string::npos) << "one has no size";
    EXPECT_NE(text_of({{true, {}, 0}, flat}).find("#declare LDS_R_0 = box{"), std::string::npos);
    EXPECT_EQ(text_of({flat}), "");
}

TEST(PovrayWriter, NamesOfUsersNeverReachTheText) {
    const std::string evil = "a\"*/\n#error \"x\"\r}{<\xe5\x90\x8d>;'\\";
    Builder builder;
    builder.model.lights.push_back(scenes::sun(1));
    builder.model.lights[0].name = evil;
    Material material;
    material.name = evil;
    const ObjectIndex cube = builder.mesh(shapes::cube(), {builder.material(material)});
    builder.model.objects[cube].name = evil;
    builder.place(cube, {}, evil);
    View view = above();
    view.camera.name = evil;
    ExportOptions options;
    options.folder = scratch("names");
    Problems problems;
    scenes::write(builder.finish(), view, options, problems);
    const std::string text = scene_text(options.folder) + read_file(includes(options.folder)[0]);
    EXPECT_EQ(count(text, "#error"), 0u);
    EXPECT_EQ(count(text, "*/"), 0u);
    EXPECT_EQ(count(text, "\r"), 0u);
    EXPECT_EQ(count(text, "\""), 2u);  // of the one #include
    EXPECT_EQ(std::count_if(text.begin(), text.end(), [](char c) { return c < 0; }), 0);
    EXPECT_EQ(count(text, "// a____"), 1u);
}

TEST(PovrayWriter, NamesOfTenKilobytesAreCutShort) {
    Builder builder;
    builder.model.lights.push_back(scenes::sun(1));
    Material material;
    material.name = builder.model.lights[0].name = std::string(10'000, '/');
    const ObjectIndex cube = builder.mesh(shapes::cube(), {builder.material(material)});
    builder.model.objects[cube].name = std::string(10'000, '*');
    builder.place(cube, {}, std::string(10'000, '\n'));
    ExportOptions options;
    options.folder = scratch("lengthy");
    Problems problems;
    scenes::write(builder.finish(), above(), options, problems);
    const std::string text = scene_text(options.folder) + read_file(includes(options.folder)[0]);
    EXPECT_LT(text.size(), 6000u);
    EXPECT_EQ(count(text, std::string(60, '_')), 1u);
    EXPECT_EQ(count(text, std::string(61, '_')), 0u);
}

TEST(PovrayWriter, TrianglesWithoutAreaAreLeftOut) {
    Builder builder;
    Mesh mesh = shapes::quad(1, 1);
    mesh.positions.emplace_back(0.5f, 0.5f, 0.0f);
    mesh.positions.emplace_back(0.5f, 0.5f, 1e-9f);  // rounds to the vertex before it
    mesh.triangles.emplace_back(0, 0, 1);
    mesh.triangles.emplace_back(0, 2, 4);
    mesh.triangles.emplace_back(1, 4, 5);
    const std::string text = include_text(builder.model, builder.mesh(mesh));
    EXPECT_EQ(count(text, "face_indices{2,"), 1u);
    EXPECT_EQ(count(text, "vertex_vectors{4,"), 1u);

    mesh.triangles = {{0, 0, 1}, {0, 2, 4}};
    const ObjectIndex none = builder.mesh(mesh);
    EXPECT_EQ(include_text(builder.model, none), "");
    EXPECT_EQ(include_text(builder.model, builder.mesh(Mesh{})), "");
    builder.place(none);
    ExportOptions options;
    options.folder = scratch("degenerate");
    Problems problems;
    const ExportReport report = scenes::write(builder.finish(), above(), options, problems);
    EXPECT_EQ(report.occurrences, 0u);
    EXPECT_EQ(count(scene_text(options.folder), "#include"), 0u);
}

TEST(PovrayWriter, WhatIsNotFiniteIsRefused) {
    Builder builder;
    Mesh mesh = shapes::quad(1, 1);
    mesh.positions.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f);
    const ObjectIndex unused = builder.mesh(mesh);
    EXPECT_EQ(count(include_text(builder.model, unused), "vertex_vectors{4,"), 1u);
    mesh.triangles.emplace_back(0, 1, 4);
    const ObjectIndex used = builder.mesh(mesh);
    EXPECT_THROW(include_text(builder.model, used), Error);
    View view = above();
    view.camera.up.x = std::numeric_limits<double>::quiet_NaN();
    Problems problems;
    ExportOptions options;
    options.folder = scratch("infinite");
    EXPECT_THROW(export_scene(Model{}, {}, view, options, problems), Error);
    view.camera.up = view.camera.right;
    EXPECT_THROW(export_scene(Model{}, {}, view, options, problems), Error);
}

TEST(PovrayWriter, LinesAndDotsAreSkippedWithoutAWordAndSheetsGetAThickness) {
    Builder builder;
    const ObjectIndex cube = builder.mesh(shapes::cube());
    const auto scaled = [](double x, double y, double z) {
        return Affine{glm::dmat3(x, 0, 0, 0, y, 0, 0, 0, z), {}};
    };
    builder.place(cube, scaled(1, 0, 0), "line");
    builder.place(cube, scaled(0, 0, 0), "dot");
    builder.place(cube, scaled(1e-12, 1e-12, 1e-12), "speck");
    builder.place(cube, scaled(2, 0, 1), "sheet");
    builder.place(cube, scaled(1, 1e-3, 1), "plate");
    Affine broken;
    broken.offset.x = std::numeric_limits<double>::infinity();
    builder.place(cube, broken, "broken");
    ExportOptions options;
    options.folder = scratch("singular");
    Problems problems;
    const choose::Cut cut = choose::choose_cut(builder.finish(), above());
    export_scene(builder.model, cut, above(), options, problems);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].object, "broken");
    EXPECT_EQ(problems[0].code, "bad_transform");
    const std::string text = scene_text(options.folder);
    EXPECT_EQ(count(text, "matrix<2,0,0,0,2e-05,0,0,0,1,0,0,0>} // sheet"), 1u) << text;
    EXPECT_EQ(count(text, "matrix<1,0,0,0,0.001,0,0,0,1,0,0,0>} // plate"), 1u) << text;
}

TEST(PovrayWriter, ABlurredPictureCastsHalfTheRaysToALampFromEachSample) {
    Builder builder;
    builder.place(builder.mesh(shapes::cube()), {}, "cube");
    Light lamp;
    lamp.kind = LightKind::Area;
    lamp.position = {0, 0, 5};
    lamp.power = 100;
    lamp.edge_u = {4, 0, 0};
    lamp.edge_v = {0, 4, 0};
    builder.model.lights.push_back(lamp);
    const Model model = builder.finish();
    View view = above();
    view.camera.orthographic = false;
    ExportOptions options;
    options.folder = scratch("blurred");
    const auto rays = [&](Antialiasing antialiasing) {
        options.antialiasing = antialiasing;
        Problems problems;
        scenes::write(model, view, options, problems);
        const std::string text = scene_text(options.folder);
        const size_t end = text.find(" adaptive");
        return end == std::string::npos ? "none" : text.substr(end - 3, 14);
    };
    EXPECT_EQ(rays(Antialiasing::Final), "9,9 adaptive 0");
    view.camera.focus_distance = 5;
    view.camera.aperture = 0.1;
    EXPECT_EQ(rays(Antialiasing::Final), "5,5 adaptive 0");
    EXPECT_EQ(rays(Antialiasing::Reference), "9,9 adaptive 1");
    EXPECT_EQ(rays(Antialiasing::Off), "none");
}

TEST(PovrayWriter, CoveredOnlyLeavesOutEnvironmentLightsAndWorld) {
    Builder builder;
    builder.model.world.color = {1, 2, 3};
    builder.model.lights.push_back(scenes::sun(1));
    const ObjectIndex ground = builder.mesh(shapes::quad(9, 9));
    builder.model.objects[ground].role = ObjectRole::Environment;
    builder.place(ground, {}, "ground");
    builder.place(builder.mesh(shapes::cube()), {}, "cube");
    ExportOptions options;
    options.folder = scratch("covered");
    options.covered_only = true;
    Problems problems;
    const ExportReport report = scenes::write(builder.finish(), above(), options, problems);
    EXPECT_EQ(report.occurrences, 1u);
    EXPECT_EQ(count(scene_text(options.folder), "light_source"), 0u);
    EXPECT_EQ(count(scene_text(options.folder), "background{rgbt <0,0,0,1>}"), 1u);
    EXPECT_EQ(count(read_file(options.folder / "scene.ini"), "Output_Alpha=On"), 1u);
}

TEST(PovrayWriter, AnUnwritableFolderIsNamed) {
    const auto folder = scratch("unwritable");
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "file") << "x";
    ExportOptions options;
    options.folder = folder / "file" / "below";
    Problems problems;
    try {
        export_scene(Model{}, {}, above(), options, problems);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.status, Status::Io);
        EXPECT_NE(std::string(error.what()).find("file/below"), std::string::npos);
    }
}

TEST(PovrayWriter, ACancelledExportStops) {
    Builder builder;
    builder.place(builder.mesh(shapes::cube()));
    const volatile int32_t cancel = 1;
    ExportOptions options;
    options.folder = scratch("cancelled");
    Problems problems;
    const choose::Cut cut = choose::choose_cut(builder.finish(), above());
    EXPECT_THROW(export_scene(builder.model, cut, above(), options, problems,
                              Job(&cancel, nullptr, nullptr)),
                 Error);
    EXPECT_FALSE(std::filesystem::exists(options.folder / "scene.pov"));
}

TEST(PovrayWriter, GivenColorsPaintTheChosenOccurrencesInTheirOrder) {
    Builder builder;
    const ObjectIndex cube = builder.mesh(shapes::cube());
    builder.place_at(cube, {-1, 0, 0});
    builder.place_at(cube, {1, 0, 0});
    const choose::Cut cut = choose::choose_cut(builder.finish(), above());
    ExportOptions options;
    options.folder = scratch("given_colors");
    options.false_color = true;
    options.colors = {{.25, 0, 0}, {0, .00390625, .99609375}};
    Problems problems;
    // From elsewhere than the cut was made for.
    View overview = above();
    overview.camera.position = {3, 0, 20};
    export_scene(builder.model, cut, overview, options, problems);
    const std::string text = scene_text(options.folder);
    const size_t first = text.find("pigment{rgb <0.25,0,0>}");
    ASSERT_NE(first, std::string::npos);
    EXPECT_GT(text.find("pigment{rgb <0,0.00390625,0.996094>}"), first);
    EXPECT_EQ(count(text, "location <3,0,20>"), 1u);
    options.colors.pop_back();
    EXPECT_THROW(export_scene(builder.model, cut, overview, options, problems), Error);
}
