// SPDX-License-Identifier: GPL-3.0-or-later
// Guards cut-out masks: what is cut, its area and attributes, and that pictures stay.
#include "povray/mask_cards.h"
#include "povray_export/mesh/mesh_cutting.h"
#include "povray_export/mesh/triangle_cutter.h"

#include <limits>

using namespace lodestone;
using namespace lodestone::povray;
using scenes::Builder;

TEST(MeshCutting, WhatHasNoMaskIsNotCut) {
    EXPECT_FALSE(cut({}, leaf(disk())).any);
    EXPECT_FALSE(cut(shapes::quad(1, 1), leaf(disk())).any);  // no texture coordinates
    Material opaque = leaf(disk());
    opaque.alpha_mode = AlphaMode::Opaque;
    EXPECT_FALSE(cut(card(), opaque).any);
    Material glass = leaf(disk());
    glass.transmission = 0.5;
    EXPECT_FALSE(cut(card(), glass).any);
    Material mixed = leaf(disk());
    mixed.other = std::make_shared<const Material>();
    EXPECT_FALSE(cut(card(), mixed).any);
    const Texture blend = alpha_of(64, [](double u, double) { return u; });
    EXPECT_FALSE(cut(card(), leaf(blend)).any);
    Mesh clear = card();
    clear.colors.assign(4, {1, 1, 1, 0.5});
    Material painted = leaf(disk());
    painted.vertex_colors = true;
    EXPECT_EQ(cut(clear, painted).opaque,
              std::vector<uint8_t>{0});  // only what is clear is cut off
    clear.colors.assign(4, {1, 0, 1, 1});
    EXPECT_EQ(cut(clear, painted).opaque, std::vector<uint8_t>{1});
}

TEST(MeshCutting, ADiskHasItsAreaWithinATexelOfItsOutline) {
    const CutMesh found = cut(card(), leaf(disk()));
    ASSERT_TRUE(found.any);
    EXPECT_EQ(found.opaque, std::vector<uint8_t>{1});
    EXPECT_NEAR(surface_area(found.mesh), kPi * 0.09, 0.002);
    EXPECT_LT(found.mesh.triangles.size(), 60u);
    ASSERT_EQ(found.sources.size(), found.mesh.triangles.size());
    for (const Triangle& t : found.mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const glm::vec3& at = found.mesh.positions[t[k]];
            EXPECT_LE(std::hypot(at.x - 0.5, at.y - 0.5), 0.3 + 1.0 / 64);
        }
    }
    EXPECT_GT(area_vector(found.mesh, 0).z, 0);
}

TEST(MeshCutting, NewCornersAreInterpolated) {
    Mesh mesh = card();
    mesh.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 1}};
    mesh.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {0.5, 0.5, 0.5, 1}};
    const CutMesh found = cut(mesh, leaf(disk()));
    ASSERT_TRUE(found.any);
    ASSERT_EQ(found.mesh.normals.size(), found.mesh.positions.size());
    ASSERT_EQ(found.mesh.colors.size(), found.mesh.positions.size());
    for (size_t i = 0; i < found.mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[found.sources[i]];
        const glm::vec3 a = mesh.positions[t.y] - mesh.positions[t.x];
        const glm::vec3 b = mesh.positions[t.z] - mesh.positions[t.x];
        for (int k = 0; k < 3; ++k) {
            const uint32_t vertex = found.mesh.triangles[i][k];
            const glm::vec3 at = found.mesh.positions[vertex] - mesh.positions[t.x];
            const float twice = a.x * b.y - a.y * b.x;
            const float y = (at.x * b.y - at.y * b.x) / twice;
            const float z = (a.x * at.y - a.y * at.x) / twice;
            const glm::vec4 color =
                (1 - y - z) * mesh.colors[t.x] + y * mesh.colors[t.y] + z * mesh.colors[t.z];
            EXPECT_NEAR(glm::length(color - found.mesh.colors[vertex]), 0, 1e-5);
            EXPECT_NEAR(glm::length(found.mesh.normals[vertex]), 1, 1e-5);
            EXPECT_NEAR(found.mesh.uvs[vertex].x, found.mesh.positions[vertex].x, 1e-6);
        }
    }
}

