// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the textures of a mesh's corners: POV-Ray keeps each of them, so there are not too many.
#include "povray/povray_scenes.h"
#include "povray_export/scene/representation_writer.h"

using namespace lodestone;
using namespace lodestone::povray;
using scenes::Builder;

TEST(MeshTextures, ManyVertexColorsAreRoundedToAFewThousand) {
    Builder builder;
    Mesh mesh = shapes::terrain(128);
    for (size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.colors.emplace_back(float(i % 128) / 128.0F, float(i) / 16384.0F,
                                 float(i * 37 % 101) / 101.0F, 1);
    Material material = scenes::textured({});
    material.vertex_colors = true;
    const ObjectIndex object = builder.mesh(mesh, {builder.material(material)});
    PictureWriter pictures;
    MaskOutlines outlines;
    const std::string text =
        representation_text(builder.model, builder.model.objects[object].representations[0], "X",
                            {}, pictures, outlines, {});
    const size_t at = text.find("texture_list{");
    ASSERT_NE(at, std::string::npos);
    const int textures = std::stoi(text.substr(at + 13));
    EXPECT_LE(textures, 4096);
    EXPECT_GT(textures, 500);
}
