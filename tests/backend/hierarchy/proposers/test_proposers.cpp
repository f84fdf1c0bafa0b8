// SPDX-License-Identifier: GPL-3.0-or-later
// Guards each row of the proposers alone: what it adds to what those before it proposed.
#include "base/error.h"
#include "hierarchy/proposers/collapse_levels.h"
#include "hierarchy/proposers/composite_solids.h"
#include "hierarchy/proposers/proposers.h"
#include "povray_export/scene/povray_costs.h"
#include "scenes/leaf_cards.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>

using namespace lodestone;
using hierarchy::CandidateState;
using hierarchy::StandInCandidate;

namespace {

/// One original, and a walk along the rows.
class StandInProposers : public WithRays {
protected:
    /// What each row of the first stage adds, by name.
    std::map<std::string, std::vector<StandInCandidate>> walk(
        Mesh mesh, std::vector<Material> materials, hierarchy::FinestOptions options = {},
        std::vector<uint8_t> environment = {}) {
        mesh_ = std::move(mesh);
        materials_ = std::move(materials);
        finest_.emplace(
            hierarchy::measure_finest(mesh_, materials_, texels_, settings_, options, {}));
        limits_.emplace(hierarchy::ProposalLimits{mesh_, {bound_of(mesh_.positions)}});
        const CostModel costs = povray::povray_costs();
        limits_->whole.costs = costs;
        limits_->whole.bytes = static_cast<double>(mesh_.triangles.size() * costs.triangle_bytes);
        limits_->whole.most = limits_->whole.bytes;
        limits_->targets = hierarchy::targets_of(mesh_, settings_);
        limits_->told = hierarchy::kOff * limits_->whole.bound.radius;
        limits_->environment = std::move(environment);
        limits_->find_crowd = [this] { return prune::find_crowd(mesh_); };
        pictures_.emplace(*finest_);
        round_.emplace(*finest_, *pictures_, *limits_, job_);
        std::map<std::string, std::vector<StandInCandidate>> out;
        for (const hierarchy::StandInProposer& proposer : hierarchy::stand_in_proposers()) {
            if (proposer.stage != hierarchy::ProposalStage::All)
                continue;
            const size_t before = round_->candidates.size();
            proposer.propose(*round_);
            out[std::string(proposer.name)] = {
                round_->candidates.begin() + static_cast<std::ptrdiff_t>(before),
                round_->candidates.end()};
        }
        return out;
    }

    Mesh mesh_;
    std::vector<Material> materials_;
    image::TexelCache texels_;
    hierarchy::BuildSettings settings_;
    Job job_;
    std::optional<hierarchy::MeasuredFinest> finest_;
    std::optional<hierarchy::ProposalLimits> limits_;
    std::optional<hierarchy::FinestPictures> pictures_;
    std::optional<hierarchy::ProposalRound> round_;
};

void expect_meshes_that_get_simpler(const std::vector<StandInCandidate>& levels,
                                    CandidateState state) {
    for (size_t i = 0; i < levels.size(); ++i) {
        EXPECT_EQ(levels[i].kind, Kind::Mesh);
        EXPECT_EQ(levels[i].state, state);
        EXPECT_TRUE(std::isfinite(levels[i].error));
        EXPECT_LE(levels[i].error, levels[i].max_error);
        if (i > 0) {
            EXPECT_LT(levels[i].mesh().triangles.size(), levels[i - 1].mesh().triangles.size());
        }
    }
}

}  // namespace

TEST(StandInProposerRows, HaveNamesOfTheirOwnAndRefineAfterTheyPropose) {
    std::set<std::string_view> names;
    bool kept = false;
    for (const hierarchy::StandInProposer& proposer : hierarchy::stand_in_proposers()) {
        EXPECT_FALSE(proposer.name.empty());
        EXPECT_TRUE(names.insert(proposer.name).second) << proposer.name;
        ASSERT_NE(proposer.propose, nullptr);
        kept = kept || proposer.stage == hierarchy::ProposalStage::Kept;
        EXPECT_EQ(kept, proposer.stage == hierarchy::ProposalStage::Kept) << proposer.name;
    }
}