TEST(MeshCutting, RepeatedMirroredShiftedAndTurnedPicturesHaveTheSameArea) {
    for (const TextureExtension extension : {TextureExtension::Repeat, TextureExtension::Mirror}) {
        for (const double times : {2.0, -3.0, 4.0}) {
            Texture texture = disk();
            texture.extension = extension;
            EXPECT_NEAR(surface_area(cut(card(times), leaf(texture)).mesh), kPi * 0.09, 0.003);
            // Whole pictures, wherever they begin.
            texture.to_picture = {1, 0, 0.3, 0, 1, -7.6};
            const double again =
                extension == TextureExtension::Repeat || times == 2.0 || times == 4.0
                    ? kPi * 0.09
                    : surface_area(cut(card(times), leaf(texture)).mesh);
            EXPECT_NEAR(surface_area(cut(card(times), leaf(texture)).mesh), again, 0.003);
        }
        Texture turned = disk();
        turned.extension = extension;
        turned.to_picture = {0, 1, 0, -1, 0, 1};
        EXPECT_NEAR(surface_area(cut(card(), leaf(turned)).mesh), kPi * 0.09, 0.002);
    }
}

TEST(MeshCutting, RaysWentThroughTreesOfLeavesWithTwoSides) {
    Mesh mesh = card();
    mesh.normals.assign(4, {0, 0, 1});
    Mesh back = mesh;
    back.normals.assign(4, {0, 0, -1});
    for (Triangle& t : back.triangles)
        t = {t.z, t.y, t.x};
    append(mesh, back, {});
    EXPECT_EQ(cut(mesh, leaf(disk())).mesh.triangles.size(),
              cut(card(), leaf(disk())).mesh.triangles.size());
    for (size_t i = 4; i < 8; ++i)  // something else is on its back
        mesh.uvs[i].x = 1 - mesh.uvs[i].x;
    EXPECT_FALSE(cut(mesh, leaf(disk())).any);
}

TEST(MeshCutting, BesideAClippedPictureThereIsNothing) {
    Texture texture = disk();
    texture.extension = TextureExtension::Clip;
    EXPECT_NEAR(surface_area(cut(card(2), leaf(texture)).mesh), kPi * 0.09 / 4, 0.001);
    texture.extension = TextureExtension::Extend;
    EXPECT_FALSE(cut(card(2), leaf(texture)).any);
    EXPECT_TRUE(cut(card(1), leaf(texture)).any);
}

TEST(MeshCutting, TrianglesThatShowOnePlaceAreThereOrNot) {
    Mesh mesh = card();
    mesh.uvs.assign(4, {0.5, 0.5});
    Texture texture = disk();
    EXPECT_EQ(cut(mesh, leaf(texture)).mesh.triangles.size(), 2u);
    mesh.uvs.assign(4, {0.05, 0.05});
    const CutMesh none = cut(mesh, leaf(texture));
    EXPECT_TRUE(none.any);
    EXPECT_TRUE(none.mesh.triangles.empty());
    mesh.uvs = {{0.4, 0.5}, {0.5, 0.5}, {0.6, 0.5}, {0.45, 0.5}};  // a line
    EXPECT_EQ(cut(mesh, leaf(texture)).mesh.triangles.size(), 2u);
}

TEST(MeshCutting, TrianglesThatShowALineWereThereOrNot) {
    // Both triangles show the picture's middle row from left to right, the disk's 0.6 of it.
    Mesh mesh = card(2);
    for (glm::vec2& uv : mesh.uvs)
        uv.y = 0.5;
    for (const TextureExtension extension : {TextureExtension::Repeat, TextureExtension::Mirror}) {
        Texture texture = disk();
        texture.extension = extension;
        const CutMesh found = cut(mesh, leaf(texture));
        EXPECT_NEAR(surface_area(found.mesh), 0.6, 0.01);
        for (const glm::vec2& uv : found.mesh.uvs)
            EXPECT_FLOAT_EQ(uv.y, 0.5f);
    }
    // What is half clear keeps all that is not, though its middle is.
    const Texture rings = alpha_of(64, [](double u, double v) {
        return 0.7 - 5 * std::abs(std::hypot(u - 0.5, v - 0.5) - 0.25);
    });
    const double left = surface_area(cut(mesh, leaf(rings)).mesh);
    EXPECT_GT(left, 0.5);
    EXPECT_LT(left, 0.95);
}

