// SPDX-License-Identifier: GPL-3.0-or-later
// Guards posts that are thinner than a pixel: from afar they are clear boxes as wide as one.
#include "hierarchy/proposers/widened_levels.h"
#include "measure/visible/visible_attributes.h"
#include "povray_export/scene/povray_costs.h"
#include "scenes/built_models.h"
#include "scenes/small_models.h"
#include "scenes/street_lamps.h"
#include "scenes/with_rays.h"
#include "simplify/simplify.h"
#include "solids/stand_in_material.h"
#include "solids/widened_boxes.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>

using namespace lodestone;
using namespace lodestone::lamps;

namespace {

class Widen : public WithRays {};

Mesh lamp() {
    return lamps::lamp(0.06);
}

Mesh in_slot(const Mesh& mesh, uint16_t slot) {
    std::vector<uint8_t> keep;
    for (const uint16_t other : mesh.slots)
        keep.push_back(other == slot ? 1 : 0);
    return subset(mesh, keep);
}

Attributes attributes_of(const Mesh& mesh) {
    return measure::measure_visible(mesh, std::span<const Material>{}, {}).attributes;
}

hierarchy::StandInCandidate level_of(const Mesh& mesh, const std::vector<Material>& own,
                                     double error) {
    hierarchy::StandInCandidate out;
    out.payload = std::make_shared<const Mesh>(mesh);
    out.materials = own;
    out.error = out.max_error = error;
    return out;
}

/// What becomes of these candidates for `finest`.
std::vector<hierarchy::StandInCandidate> widened(const Mesh& finest,
                                                 const std::vector<Material>& own,
                                                 std::vector<hierarchy::StandInCandidate> kept) {
    image::TexelCache texels;
    const hierarchy::MeasuredFinest measured =
        hierarchy::measure_finest(finest, own, texels, {}, {}, {});
    hierarchy::FinestPictures pictures(measured);
    const hierarchy::ProposalLimits limits{finest, {bound_of(finest.positions)}};
    const Job job;
    hierarchy::ProposalRound round(measured, pictures, limits, job);
    round.candidates = std::move(kept);
    hierarchy::propose_widened_levels(round);
    return round.candidates;
}

/// What becomes of one level of `finest` with that error.
std::vector<hierarchy::StandInCandidate> widened(const Mesh& finest,
                                                 const std::vector<Material>& own,
                                                 const Mesh& level, double error) {
    return widened(finest, own, {level_of(level, own, error)});
}

}  // namespace

TEST_F(Widen, APostBecomesABoxOfItsLengthAndOfTheSameAreaTimesOpacity) {
    const Mesh post = shapes::box({-0.05, -0.05, 0}, {0.05, 0.05, 3});
    const Attributes attributes = attributes_of(post);
    const auto thin = solids::find_thin_part(post, attributes);
    ASSERT_TRUE(thin);
    EXPECT_NEAR(thin->thickness(), 0.1, 0.01);
    const solids::ClearSolid clear = solids::widened_box(*thin, 0.5, 0);
    EXPECT_NEAR(clear.primitive.half_size.x, 1.5, 1e-6);
    EXPECT_EQ(clear.primitive.half_size.y, 0.25);
    EXPECT_EQ(clear.primitive.half_size.z, 0.25);
    EXPECT_NEAR(std::abs(clear.primitive.axes[0].z), 1, 1e-3);
    EXPECT_NEAR(clear.primitive.center.z, 1.5, 1e-3);
    EXPECT_NEAR(clear.opacity * solids::box_shell(clear.primitive.half_size).area,
                attributes.visible_area, 1e-9);
    EXPECT_NEAR(0.5 * clear.opacity, 0.1, 0.01);
    const Material material = solids::clear_material({}, clear.opacity);
    EXPECT_EQ(material.alpha_mode, AlphaMode::Blend);
    EXPECT_NEAR((1 - material.alpha) * (1 - material.alpha), 1 - clear.opacity, 1e-12)
        << "its surface is crossed twice";
}

