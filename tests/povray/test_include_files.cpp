// SPDX-License-Identifier: GPL-3.0-or-later
// Guards which meshes with masks share a file, what is kept of them, and what they take together.
#include "povray/mask_cards.h"

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
    builder.place_at(behind, {2, 0, 0});
    // Then it has its look where it is seen, and no second file without.
    const std::string both = text_of(OffScreen::Reflected, "both");
    EXPECT_NE(both.find("normal_vectors"), std::string::npos);
    EXPECT_EQ(both.find("mesh2", both.find("mesh2", both.find("mesh2") + 1) + 1),
              std::string::npos);
}
