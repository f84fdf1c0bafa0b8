// SPDX-License-Identifier: GPL-3.0-or-later
// Guards how finely the masks of a crowd are outlined.
#include "povray/mask_cards.h"

using namespace lodestone;
using namespace lodestone::povray;

namespace {

Texture flower_mask() {
    return alpha_of(256, [](double u, double v) {
        const double x = u - 0.5;
        const double y = v - 0.5;
        const double edge = 0.35 + 0.06 * std::sin(9 * std::atan2(y, x));
        return std::hypot(x, y) < edge ? 1 : 0;
    });
}

Texture ring_mask() {
    return alpha_of(64, [](double u, double v) {
        const double out = std::hypot(u - 0.5, v - 0.5);
        return out < 0.45 && out > 0.2 ? 1 : 0;
    });
}

/// Cards of one metre, one above the other.
Mesh cards(int count) {
    Mesh mesh;
    for (int i = 0; i < count; ++i)
        append(mesh, card(), {glm::dmat3(1.0), {0, 0, 0.1 * i}});
    return mesh;
}

}  // namespace

// Trees some pixels large became more triangles than the picture had pixels.
TEST(CutPlan, ACrowdIsCutHalfAsFinely) {
    const Texture flower = flower_mask();
    const auto each = [&](int count, std::optional<int> outline) {
        const CutMesh found = cut(cards(count), leaf(flower), outline);
        EXPECT_NEAR(surface_area(found.mesh) / count, flower.picture->mean.w,
                    0.03 * flower.picture->mean.w);
        return static_cast<double>(found.mesh.triangles.size()) / count;
    };
    const int outline = outline_step(4.0 / 256);  // four texels of a card of one metre
    EXPECT_LT(each(32, outline), 0.8 * each(31, outline));
    EXPECT_EQ(each(32, outline), each(31, outline_step(8.0 / 256)));
    // Texels are the finest that anybody sees.
    EXPECT_EQ(each(32, {}), each(31, {}));
    EXPECT_EQ(each(32, outline_step(0.4 / 256)), each(31, {}));
}

// Trees with a trunk on the picture of their leaves had all leaves cut by single texels.
TEST(CutPlan, AStretchedTriangleMadeAllOthersFine) {
    const Texture flower = flower_mask();
    const Mesh leaves = cards(40);
    Mesh trunk = card();
    for (glm::vec2& uv : trunk.uvs)
        uv = {0.5, 0.5 + 0.01 * uv.y};
    Mesh tree = leaves;
    append(tree, trunk, {glm::dmat3(1.0), {5, 0, 0}});
    const int outline = outline_step(6.0 / 256);
    const size_t alone = cut(leaves, leaf(flower), outline).mesh.triangles.size();
    const size_t with_trunk = cut(tree, leaf(flower), outline).mesh.triangles.size();
    EXPECT_LE(with_trunk, alone + 2);
    EXPECT_GT(with_trunk, alone);
    EXPECT_GT(cut(tree, leaf(flower)).mesh.triangles.size(), 2 * with_trunk);
}

// A triangle without area, which shows nothing, had all leaves cut by single texels.
TEST(CutPlan, ATriangleWithoutAreaMadeAllOthersFine) {
    Mesh leaves = cards(40);
    const int outline = outline_step(1.5 / 256);
    const size_t alone = cut(leaves, leaf(disk(256)), outline).mesh.triangles.size();
    leaves.triangles.push_back({0, 0, 1});
    EXPECT_EQ(cut(leaves, leaf(disk(256)), outline).mesh.triangles.size(), alone);
}

// Joined leaves had their alpha once more, where it was clear.
TEST(CutPlan, WhereSomeOfASlotKeepsItsAlphaNothingIsJoined) {
    Mesh mesh;
    for (int i = 0; i < 40; ++i)
        append(mesh, card(0.5), {glm::dmat3(1.0), {0, 0, 0.1 * i}});
    const size_t small = mesh.triangles.size();
    for (int i = 0; i < 4; ++i)
        append(mesh, card(4), {glm::dmat3(100.0), {0, 0, 10.0 * i}});
    scenes::Builder builder;
    const ObjectIndex object = builder.mesh(mesh, {builder.material(leaf(ring_mask()))});
    RepresentationOptions options;
    options.outline = outline_step(0.5);
    const auto area_of_small = [&](bool opaque) {
        MaskOutlines outlines;
        const CutMesh found = cut_masks(
            builder.model, builder.model.objects[object].representations[0], options, outlines, {});
        EXPECT_EQ(found.opaque, std::vector<uint8_t>{opaque});
        double area = 0;
        for (size_t i = 0; i < found.mesh.triangles.size(); ++i)
            area += found.sources[i] < small ? glm::length(area_vector(found.mesh, i)) / 2 : 0;
        return area / 40;
    };
    EXPECT_NEAR(area_of_small(true), ring_mask().picture->mean.w, 0.05);
    options.most_cut = 10;  // too few for the large ones, whose alpha stays: so do small ones whole
    EXPECT_GT(area_of_small(false), 0.9);
}

// A meadow of flowers less than a pixel large each became seven triangles a flower.
TEST(CutPlan, WhatIsSmallerThanTheToleranceBecomesOneTriangleOfItsArea) {
    const Texture ring = ring_mask();
    const Mesh meadow = cards(40);
    const CutMesh found = cut(meadow, leaf(ring), outline_step(0.5));
    EXPECT_EQ(found.mesh.triangles.size(), meadow.triangles.size());
    EXPECT_NEAR(surface_area(found.mesh) / 40, ring.picture->mean.w, 0.05 * ring.picture->mean.w);
    for (size_t i = 0; i < found.mesh.triangles.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const glm::vec3& at = found.mesh.positions[found.mesh.triangles[i][k]];
            EXPECT_GE(std::min(at.x, at.y), -1e-6f);
            EXPECT_LE(std::max(at.x, at.y), 1 + 1e-6f);
        }
        EXPECT_GT(area_vector(found.mesh, i).z, 0);
    }
    EXPECT_GT(cut(meadow, leaf(ring), outline_step(0.02)).mesh.triangles.size(),
              4 * meadow.triangles.size());
}
