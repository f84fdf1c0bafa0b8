// SPDX-License-Identifier: GPL-3.0-or-later
// Guards how much coarser parts of a mesh may be that reaches from near to far, or out of the picture.
#include "choose/criterion.h"
#include "povray/mask_cards.h"
#include "povray_export/mesh/detail_bands.h"
#include "povray_export/mesh/mesh_cutting.h"
#include "povray_export/mesh/pixel_field.h"

#include <limits>

using namespace lodestone;
using namespace lodestone::povray;

namespace {

/// Cards in a row along x, a metre apart.
Mesh row(int count) {
    Mesh mesh;
    for (int i = 0; i < count; ++i)
        append(mesh, card(), {glm::dmat3(0.5), {i, 0, 0}});
    return mesh;
}

/// A pixel as large as the distance from a place on the x axis, but at least 1.
DetailBands::PixelOfPart from(double eye) {
    return [=](const Bound& bound, std::span<const uint32_t>) {
        const double gap = std::max(bound.box.low.x - eye, eye - bound.box.high.x);
        return std::max(1.0, gap);
    };
}

Box3 box_of(const Mesh& mesh, size_t triangle) {
    Box3 box;
    for (int corner = 0; corner < 3; ++corner)
        box.add(glm::dvec3(mesh.positions[mesh.triangles[triangle][corner]]));
    return box;
}

}  // namespace

TEST(DetailBands, WithoutTrianglesAndOfOneThereAreNone) {
    const DetailBands none({}, from(0));
    EXPECT_TRUE(none.even());
    EXPECT_EQ(none.finest(), std::numeric_limits<double>::infinity());
    EXPECT_EQ(none.octaves({{0, 0, 0}, {1, 1, 1}}), 0);
    EXPECT_TRUE(DetailBands(card(), from(-70)).even());
}

TEST(DetailBands, PartsTwiceAsFarHaveAnOctaveMore) {
    const Mesh mesh = row(300);
    const DetailBands bands(mesh, from(0));
    EXPECT_FALSE(bands.even());
    EXPECT_EQ(bands.finest(), 1);
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Box3 box = box_of(mesh, i);
        const int octaves = bands.octaves(box);
        const int own = static_cast<int>(std::log2(std::max(1.0, box.low.x)));
        EXPECT_LE(octaves, own) << i;  // never coarser than it is seen
        EXPECT_GE(octaves, own - 1) << i;
    }
}

TEST(DetailBands, APartOfATriangleIsNoCoarserThanTheTriangle) {
    const Mesh mesh = row(100);
    const DetailBands bands(mesh, from(30));
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        Box3 half = box_of(mesh, i);
        half.low.x = half.center().x;
        EXPECT_LE(bands.octaves(half), bands.octaves(box_of(mesh, i)) + 1) << i;
        EXPECT_LE(std::exp2(bands.octaves(half)), std::max(1.0, std::abs(half.low.x - 30)) + 0.5);
    }
    EXPECT_EQ(bands.octaves({{500, 0, 0}, {501, 1, 1}}), 0);
}

TEST(DetailBands, EqualViewsHaveOneHashAndOthersAnother) {
    const Mesh mesh = row(100);
    EXPECT_EQ(DetailBands(mesh, from(0)).hash(), DetailBands(mesh, from(0)).hash());
    EXPECT_NE(DetailBands(mesh, from(0)).hash(), DetailBands(mesh, from(50)).hash());
}

TEST(DetailBands, WhatIsFarBeyondAllSenseHasTheMost) {
    const DetailBands bands(row(100), [](const Bound& bound, std::span<const uint32_t>) {
        return bound.box.low.x > 50 ? std::numeric_limits<double>::infinity() : 1e-300;
    });
    EXPECT_EQ(bands.octaves({{99, 0, 0}, {99.2, 0, 0}}), DetailBands::kMost);
}

TEST(DetailBands, LeavesOfOneMeshWereCutAsFinelyFarAwayAsNear) {
    scenes::Builder builder;
    const Texture rough = alpha_of(256, [](double u, double v) {
        const double angle = std::atan2(v - 0.5, u - 0.5);
        return 0.5 + (0.3 + 0.02 * std::sin(40 * angle) - std::hypot(u - 0.5, v - 0.5)) * 256;
    });
    const ObjectIndex object = builder.mesh(row(60), {builder.material(leaf(rough))});
    const Representation& finest = builder.model.objects[object].representations[0];
    MaskOutlines outlines;
    RepresentationOptions options;
    options.outline = -16;
    const CutMesh all = cut_masks(builder.model, finest, options, outlines, {});
    options.bands = std::make_shared<const DetailBands>(finest.mesh(), from(0));
    const CutMesh some = cut_masks(builder.model, finest, options, outlines, {});
    EXPECT_LT(some.mesh.triangles.size() * 3, all.mesh.triangles.size());
    EXPECT_EQ(some.opaque, std::vector<uint8_t>{1});
    EXPECT_NEAR(surface_area(some.mesh), surface_area(all.mesh), 0.03 * surface_area(all.mesh));
    const auto of_first = [](const CutMesh& cut) {
        return std::count_if(cut.sources.begin(), cut.sources.end(),
                             [](uint32_t source) { return source < 2; });
    };
    EXPECT_EQ(of_first(some), of_first(all));
    CutForecast forecast = cut_forecast(builder.model, finest, options, outlines, {});
    EXPECT_TRUE(forecast.by_outline);
    EXPECT_NEAR(static_cast<double>(forecast.triangles),
                static_cast<double>(some.mesh.triangles.size()),
                0.5 * static_cast<double>(some.mesh.triangles.size()));
}

TEST(PixelField, AGroundThatReachesUnderTheEyeWasSeenFromNoDistance) {
    scenes::Builder builder;
    Mesh ground = shapes::quad(400, 400);
    builder.place(builder.mesh(ground));
    const Model& model = builder.finish();
    View view = scenes::above();
    view.camera.position = {0, 0, 2};
    view.camera.right = {1, 0, 0};
    view.camera.up = glm::normalize(glm::dvec3(0, 0.1, 1));
    view.camera.direction = glm::normalize(glm::dvec3(0, 1, -0.1));
    const PixelField field(model, view);
    const DetailBandsPtr bands = field.bands(ground, {}, bound_of(ground.positions));
    ASSERT_TRUE(bands);
    EXPECT_NEAR(bands->finest(), choose::pixel_size(view, 2), 1e-9);
    const Mesh leaf = card();
    const Affine away{glm::dmat3(1.0), {0, 500, 0}};
    EXPECT_FALSE(field.bands(leaf, away, transformed(bound_of(leaf.positions), away)));
}
