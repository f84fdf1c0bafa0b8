// SPDX-License-Identifier: GPL-3.0-or-later
// Guards crowds as few painted boxes: what they are made of, how near they look, and what a picture
// then uses.
#include "choose/cut.h"
#include "hierarchy/hierarchy_build.h"
#include "hierarchy/proposers/painted_boxes.h"
#include "hierarchy/proposers/proposers.h"
#include "povray_export/scene/povray_costs.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"
#include "scratch.h"
#include "segment/store.h"

#include <algorithm>

using namespace lodestone;
using hierarchy::CandidateState;
using hierarchy::StandInCandidate;

namespace {

constexpr int kAlong = 8;      // houses along a side of a block
constexpr double kStep = 14;   // metres from one to the next
constexpr double kWidth = 10;  // of a house

/// A house, of one of four heights.
Mesh house(int number) {
    return shapes::box({0, 0, 0}, {kWidth, kWidth, 7.0 + 2 * (number % 4)});
}

/// Where the house of that number stands in a block.
Affine place_of(int number) {
    const int line = number / kAlong;
    return models::moved(kStep * (number % kAlong), kStep * line, 0);
}

/// A block of houses with gaps between them as one mesh, of one or several materials.
Mesh block(int materials) {
    Mesh mesh;
    for (int i = 0; i < kAlong * kAlong; ++i) {
        Mesh one = house(i * i / 3);
        one.slots.assign(one.triangles.size(), static_cast<uint16_t>(i % materials));
        append(mesh, one, place_of(i));
    }
    return mesh;
}

class PaintedBoxes : public WithRays {
protected:
    std::vector<StandInCandidate> proposed(const Mesh& mesh, std::vector<Material> materials,
                                           bool many = true) {
        const hierarchy::BuildSettings settings;
        hierarchy::FinestOptions options;
        options.group = true;
        const hierarchy::MeasuredFinest finest =
            hierarchy::measure_finest(mesh, materials, texels_, settings, options, {});
        hierarchy::ProposalLimits limits{mesh, {bound_of(mesh.positions)}};
        limits.whole.costs = povray::povray_costs();
        limits.whole.bytes = limits.whole.most =
            static_cast<double>(mesh.triangles.size() * limits.whole.costs.triangle_bytes);
        limits.whole.many = limits.whole.alike = many;
        hierarchy::FinestPictures pictures(finest);
        const Job job;
        hierarchy::ProposalRound round(finest, pictures, limits, job);
        hierarchy::propose_painted_boxes(round);
        EXPECT_EQ(round.painted, !round.candidates.empty());
        return round.candidates;
    }

    image::TexelCache texels_;
};

}  // namespace

TEST_F(PaintedBoxes, FewThingsAndSeeThroughThingsAndLampsHaveNone) {
    const Mesh mesh = block(1);
    EXPECT_TRUE(proposed(mesh, {Material{}}, false).empty());
    Material clear;
    clear.alpha_mode = AlphaMode::Blend;
    clear.alpha = 0.3;
    EXPECT_TRUE(proposed(mesh, {clear}).empty());
    Material lamp;
    lamp.emission = {1, 1, 1};
    EXPECT_TRUE(proposed(mesh, {lamp}).empty());
}

TEST_F(PaintedBoxes, AreMeshesOfBoxesInOneMaterialThatGetNearerTheMoreThereAre) {
    const Mesh mesh = block(3);
    const std::vector<StandInCandidate> all = proposed(
        mesh, {models::colored("a", {0.7, 0.2, 0.1}), models::colored("b", {0.2, 0.6, 0.1}),
               models::colored("c", {0.1, 0.2, 0.5})});
    ASSERT_GE(all.size(), 4u);
    const double radius = bound_of(mesh.positions).radius;
    double nearest = 4 * radius;
    for (const StandInCandidate& candidate : all) {
        ASSERT_EQ(candidate.kind, Kind::Mesh);
        EXPECT_EQ(candidate.state, CandidateState::Pictured);
        ASSERT_EQ(candidate.materials.size(), 1u);
        EXPECT_TRUE(candidate.materials[0].vertex_colors);
        EXPECT_EQ(candidate.mesh().triangles.size() % 12, 0u);
        EXPECT_EQ(candidate.mesh().colors.size(), candidate.mesh().positions.size());
        nearest = std::min(nearest, candidate.error);
    }
    EXPECT_LT(nearest, 0.25 * radius);
    EXPECT_EQ(all.back().mesh().triangles.size(), 12u);  // one box
    EXPECT_GT(all.back().error, nearest);
    EXPECT_GT(all.front().error, nearest);  // the fewest clusters
}

TEST_F(PaintedBoxes, ASideOverGapsIsDarkerThanWhatStandsThere) {
    // Half of what one sees from above is the gaps, which send nothing.
    const std::vector<StandInCandidate> all =
        proposed(block(1), {models::colored("wall", {0.6, 0.6, 0.6})});
    ASSERT_FALSE(all.empty());
    const StandInCandidate& box = all.back();
    ASSERT_EQ(box.mesh().triangles.size(), 12u);
    for (size_t i = 0; i < box.mesh().positions.size(); ++i) {
        if (box.mesh().normals[i].z < 0.5f)
            continue;
        const double shown = box.materials[0].base_color.x * box.mesh().colors[i].x;
        EXPECT_GT(shown, 0.2);
        EXPECT_LT(shown, 0.55);
    }
}