TEST(MeshCutting, AThinTriangleOverManyPicturesTookTheSquareOfTheirNumber) {
    const Texture dots = alpha_of(512, [](double u, double v) {
        return 0.5 + 8 -
               512 *
                   std::hypot(std::fmod(u, 1.0 / 16) - 1.0 / 32, std::fmod(v, 1.0 / 16) - 1.0 / 32);
    });
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    mesh.uvs = {{0.1, 0.2}, {170.1, 170.4}, {170.15, 170.5}};
    const CutMesh found = cut(mesh, leaf(dots));
    ASSERT_TRUE(found.any);
    EXPECT_NEAR(surface_area(found.mesh), dots.picture->mean.w / 2, 0.02);

    const Material material = leaf(disk());
    MaskOutlines outlines;
    image::SeenTexels seen = image::unseen_texels(64, 64);
    std::fill(seen.blocks.begin(), seen.blocks.end(), uint8_t{1});
    const MaskOutlinePtr outline = outlines.outline({material.alpha_texture, {}, seen, 1}, {});
    const volatile int32_t cancel = 1;
    const Job job(&cancel, nullptr, nullptr);
    TriangleCutter cutter(*outline, material.alpha_texture, job);
    EXPECT_THROW(cutter.cut({{0, 0}, {170, 170}, {170, 171}}, 1000), Error);
}

TEST(MeshCutting, AFullMaskIsOpaqueAsItIs) {
    const Texture texture = alpha_of(8, [](double, double) { return 1; });
    const CutMesh found = cut(card(), leaf(texture));
    EXPECT_TRUE(found.any);
    EXPECT_EQ(found.mesh.triangles.size(), 2u);
    EXPECT_EQ(found.mesh.positions.size(), 4u);
    const Texture dot = alpha_of(1, [](double, double) { return 1; });
    EXPECT_EQ(cut(card(), leaf(dot)).mesh.triangles.size(), 2u);
}

TEST(MeshCutting, ACutoffIsKeptAndAnAreaToo) {
    // A cone: at its cutoff it is a disk, whatever 95 % of the texels say.
    const Texture cone =
        alpha_of(64, [](double u, double v) { return 1 - 2 * std::hypot(u - 0.5, v - 0.5); });
    Material material = leaf(cone);
    EXPECT_FALSE(cut(card(), material).any);
    material.alpha_mode = AlphaMode::Clip;
    for (const double cutoff : {0.25, 0.5, 0.75}) {
        material.alpha_cutoff = cutoff;
        EXPECT_NEAR(surface_area(cut(card(), material).mesh),
                    kPi * 0.25 * (1 - cutoff) * (1 - cutoff), 0.01)
            << cutoff;
    }
    // Small dots: half of their alpha is in texels that are half there.
    const Texture dots = alpha_of(256, [](double u, double v) {
        return std::fmod(256 * u, 32) < 1.5 && std::fmod(256 * v, 32) < 1.5 ? 1 : 0;
    });
    const double covered = surface_area(cut(card(), leaf(dots)).mesh);
    EXPECT_NEAR(covered * 65536, dots.picture->mean.w * 65536, 0.1 * dots.picture->mean.w * 65536);
}

TEST(MeshCutting, CoarserIsFewerCornersOfTheSameArea) {
    const Texture texture = alpha_of(256, [](double u, double v) {
        const double angle = std::atan2(v - 0.5, u - 0.5);
        return 0.5 + (0.3 + 0.02 * std::sin(40 * angle) - std::hypot(u - 0.5, v - 0.5)) * 256;
    });
    size_t before = ~size_t{0};
    for (const int exponent : {-10, -6, -4}) {
        const CutMesh found = cut(card(), leaf(texture), exponent);
        EXPECT_LT(found.mesh.triangles.size(), before);
        before = found.mesh.triangles.size();
        EXPECT_NEAR(surface_area(found.mesh), texture.picture->mean.w,
                    exponent > -6 ? 0.02 : 0.004);
    }
    EXPECT_LT(before, 40u);
}