TEST_F(StandInProposers, ABallIsCollapsedAndReplacedByDistance) {
    auto made = walk(shapes::sphere(1), {models::colored("red", {0.5, 0.1, 0.1})});
    EXPECT_TRUE(made["near solids"].empty()) << "no candidates before it is known they are";
    ASSERT_GE(round_->near_solids.size(), 2u);
    ASSERT_FALSE(made["collapse"].empty());
    expect_meshes_that_get_simpler(made["collapse"], CandidateState::Unproven);
    EXPECT_TRUE(made["prune"].empty());
    ASSERT_EQ(made["solids"].size(), round_->near_solids.size());
    const auto nearest = std::min_element(
        made["solids"].begin(), made["solids"].end(),
        [](const StandInCandidate& a, const StandInCandidate& b) { return a.error < b.error; });
    EXPECT_EQ(nearest->kind, Kind::Ellipsoid);
    EXPECT_LT(nearest->error, 0.05);
    for (const StandInCandidate& solid : made["solids"]) {
        EXPECT_EQ(solid.state, CandidateState::Unproven);
        EXPECT_TRUE(solid.by_few_rays);
    }
    EXPECT_TRUE(made["composites"].empty()) << "nothing is nearer than an ellipsoid";
    EXPECT_TRUE(made["environment"].empty());
    EXPECT_FALSE(round_->by_pictures);
    EXPECT_THROW(static_cast<void>(pictures_->taken()), Error) << "pictures take long";
}

TEST_F(StandInProposers, OnlyAnObjectHasCompositesWhereDistancesTellWell) {
    Mesh balls;
    for (int i = 0; i < 6; ++i)
        append(balls, shapes::sphere(1), {glm::dmat3(1.0), {3.0 * (i % 3), 3.0 * (i % 2), 0}});
    const std::vector<Material> red{models::colored("red", {0.5, 0.1, 0.1})};
    const auto composites_of = [&](bool group) {
        hierarchy::FinestOptions options;
        options.group = group;
        walk(balls, red, options);
        EXPECT_FALSE(round_->by_pictures);
        round_->candidates.clear();  // as if no level was near
        hierarchy::propose_composites(*round_);
        return round_->candidates.size();
    };
    EXPECT_GT(composites_of(false), 0u);
    EXPECT_EQ(composites_of(true), 0u);
}

TEST_F(StandInProposers, ATreeIsPrunedAndComparedByPictures) {
    const PicturePtr leaf = foliage::picture(16, [](double x, double y) {
        return glm::dvec4(0.1, 0.5, 0.1, std::hypot(x - 0.5, y - 0.5) < 0.4 ? 1 : 0);
    });
    auto made =
        walk(foliage::tree(400), {models::colored("bark", {0.2, 0.1, 0.05}), foliage::leaf(leaf)});
    EXPECT_TRUE(round_->near_solids.empty());
    EXPECT_TRUE(round_->by_pictures);
    EXPECT_TRUE(round_->pruned);
    ASSERT_FALSE(made["prune"].empty());
    ASSERT_FALSE(made["solids"].empty());
    for (const char* row : {"prune", "solids", "composites"}) {
        for (const StandInCandidate& candidate : made[row])
            EXPECT_EQ(candidate.state, CandidateState::Pictured) << row;
    }
    for (const StandInCandidate& level : made["prune"])
        EXPECT_LT(level.mesh().triangles.size(), mesh_.triangles.size());
    EXPECT_NO_THROW(static_cast<void>(pictures_->taken()));
}

TEST_F(StandInProposers, ACrownHasTwiceAsManyPrunedLevelsAsAGroupAndIsToldFinely) {
    const std::vector<Material> leafy{models::colored("bark", {0.2, 0.1, 0.05}),
                                      foliage::leaf(foliage::left_half())};
    hierarchy::FinestOptions options;
    options.group = true;
    const auto of_group = walk(foliage::tree(3000), leafy, options)["prune"];
    ASSERT_FALSE(of_group.empty());
    for (const StandInCandidate& level : of_group)
        EXPECT_GE(level.error, pictures_->taken().least_error());
    const auto of_crown = walk(foliage::tree(3000), leafy)["prune"];
    ASSERT_GE(of_crown.size(), 2u);
    const auto triangles = [](const StandInCandidate& level) {
        return static_cast<double>(level.mesh().triangles.size());
    };
    EXPECT_LT(triangles(of_group[0]) / triangles(of_crown[0]), 0.7);
    EXPECT_NEAR(triangles(of_crown[1]) / triangles(of_crown[0]), std::sqrt(settings_.level_ratio),
                0.05);
    EXPECT_LT(of_crown[0].error, pictures_->taken().least_error())
        << "so many leaves hide each other that two of three look like all";
}

TEST_F(StandInProposers, PrunedLevelsEndWhereCardsAreNearer) {
    const PicturePtr leaf = foliage::picture(16, [](double x, double y) {
        return glm::dvec4(0.1, 0.5, 0.1, std::hypot(x - 0.5, y - 0.5) < 0.4 ? 1 : 0);
    });
    auto made =
        walk(foliage::tree(400), {models::colored("bark", {0.2, 0.1, 0.05}), foliage::leaf(leaf)});
    ASSERT_EQ(made["cards"].size(), 1u);
    ASSERT_FALSE(made["prune"].empty());
    for (size_t i = 0; i + 1 < made["prune"].size(); ++i)
        EXPECT_LT(made["prune"][i].error, made["cards"][0].error);
}

