// SPDX-License-Identifier: GPL-3.0-or-later
// Guards which meshes with masks share a file, what is kept of them, and what they take together.
#include "base/findings_file.h"
#include "light/seen/seen_parts.h"
#include "povray/mask_cards.h"
#include "povray_export/scene/include_files.h"
#include "scenes/damaged_files.h"

#include <cstring>
#include <map>

using namespace lodestone;
using namespace lodestone::povray;
using scenes::Builder;

namespace {

/// Exports the meshes, in the same material, as they are and enlarged 8 times, which shows them
/// finer.
ExportReport exported(const std::vector<Mesh>& meshes, const Material& material,
                      const ExportOptions& options, Problems& problems) {
    Builder builder;
    const uint32_t index = builder.material(material);
    for (const Mesh& mesh : meshes) {
        const ObjectIndex object = builder.mesh(mesh, {index});
        builder.place(object, {glm::dmat3(8.0), {0, 0, 0}});
        builder.place(object, {glm::dmat3(1.0), {0, 0, 1}});
    }
    return scenes::write(builder.finish(), scenes::above(), options, problems);
}

ExportOptions fresh_folder(const char* name) {
    ExportOptions options;
    options.folder = own_scratch() / name;
    std::filesystem::remove_all(options.folder);
    return options;
}

/// The contents of all files below a folder.
std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
    std::map<std::string, std::string> out;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file())
            out[entry.path().lexically_relative(folder).string()] = read_file(entry.path());
    }
    return out;
}

/// What is exported into a new folder where findings are kept in another one.
std::map<std::string, std::string> exported_with(const std::filesystem::path& findings,
                                                 const Material& material) {
    Mesh blend = card();
    for (glm::vec2& uv : blend.uvs)
        uv = 0.4f * uv + 0.1f;
    ExportOptions options = fresh_folder("scene");
    options.bakes = findings;
    Problems problems;
    exported({card(), blend}, material, options, problems);
    return contents(options.folder);
}

}  // namespace

TEST(IncludeFiles, FarCopiesOfLeavesWereMoreTextThanTheySaved) {
    Problems problems;
    EXPECT_EQ(exported({card()}, leaf(disk(16)), fresh_folder("fine"), problems).representations,
              1u);
    // A pixel is four texels of the larger one, whose outline could be coarser.
    EXPECT_EQ(
        exported({card()}, leaf(disk(1024)), fresh_folder("coarse"), problems).representations, 1u);
    EXPECT_TRUE(problems.empty());
}

TEST(IncludeFiles, ASecondExportFindsWhatIsToBeCut) {
    const ExportOptions options = fresh_folder("again");
    Problems problems;
    const ExportReport first = exported({card()}, leaf(disk(16)), options, problems);
    EXPECT_GT(first.cut_triangles, 5u);
    EXPECT_LT(first.cut_triangles, 60u);
    const auto kept = [&] {
        std::vector<std::filesystem::path> found;
        for (const auto& entry : std::filesystem::directory_iterator(options.folder / "r")) {
            if (entry.path().extension() == ".cut")
                found.push_back(entry.path());
        }
        return found;
    };
    ASSERT_EQ(kept().size(), 1u);
    EXPECT_EQ(exported({card()}, leaf(disk(16)), options, problems).cut_triangles,
              first.cut_triangles);
    write_file(kept()[0], "1 77");
    EXPECT_EQ(exported({card()}, leaf(disk(16)), options, problems).cut_triangles, 77u);
    write_file(kept()[0], "what");
    EXPECT_EQ(exported({card()}, leaf(disk(16)), options, problems).cut_triangles,
              first.cut_triangles);
}