TEST_F(PaintedBoxes, ATownFromAboveIsAsBrightAsItsHouses) {
    // Half of the pictures that boxes were painted by were taken from below, where nobody stands:
    // towns were darker from above than their houses.
    const Mesh mesh = block(1);
    const Material wall = models::colored("wall", {0.6, 0.6, 0.6});
    const auto skin_of = [&](const Material& material) {
        return std::make_shared<const ray::MeshSkin>(std::vector<Material>{material}, texels_);
    };
    const ray::SkinPtr skin = skin_of(wall);
    const measure::AgreementReference above(mesh, ray::MeshScene(mesh, skin), skin, 77,
                                            measure::AgreementReference::kSide, {},
                                            measure::PictureViews::FromAbove);
    const std::vector<StandInCandidate> all = proposed(mesh, {wall});
    ASSERT_FALSE(all.empty());
    for (const StandInCandidate& candidate : all) {
        const glm::dvec3 light = above.of(candidate.mesh(), skin_of(candidate.materials[0])).light;
        EXPECT_NEAR(light.x, 1, 0.04) << candidate.mesh().triangles.size() << " triangles";
    }
}

TEST_F(PaintedBoxes, SidesBelowThatNobodySeesAreNotBlack) {
    for (const StandInCandidate& candidate :
         proposed(block(1), {models::colored("wall", {0.6, 0.6, 0.6})})) {
        const Mesh& mesh = candidate.mesh();
        for (size_t i = 0; i < mesh.positions.size(); ++i) {
            if (mesh.normals[i].z < -0.5f) {
                EXPECT_GT(candidate.materials[0].base_color.x * mesh.colors[i].x, 0.2);
            }
        }
    }
}

TEST_F(PaintedBoxes, AreTheSameBitsEveryTime) {
    const auto first = proposed(block(2), {Material{}, models::colored("b", {0.1, 0.2, 0.3})});
    const auto second = proposed(block(2), {Material{}, models::colored("b", {0.1, 0.2, 0.3})});
    ASSERT_EQ(first.size(), second.size());
    for (size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(first[i].error, second[i].error);
        EXPECT_EQ(first[i].mesh().colors, second[i].mesh().colors);
        EXPECT_EQ(first[i].mesh().positions, second[i].mesh().positions);
    }
}

TEST_F(PaintedBoxes, ABlockOfHousesThatIsSevenPixelsWideIsOneThing) {
    // It was 64 boxes, however far away.
    Model model;
    std::vector<ObjectIndex> houses(4);
    for (int i = 0; i < 4; ++i)
        houses[static_cast<size_t>(i)] =
            models::add_leaf(model, "house " + std::to_string(i), house(i),
                             models::colored("wall", {0.2 + 0.1 * i, 0.4, 0.3}));
    std::vector<Placement> placements(static_cast<size_t>(kAlong) * kAlong);
    for (int i = 0; i < kAlong * kAlong; ++i)
        placements[static_cast<size_t>(i)] = {houses[static_cast<size_t>(i * i / 3) % 4],
                                              place_of(i), "house"};
    model.root = models::add_group(model, "block", std::move(placements));
    summarize_assemblies(model, bottom_up(model));
    Problems problems;
    hierarchy::build_hierarchy(model, segment::Store(scratch("store")), {}, problems, {});
    const double radius = model.objects[model.root].bound().radius;
    View view = models::view_from(0, 1);
    view.camera.orthographic = true;
    view.width = view.height = 8;
    view.camera.right = {2 * radius, 0, 0};
    view.camera.up = {0, 0, 2 * radius};
    view.camera.position = model.objects[model.root].bound().center - glm::dvec3(0, 4 * radius, 0);
    const choose::Cut cut = choose::choose_cut(model, view);
    EXPECT_EQ(cut.chosen.size(), 1u);
    EXPECT_LE(cut.triangles, 400u);
}

TEST_F(PaintedBoxes, AHouseAmongManyPostsIsNoCrowd) {
    // Boxes stood for it where solids and composites are nearer: far streets looked coarser.
    const auto is_painted = [&](const glm::dvec3& house_size) {
        Model model;
        const ObjectIndex post =
            models::add_leaf(model, "post", shapes::box({0, 0, 0}, {0.5, 0.5, 2}),
                             models::colored("wood", {0.5, 0.3, 0.2}));
        const ObjectIndex big = models::add_leaf(model, "house", shapes::box({0, 0, 0}, house_size),
                                                 models::colored("wall", {0.7, 0.7, 0.6}));
        std::vector<Placement> placements{{big, models::moved(3, 3, 0), "house"}};
        for (int i = 0; i < 40; ++i)
            placements.push_back({post, models::moved(0.7 * i, 0, 0), std::to_string(i)});
        model.root = models::add_group(model, "yard", std::move(placements));
        summarize_assemblies(model, bottom_up(model));
        Problems problems;
        hierarchy::build_hierarchy(model, segment::Store(scratch("store")), {}, problems, {});
        const std::vector<Representation>& levels = model.objects[model.root].representations;
        return std::any_of(levels.begin() + 1, levels.end(), [](const Representation& level) {
            return level.summary.kind == Kind::Mesh && !level.mesh().colors.empty();
        });
    };
    EXPECT_FALSE(is_painted({8, 8, 9}));
    EXPECT_TRUE(is_painted({0.5, 0.5, 3}));  // no larger than the posts
}