TEST_F(StandInProposers, ATreeHasCardsWhichPicturesMeasure) {
    const PicturePtr leaf = foliage::picture(16, [](double x, double y) {
        return glm::dvec4(0.1, 0.5, 0.1, std::hypot(x - 0.5, y - 0.5) < 0.4 ? 1 : 0);
    });
    auto made =
        walk(foliage::tree(400), {models::colored("bark", {0.2, 0.1, 0.05}), foliage::leaf(leaf)});
    ASSERT_EQ(made["cards"].size(), 1u);
    const StandInCandidate& cards = made["cards"][0];
    EXPECT_EQ(cards.state, CandidateState::Pictured);
    EXPECT_TRUE(cards.viewed) << "points of cards are not where those of leaves are";
    EXPECT_EQ(cards.mesh().triangles.size(), 20u);
    ASSERT_EQ(cards.materials.size(), 1u);
    EXPECT_LT(cards.error, finest_->size) << "in pictures they look like the tree";
    const measure::AgreementReference& crown = pictures_->of_crown(job_);
    const ray::SkinPtr skin = finest_->skin_of(cards.materials);
    const measure::PictureAgreement seen = crown.of(cards.mesh(), skin);
    EXPECT_NEAR(seen.coverage, 1, 0.02);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(seen.light[i], 1, 0.05) << "as bright as the tree";
}

TEST_F(StandInProposers, WhatIsNoMaskOrCostsLessThanAPictureHasNoCards) {
    auto ball = walk(shapes::sphere(1), {models::colored("red", {0.5, 0.1, 0.1})});
    EXPECT_TRUE(ball["cards"].empty());
    const std::vector<Material> leafy{models::colored("bark", {0.2, 0.1, 0.05}),
                                      foliage::leaf(foliage::left_half())};
    auto few = walk(foliage::tree(5, 3), leafy);
    EXPECT_TRUE(few["cards"].empty());
    hierarchy::FinestOptions options;
    options.environment = true;
    auto hedge = walk(foliage::tree(400), leafy, options);
    EXPECT_TRUE(hedge["cards"].empty());
    options = {};
    options.group = true;
    EXPECT_TRUE(walk(foliage::tree(400), leafy, options)["cards"].empty())
        << "its children have cards, which all trees of a kind share";
}

TEST_F(StandInProposers, ACarpetOfGrassHasNoUprightCards) {
    const std::vector<Material> leafy{models::colored("bark", {0.2, 0.1, 0.05}),
                                      foliage::leaf(foliage::left_half())};
    ASSERT_FALSE(walk(foliage::tree(400), leafy)["cards"].empty());
    Mesh grass = foliage::tree(400);
    for (glm::vec3& position : grass.positions)
        position.z *= 0.1f;
    EXPECT_TRUE(walk(grass, leafy)["cards"].empty());
}

TEST_F(StandInProposers, EnvironmentHasLevelsAlone) {
    hierarchy::FinestOptions options;
    options.environment = true;
    auto made = walk(shapes::terrain(40), {models::colored("grass", {0.1, 0.4, 0.1})}, options);
    EXPECT_FALSE(made["collapse"].empty());
    for (const char* row : {"near solids", "prune", "cards", "solids", "composites", "environment"})
        EXPECT_TRUE(made[row].empty()) << row;
}

TEST_F(StandInProposers, WhatStandsOnEnvironmentIsSolidsBesideIt) {
    Mesh mesh = shapes::terrain(20);
    std::vector<uint8_t> environment(mesh.triangles.size(), 1);
    Mesh ball = shapes::sphere(1);
    for (glm::vec3& position : ball.positions)
        position.z += 2;
    append(mesh, ball, {});
    environment.resize(mesh.triangles.size(), 0);
    hierarchy::FinestOptions options;
    options.environment = options.group = true;
    auto made =
        walk(std::move(mesh), {models::colored("all", {0.3, 0.3, 0.3})}, options, environment);
    ASSERT_GE(made["environment"].size(), 2u);
    for (const StandInCandidate& candidate : made["environment"]) {
        EXPECT_EQ(candidate.kind, Kind::Mesh);
        EXPECT_EQ(candidate.state, CandidateState::Unproven);
        EXPECT_GT(candidate.materials.size(), finest_->materials.size());
        EXPECT_LT(candidate.mesh().triangles.size(), mesh_.triangles.size());
    }
    auto bare = walk(shapes::terrain(20), {models::colored("all", {0.3, 0.3, 0.3})}, options,
                     std::vector<uint8_t>(shapes::terrain(20).triangles.size(), 1));
    EXPECT_TRUE(bare["environment"].empty()) << "nothing stands on it";
}