TEST(IncludeFiles, WhatIsKeptOfMasksChangesNothing) {
    const std::filesystem::path kept = own_scratch() / "kept";
    const std::filesystem::path file = kept / "masks.bin";
    std::filesystem::remove_all(kept);
    const Material material = leaf(disk(64));
    const std::map<std::string, std::string> wanted = exported_with("", material);
    EXPECT_TRUE(exported_with(kept, material) == wanted);
    ASSERT_TRUE(std::filesystem::exists(file));
    const std::string bytes = read_file(file);
    EXPECT_TRUE(exported_with(kept, material) == wanted);
    EXPECT_EQ(read_file(file), bytes);  // nothing was found anew
    PcgRandom random(3);
    for (int i = 0; i < 20; ++i) {
        write_file(file, hostile::mutated(bytes, random));
        EXPECT_TRUE(exported_with(kept, material) == wanted);
    }
}

TEST(IncludeFiles, KeptNonsenseAboutMasksIsFoundAnewOrHarmsNobody) {
    const std::filesystem::path kept = own_scratch() / "kept";
    const std::filesystem::path file = kept / "masks.bin";
    std::filesystem::remove_all(kept);
    const Material material = leaf(disk(64));
    const std::map<std::string, std::string> wanted = exported_with(kept, material);
    const std::string bytes = read_file(file);
    const auto change = [&](const std::function<std::string(std::string)>& other) {
        FindingsFile findings(file, bytes.substr(0, 8));
        // Behind the version, each finding is 16 bytes of head, of which the last four are its
        // size.
        size_t count = 0;
        for (size_t place = 8; place + 24 <= bytes.size(); ++count) {
            Hash key = 0;
            uint32_t size = 0;
            std::memcpy(&key, bytes.data() + place, sizeof key);
            std::memcpy(&size, bytes.data() + place + 12, sizeof size);
            findings.add(key, other(bytes.substr(place + 16, size)));
            place += 16 + size;
        }
        EXPECT_GT(count, 4u);
        findings.save();
    };
    change([](const std::string& one) { return one.substr(0, one.size() / 2); });
    EXPECT_TRUE(exported_with(kept, material) == wanted);
    change([](const std::string& one) { return one + one; });
    EXPECT_TRUE(exported_with(kept, material) == wanted);
    for (const char byte : {'\xff', '\0', '\x7f', '\x3f', '9'}) {
        change([&](const std::string& one) { return std::string(one.size(), byte); });
        EXPECT_NO_THROW(exported_with(kept, material));
    }
}

TEST(IncludeFiles, BakedPicturesAreKeptWhole) {
    const std::filesystem::path kept = own_scratch() / "kept";
    std::filesystem::remove_all(kept);
    const Material material = leaf(disk(64));
    const std::map<std::string, std::string> wanted = exported_with(kept, material);
    std::vector<std::filesystem::path> baked;
    for (const auto& entry : std::filesystem::directory_iterator(kept / "baked"))
        baked.push_back(entry.path());
    ASSERT_FALSE(baked.empty());
    for (const auto& path : baked)
        std::filesystem::last_write_time(path, {});
    EXPECT_TRUE(exported_with(kept, material) == wanted);
    for (const auto& path : baked) {
        EXPECT_NE(std::filesystem::last_write_time(path), std::filesystem::file_time_type{});
        write_file(path, "no picture");
    }
    EXPECT_TRUE(exported_with(kept, material) == wanted);
    for (const auto& path : baked)
        EXPECT_NE(read_file(path), "no picture");
}

TEST(IncludeFiles, CutOutMasksTookAnyMemory) {
    std::vector<Mesh> meshes(4);
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < 30 + i; ++k)
            append(meshes[static_cast<size_t>(i)], card(), {glm::dmat3(1.0), {0, 0, 0.01 * k}});
    }
    Problems problems;
    ExportOptions options = fresh_folder("all");
    const ExportReport all = exported(meshes, leaf(disk()), options, problems);
    EXPECT_GT(all.cut_triangles, 2000u);
    options.budget = 300'000;
    options.folder = fresh_folder("budget").folder;
    const ExportReport some = exported(meshes, leaf(disk()), options, problems);
    EXPECT_LT(some.cut_triangles * 245, options.budget * 9 / 8);
    EXPECT_GT(some.cut_triangles, 300u);
    EXPECT_LT(some.bytes, all.bytes);
    EXPECT_EQ(some.representations, all.representations);
}

