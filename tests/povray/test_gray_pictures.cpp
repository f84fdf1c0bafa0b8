// SPDX-License-Identifier: GPL-3.0-or-later
// Guards pictures of gray with alpha: they are what the same numbers in colors are.
#include "povray/povray_scenes.h"

using namespace lodestone;
using namespace lodestone::povray;
using scenes::above;
using scenes::Builder;

// Streams are white in Cycles of Blender 3.4, which divides such files by their alpha.
TEST(PovrayGrayPictures, APictureOfGrayAndAlphaShowsWhatOneOfColorsAndAlphaDoes) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    // 2 x 2: gray 1 of an alpha of 30/255, gray 128/255 of alpha 1; the other way round.
    constexpr unsigned char kGray[] = {
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
        0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x04, 0x00, 0x00, 0x00, 0xd8,
        0xbf, 0xc5, 0xaf, 0x00, 0x00, 0x00, 0x12, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0xf8,
        0x2f, 0xd7, 0xf0, 0x9f, 0xa1, 0xe1, 0xff, 0x7f, 0x39, 0x00, 0x1a, 0x84, 0x05, 0x39, 0x72,
        0xac, 0x48, 0x22, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    const double half = 128 / 255.0;
    const double clear = 30 / 255.0;
    const std::string bytes(reinterpret_cast<const char*>(kGray), sizeof kGray);
    Texture pair[2];
    pair[0].picture = image::make_picture(bytes, ColorSpace::Linear, "gray");
    pair[1].picture = scenes::picture(
        2, {{1, 1, 1, clear}, {half, half, half, 1}, {half, half, half, 1}, {1, 1, 1, clear}});
    Mesh mesh = shapes::quad(0.875F, 0.875F);
    for (const glm::vec3& at : mesh.positions)
        mesh.uvs.emplace_back(4 * at.x - 1.25F, 4 * at.y - 1.25F);
    scenes::Image seen[2];
    for (int i = 0; i < 2; ++i) {
        Material material = scenes::textured(pair[i]);
        material.alpha_texture = pair[i];
        material.alpha_mode = AlphaMode::Blend;
        Builder builder;
        builder.model.world.color = {0.2, 0.4, 0.9};
        builder.place(builder.mesh(mesh, {builder.material(material)}));
        ExportOptions options;
        options.folder = scratch(i == 0 ? "gray_alpha" : "color_alpha");
        options.antialiasing = Antialiasing::Off;
        seen[i] = scenes::render(builder.finish(), above(), options);
    }
    ASSERT_EQ(seen[0].values.size(), seen[1].values.size());
    double least = 1;
    double most = 0;
    for (size_t i = 0; i < seen[0].values.size(); ++i) {
        EXPECT_NEAR(seen[0].values[i], seen[1].values[i], 0.005) << i;
        least = std::min(least, seen[0].values[i]);
        most = std::max(most, seen[0].values[i]);
    }
    EXPECT_LT(least, 0.25);  // through the clear texels the background is seen, no lamp
    EXPECT_LT(most, 1);
}