TEST(MeshCutting, ABlendLosesWhatIsClearAndNothingElse) {
    // A soft puff of smoke; beyond its radius of 0.25 all is clear.
    const Texture puff = alpha_of(128, [](double u, double v) {
        return std::max(0.0, 0.7 - 2.8 * std::hypot(u - 0.5, v - 0.5));
    });
    for (const double times : {1.0, 3.0}) {
        const Mesh mesh = card(times);
        const CutMesh found = cut(mesh, leaf(puff));
        ASSERT_TRUE(found.any);
        EXPECT_EQ(found.opaque, std::vector<uint8_t>{0});
        const double area = surface_area(found.mesh);
        EXPECT_LT(area, 0.45);
        EXPECT_GT(area, kPi * 0.25 * 0.25);
        // Every place that is not clear is in a triangle that is left.
        const image::TextureSampler sampler(puff, glm::dvec3(0.0));
        for (double x = 0.005; x < 1; x += 0.01) {
            for (double y = 0.005; y < 1; y += 0.01) {
                if (sampler.number({times * x, times * y}) <= 0)
                    continue;
                EXPECT_TRUE(std::any_of(
                    found.mesh.triangles.begin(), found.mesh.triangles.end(),
                    [&](const Triangle& t) {
                        const auto side = [&](uint32_t i, uint32_t j) {
                            const glm::dvec3 a(found.mesh.positions[i]);
                            const glm::dvec3 b(found.mesh.positions[j]);
                            return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x) >= -1e-6;
                        };
                        return side(t.x, t.y) && side(t.y, t.z) && side(t.z, t.x);
                    }))
                    << x << ' ' << y;
            }
        }
    }
}

/// Cards behind each other, `count` in a metre.
Mesh stack(int count) {
    Mesh mesh;
    for (int i = 0; i < count; ++i)
        append(mesh, card(), {glm::dmat3(1.0), {0, 0, static_cast<double>(i) / count}});
    return mesh;
}

TEST(MeshCutting, AStackOfMoreBlendsThanPovrayBearsIsCut) {
    const Texture puff =
        alpha_of(64, [](double u, double v) { return 0.7 - 1.4 * std::hypot(u - 0.5, v - 0.5); });
    EXPECT_NE(cut(stack(100), leaf(puff)).opaque, std::vector<uint8_t>{1});
    const CutMesh found = cut(stack(700), leaf(puff));
    EXPECT_EQ(found.opaque, std::vector<uint8_t>{1});
    EXPECT_NEAR(surface_area(found.mesh) / 700, puff.picture->mean.w, 0.02);
}

TEST(PovrayRenderMasks, AStackThatEndedPovrayIsDrawnOrItsNameTold) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    // Masks, then glass that is clear everywhere, which nothing can cut.
    for (const bool mask : {true, false}) {
        Material material = leaf(disk());
        if (!mask) {
            material.alpha_texture = {};
            material.alpha = 0.001;
        }
        Builder builder;
        builder.model.lights.push_back(scenes::sun(kPi));
        builder.place(builder.mesh(stack(600), {builder.material(material)}),
                      {glm::dmat3(1.0), {-0.5, -0.5, 0}}, "pile");
        const Model& model = builder.finish();
        ExportOptions options;
        options.folder = own_scratch() / (mask ? "mask" : "glass");
        options.antialiasing = Antialiasing::Off;
        Problems problems;
        scenes::write(model, scenes::above(16, 16), options, problems);
        EXPECT_EQ(problems.empty(), mask);
        RunOptions how;
        how.folder = options.folder;
        how.threads = 1;
        try {
            render_scene(how);
            EXPECT_TRUE(mask);
        } catch (const Error& error) {
            EXPECT_FALSE(mask);
            EXPECT_NE(std::string(error.what()).find("'pile' has about"), std::string::npos)
                << error.what();
        }
    }
}