TEST(IncludeFiles, BumpsOfOneFileForSeveralUsesWereNamedTwice) {
    Mesh ball = shapes::sphere(1, 3);
    for (const glm::vec3& at : ball.positions)
        ball.uvs.emplace_back(at.x, at.y * at.z);
    Material material = leaf(disk());
    material.bump_texture = scenes::checker();
    material.bump_distance = 0.1;
    Problems problems;
    exported({ball}, material, fresh_folder("bumps"), problems);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].code, "bump_not_flat");
}

TEST(IncludeFiles, WhatCastsShadowsAloneHadALook) {
    // A ball behind the eye, and one in view: a sun is behind it.
    Builder builder;
    Mesh ball = shapes::sphere(1, 3);
    for (const glm::vec3& at : ball.positions)
        ball.uvs.emplace_back(at.x, at.y);
    const uint32_t painted = builder.material(scenes::textured(scenes::checker()));
    const ObjectIndex seen = builder.mesh(card(), {painted});
    const ObjectIndex behind = builder.mesh(ball, {painted});
    builder.place_at(seen, {0, 0, 0});
    builder.place_at(behind, {0, 0, 40});
    builder.model.lights = {scenes::sun(1)};
    View view = scenes::above();
    view.pixel_error = 1;
    const auto text_of = [&](OffScreen off_screen, const char* name) {
        view.modifiers.off_screen = off_screen;
        const ExportOptions options = fresh_folder(name);
        Problems problems;
        scenes::write(builder.finish(), view, options, problems);
        std::string all;
        for (const auto& entry : std::filesystem::directory_iterator(options.folder / "r"))
            all += entry.path().extension() == ".inc" ? read_file(entry.path()) : "";
        return all;
    };
    EXPECT_NE(text_of(OffScreen::Full, "looks").find("normal_vectors"), std::string::npos);
    const std::string shadows = text_of(OffScreen::Reflected, "shadows");
    EXPECT_EQ(shadows.find("normal_vectors"), std::string::npos);
    EXPECT_NE(shadows.find("image_map"), std::string::npos);  // of what is seen
    builder.place_at(behind, {1.5, 0, 0});
    // Then it has its look where it is seen, and no second file without.
    const std::string both = text_of(OffScreen::Reflected, "both");
    EXPECT_NE(both.find("normal_vectors"), std::string::npos);
    EXPECT_EQ(both.find("mesh2", both.find("mesh2", both.find("mesh2") + 1) + 1),
              std::string::npos);
}

// A picture of a large ellipsoid, half of which it did not show, ended with an error.
TEST(IncludeFiles, AShadedEllipsoidIsWrittenWhole) {
    Builder builder;
    const ObjectIndex ball =
        builder.primitive(Kind::Ellipsoid, Primitive{}, {builder.matte({1, 1, 1})});
    const Model& model = builder.finish();
    const Representation& representation = model.objects[ball].representations[0];
    auto shares = std::make_shared<light::SkyShares>();
    shares->corners.assign(3 * light::drawn_triangles(representation), 255);
    const ExportOptions options = fresh_folder("ellipsoid");
    std::filesystem::create_directories(options.folder / "r");
    IncludeFiles files(model, options.folder, options.folder);
    std::vector<uint8_t> needed(tessellated(representation).triangles.size(), 0);
    needed[0] = light::kSeen;
    files.add(representation, {.sky = sky_light(1, shares, {}, {}, glm::dvec3(1.0))}, 1, needed);
    files.name(0, 0, {});
    files.write({});
    size_t found = 0;
    for (const auto& [name, text] : contents(options.folder))
        found += text.find("face_indices{1280,") != std::string::npos ? 1 : 0;
    EXPECT_EQ(found, 1u);
}