TEST_F(Widen, OnlyWhatIsLongAndThinBothWaysIsThin) {
    const Mesh cube = shapes::cube();
    EXPECT_FALSE(solids::find_thin_part(cube, attributes_of(cube)));
    const Mesh board = shapes::box({0, 0, 0}, {0.02, 1, 3});
    EXPECT_FALSE(solids::find_thin_part(board, attributes_of(board)));
    EXPECT_FALSE(solids::find_thin_part(Mesh{}, {}));
    const Mesh line = shapes::box({0, 0, 0}, {0, 0, 3});
    EXPECT_FALSE(solids::find_thin_part(line, attributes_of(line)));
}

TEST_F(Widen, AnOpaquePostOfALevelIsDrawnAsWideAsTheErrorAndAsClear) {
    const std::vector<size_t> targets{60};
    const Mesh level = simplify::simplify_chain(lamp(), targets)[0];
    const auto made = widened(lamp(), materials(), level, 0.25);
    ASSERT_EQ(made.size(), 2u) << "two widths";
    for (size_t i = 0; i < made.size(); ++i) {
        const Mesh& mesh = made[i].mesh();
        EXPECT_TRUE(in_slot(mesh, kPost).empty()) << i;
        EXPECT_EQ(in_slot(mesh, kGlass).positions, in_slot(level, kGlass).positions) << i;
        EXPECT_EQ(in_slot(mesh, kBulb).positions, in_slot(level, kBulb).positions) << i;
        ASSERT_EQ(made[i].materials.size(), 4u);
        const Material& clear = made[i].materials[3];
        EXPECT_EQ(clear.alpha_mode, AlphaMode::Blend);
        const Bound bound = bound_of(in_slot(mesh, 3).positions);
        const double width = bound.box.high.x - bound.box.low.x;
        EXPECT_NEAR(width, i == 0 ? 0.25 : 0.4, 0.01);
        EXPECT_NEAR(bound.box.high.z, 2.8, 0.02);
        EXPECT_GE(made[i].error, 0.25);
        EXPECT_GE(made[i].error, 0.5 * width);
        EXPECT_GT(tracing_of(made[i], povray::povray_costs()), 0);
    }
    EXPECT_LT(made[0].error, made[1].error);
    EXPECT_GT(made[0].materials[3].alpha, made[1].materials[3].alpha);
}

TEST_F(Widen, NoOpaquePostIsLeftBehindAClearOne) {
    const std::vector<Material> own = materials();
    const Mesh finest = lamp();
    const std::vector<size_t> targets{90, 60, 40};
    const std::vector<Mesh> levels = simplify::simplify_chain(finest, targets);
    const std::vector<hierarchy::StandInCandidate> kept =
        widened(finest, own,
                {level_of(levels[0], own, 0.05), level_of(levels[1], own, 0.2),
                 level_of(levels[2], own, 1.5)});
    ASSERT_GE(kept.size(), 3u);
    EXPECT_EQ(kept[0].mesh().positions, levels[0].positions);
    for (size_t i = 1; i < kept.size(); ++i) {
        EXPECT_TRUE(in_slot(kept[i].mesh(), kPost).empty()) << i;
        EXPECT_GT(kept[i].error, kept[i - 1].error) << i;
        EXPECT_LE(kept[i].mesh().triangles.size(), kept[i - 1].mesh().triangles.size()) << i;
    }
}

TEST_F(Widen, ARailNearTheGroundDoesNotSinkIntoIt) {
    const Mesh rail = shapes::box({-2, -0.02, 0.1}, {2, 0.02, 0.14});
    const auto thin = solids::find_thin_part(rail, attributes_of(rail));
    ASSERT_TRUE(thin);
    const solids::ClearSolid clear = solids::widened_box(*thin, 0.6, 0);
    EXPECT_GE(bound_of_box(clear.primitive).box.low.z, -1e-6);
    EXPECT_NEAR(clear.opacity * solids::box_shell(clear.primitive.half_size).area,
                thin->visible_area, 1e-9);
}

TEST_F(Widen, LevelsNearerThanPostsAreThickStayAsTheyAre) {
    const auto made = widened(lamp(), materials(), lamp(), 0.05);
    ASSERT_EQ(made.size(), 1u);
    EXPECT_EQ(made[0].materials.size(), 3u);
    EXPECT_EQ(made[0].error, 0.05);
    EXPECT_EQ(made[0].mesh().positions, lamp().positions);
}