TEST(MeshCutting, NoiseNetsAndHugeTilingsKeepTheirTextures) {
    const Texture noise = alpha_of(256, [](double u, double v) {
        return std::fmod(std::abs(std::sin(u * 9871 + v * 3571) * 43758.5), 1.0) < 0.5 ? 1 : 0;
    });
    EXPECT_FALSE(cut(card(), leaf(noise)).any);
    EXPECT_FALSE(cut(card(500), leaf(disk())).any);
    EXPECT_FALSE(cut(card(1e5), leaf(disk())).any);
}

TEST(MeshCutting, ACrowdOfFineLeavesTookTenTimesAsLongThroughTheirTextures) {
    // A comb of 72 fine teeth on each of 300 pictures: more triangles than pay.
    const Texture comb = alpha_of(512, [](double u, double v) {
        const double wide = 0.3 * v;
        return u < 0.9 && std::abs(std::fmod(80 * u, 1.0) - 0.5) < wide && v < 0.95 ? 1 : 0;
    });
    Mesh mesh;
    for (int i = 0; i < 300; ++i)
        append(mesh, card(), {glm::dmat3(1.0), {0, 0, 0.1 * i}});
    const CutMesh found = cut(mesh, leaf(comb));
    EXPECT_EQ(found.opaque, std::vector<uint8_t>{1});
    EXPECT_LT(found.mesh.triangles.size(), 64u * mesh.triangles.size());
    EXPECT_NEAR(surface_area(found.mesh) / 300, comb.picture->mean.w, 0.1 * comb.picture->mean.w);
    // At full detail it is a texture, or as fine as it is seen.
    const CutMesh fine = cut(mesh, leaf(comb), {}, false);
    EXPECT_NE(fine.opaque, std::vector<uint8_t>{1});
    // A fence repeats its picture, and is looked through.
    EXPECT_NE(cut(card(20), leaf(comb)).opaque, std::vector<uint8_t>{1});
    // One alone is cut as finely as it is seen.
    EXPECT_GT(cut(card(), leaf(comb)).mesh.triangles.size(), found.mesh.triangles.size() / 300);
}

TEST(MeshCutting, HostileCoordinatesAreNotCut) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity(), 1e30f, -1e9f}) {
        Mesh mesh = card();
        mesh.uvs[2].x = bad;
        EXPECT_FALSE(cut(mesh, leaf(disk())).any);
    }
    Texture texture = disk();
    texture.to_picture.fill(std::nan(""));
    EXPECT_FALSE(cut(card(), leaf(texture)).any);
    texture.to_picture.fill(0);
    EXPECT_TRUE(cut(card(), leaf(texture)).any);
}

TEST(MeshCutting, OtherSlotsKeepTheirTriangles) {
    Mesh mesh = card();
    mesh.slots = {3, 1};
    Builder builder;
    const uint32_t plain = builder.matte({1, 0, 0});
    const uint32_t mask = builder.material(leaf(disk()));
    const ObjectIndex object = builder.mesh(mesh, {plain, plain, plain, mask});
    MaskOutlines outlines;
    const CutMesh found = cut_masks(builder.model, builder.model.objects[object].representations[0],
                                    {}, outlines, {});
    ASSERT_TRUE(found.any);
    EXPECT_EQ(found.opaque, (std::vector<uint8_t>{0, 0, 0, 1}));
    EXPECT_EQ(found.mesh.triangles[0], mesh.triangles[1]);
    EXPECT_EQ(found.mesh.slots[0], 1);
    EXPECT_EQ(found.mesh.slots[1], 3);
    EXPECT_NEAR(surface_area(found.mesh), 0.5 + kPi * 0.045, 0.001);
}

TEST(MeshCutting, AnExportOutlinesAPictureOnce) {
    MaskOutlines outlines;
    const Texture texture = disk();
    image::SeenTexels seen = image::unseen_texels(64, 64);
    std::fill(seen.blocks.begin(), seen.blocks.end(), uint8_t{1});
    const MaskOutlinePtr first = outlines.outline({texture, {}, seen, 1}, {});
    ASSERT_NE(first, nullptr);
    EXPECT_EQ(outlines.outline({texture, {}, seen, 1.2}, {}), first);
    EXPECT_NE(outlines.outline({texture, {}, seen, 4}, {}), first);
    EXPECT_EQ(outlines.texels(texture), outlines.texels(texture));
}

TEST(PovrayRenderMasks, CutOutCardsLookAsTheirTextures) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    // A wavy flower, twice across, over a floor that takes its shadow; beside it the same through a
    // material that is not cut, since its alpha is mixed with itself.
    const Texture texture = alpha_of(128, [](double u, double v) {
        const double angle = std::atan2(v - 0.5, u - 0.5);
        return 0.5 + (0.35 + 0.08 * std::sin(5 * angle) - std::hypot(u - 0.5, v - 0.5)) * 128;
    });
    scenes::Image images[2];
    for (const bool whole : {false, true}) {
        Material material = leaf(texture);
        material.base_color_texture.channel = TextureChannel::Color;
        if (whole) {
            auto other = std::make_shared<Material>(material);
            material.other = other;
            material.mix = 0.5;
        }
        Builder builder;
        builder.model.world.color = glm::dvec3(0.2);
        builder.model.lights.push_back(scenes::sun(kPi, {0.5, 0, -1}));
        Mesh floor = shapes::quad(4, 4);
        builder.place_at(builder.mesh(floor, {builder.matte({0.7, 0.7, 0.7})}), {-2, -2, -0.5});
        builder.place_at(builder.mesh(card(2), {builder.material(material)}), {-0.5, -0.5, 0});
        ExportOptions options;
        options.folder = own_scratch() / (whole ? "whole" : "cut");
        images[whole ? 1 : 0] = scenes::render(builder.finish(), scenes::above(64, 64), options);
        EXPECT_EQ(std::filesystem::exists(options.folder / "i"), true);
    }
    double sum = 0;
    double mean[2] = {0, 0};
    for (size_t i = 0; i < images[0].values.size(); ++i) {
        sum += std::abs(images[0].values[i] - images[1].values[i]);
        mean[0] += images[0].values[i];
        mean[1] += images[1].values[i];
    }
    const auto count = static_cast<double>(images[0].values.size());
    EXPECT_LT(sum / count, 0.01);
    EXPECT_NEAR(mean[0] / count, mean[1] / count, 0.003);
    EXPECT_GT(mean[0] / count, 0.1);
}

TEST(MeshCutting, WhatIsNotShownIsLeftOut) {
    // A card with a mask and one without, of which one triangle each is shown.
    Builder builder;
    Mesh mesh = card();
    append(mesh, card(), Affine{glm::dmat3(1.0), {2, 0, 0}});
    mesh.slots = {0, 0, 1, 1};
    const ObjectIndex object =
        builder.mesh(mesh, {builder.material(leaf(disk())), builder.matte(glm::dvec3(0.5))});
    MaskOutlines outlines;
    const auto found = [&](const std::vector<uint8_t>& shown) {
        RepresentationOptions options;
        options.shown = std::make_shared<const ShownTriangles>(ShownTriangles{shown, 1});
        return cut_masks(builder.model, builder.model.objects[object].representations[0], options,
                         outlines, {});
    };
    const CutMesh half = found({1, 0, 0, 1});
    ASSERT_TRUE(half.any);
    EXPECT_NEAR(surface_area(half.mesh), kPi * 0.09 / 2 + 0.5, 0.002);
    EXPECT_EQ(std::count(half.sources.begin(), half.sources.end(), 3u), 1);
    for (const uint32_t source : half.sources)
        EXPECT_TRUE(source == 0 || source == 3) << source;
    const CutMesh plain = found({0, 0, 1, 1});  // nothing to cut
    ASSERT_TRUE(plain.any);
    EXPECT_EQ(plain.sources, (std::vector<uint32_t>{2, 3}));
    EXPECT_TRUE(found({0, 0, 0, 0}).mesh.triangles.empty());
}