TEST_F(Widen, WhatHasNoThinPartsKeepsItsLevels) {
    std::vector<Material> glowing = materials();
    glowing[kPost].emission = {1, 1, 1};
    std::vector<Material> glass = materials();
    glass[kPost].transmission = 1;
    std::vector<Material> clear = materials();
    clear[kPost] = solids::clear_material(clear[kPost], 0.5);
    for (const std::vector<Material>& own : {glowing, glass, clear}) {
        const auto made = widened(lamp(), own, lamp(), 0.25);
        ASSERT_EQ(made.size(), 1u);
        EXPECT_EQ(made[0].materials.size(), 3u);
        EXPECT_EQ(made[0].mesh().positions, lamp().positions);
    }
    const Mesh head = moved_up(shapes::sphere(0.2, 2), 3.1, kBulb);
    EXPECT_EQ(widened(head, materials(), head, 0.05)[0].mesh().positions, head.positions);
}

TEST_F(Widen, TenThousandWiresAreLeftAlone) {
    Mesh wires;
    const Mesh wire = shapes::box({0, 0, 0}, {0.001, 0.001, 1});
    for (int x = 0; x < 100; ++x)
        for (int y = 0; y < 100; ++y)
            append(wires, wire, models::moved(x, y, 0));
    const auto made = widened(wires, {Material{}}, wires, 2);
    ASSERT_EQ(made.size(), 1u);
    EXPECT_EQ(made[0].mesh().triangles.size(), wires.triangles.size());
}

TEST_F(Widen, PostsWithoutThicknessAreNoTrouble) {
    Mesh mesh = lamp();
    append(mesh, moved_up(shapes::box({1, 0, 0}, {1, 0, 3}), 0, kPost), {});
    append(mesh, moved_up(shapes::quad(0.0001f, 3), 0, kPost), {});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    mesh.positions.insert(mesh.positions.end(), {{nan, 0, 0}, {0, nan, 0}, {0, 0, 3}});
    const auto last = static_cast<uint32_t>(mesh.positions.size() - 1);
    mesh.triangles.emplace_back(last - 2, last - 1, last);
    mesh.slots.push_back(kPost);
    mesh.normals.clear();
    for (const hierarchy::StandInCandidate& made : widened(mesh, materials(), lamp(), 0.25)) {
        EXPECT_TRUE(std::isfinite(made.error));
        for (const Material& material : made.materials)
            EXPECT_TRUE(material.alpha >= 0 && material.alpha <= 1) << material.alpha;
    }
}

TEST_F(Widen, ARowOfLampsSharesClearLevelsOfRisingErrorAndNoMoreTriangles) {
    Model model;
    model.costs = povray::povray_costs();
    const ObjectIndex leaf = models::add_leaf(model, "lamp", lamp(), materials()[kPost]);
    Representation& finest = model.objects[leaf].representations[0];
    for (const uint16_t slot : {kGlass, kBulb}) {
        finest.materials.push_back(static_cast<uint32_t>(model.materials.size()));
        model.materials.push_back(materials()[slot]);
    }
    summarize(finest, model);
    std::vector<Placement> row;
    row.reserve(12);
    for (int i = 0; i < 12; ++i)
        row.push_back({leaf, models::moved(1.4 * i, 0, 0), std::to_string(i)});
    model.root = models::add_group(model, "row", std::move(row));
    build_in(model, "row");
    const auto& levels = model.objects[leaf].representations;
    size_t clear = 0;
    for (size_t i = 1; i < levels.size(); ++i) {
        EXPECT_GT(levels[i].summary.error, levels[i - 1].summary.error) << i;
        EXPECT_LE(levels[i].summary.cost.bytes, levels[i - 1].summary.cost.bytes) << i;
        const bool is_clear = std::any_of(
            levels[i].materials.begin(), levels[i].materials.end(),
            [&](uint32_t index) { return model.materials[index].alpha_mode == AlphaMode::Blend; });
        EXPECT_TRUE(is_clear || clear == 0) << "no opaque post behind a clear one, " << i;
        clear += is_clear ? 1 : 0;
    }
    EXPECT_GE(clear, 1u);
}
