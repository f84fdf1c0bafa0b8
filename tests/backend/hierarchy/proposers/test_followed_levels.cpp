// SPDX-License-Identifier: GPL-3.0-or-later
// Guards levels of what deforms: those of one collapse in every frame, whatever was built before.
#include "base/files.h"
#include "base/parallel.h"
#include "hierarchy/hierarchy_build.h"
#include "measure/deviation/surface_deviation.h"
#include "ray/mesh_scene.h"
#include "scenes/fine_grids.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"
#include "scratch.h"

#include <cmath>
#include <gtest/gtest.h>

using namespace lodestone;
namespace fs = std::filesystem;

namespace {

/// A sheet that waves higher in every frame, over a ball that rests; `cells` a side.
Model scene_at(int frame, uint32_t cells = 32) {
    Model model;
    Mesh sheet = shapes::grid(cells);
    for (glm::vec3& p : sheet.positions)
        p.z = 0.02f * static_cast<float>(frame) *
              std::sin(9 * p.x + 0.3f * static_cast<float>(frame));
    PosedSurface pose;
    pose.connectivity = Hasher().array(std::span<const Triangle>(sheet.triangles)).result();
    pose.points = sheet.positions;
    pose.triangles = sheet.triangles;
    const ObjectIndex flag = models::add_leaf(model, "flag", std::move(sheet));
    model.objects[flag].deforms = true;
    model.objects[flag].pose = std::make_shared<const PosedSurface>(std::move(pose));
    const ObjectIndex ball = models::add_leaf(model, "ball", shapes::sphere(0.3, 3));
    model.root = models::add_group(
        model, "scene", {{flag, Affine{}, "flag"}, {ball, models::moved(0, 0, -2), "ball"}});
    return model;
}

struct Built {
    Model model;
    hierarchy::BuildReport report;
    Problems problems;

    const Object& flag() const { return model.objects[0]; }
    /// The mesh of a level, resident or not.
    Mesh level(const fs::path& folder, size_t lod) const {
        Representation representation = flag().representations.at(lod);
        segment::Store(folder).load(representation);
        return representation.mesh();
    }
};

Built build_frame(int frame, const fs::path& folder, const std::vector<Model>& poses,
                  uint32_t cells = 32) {
    Built built{scene_at(frame, cells), {}, {}};
    hierarchy::BuildSettings settings;
    for (const Model& pose : poses)
        settings.poses.push_back(&pose);
    built.report = hierarchy::build_hierarchy(built.model, segment::Store(folder), settings,
                                              built.problems, {});
    return built;
}

std::vector<Model> some_poses(uint32_t cells = 32) {
    std::vector<Model> poses;
    for (const int frame : {1, 4, 8})
        poses.push_back(scene_at(frame, cells));
    return poses;
}

std::vector<Hash> hashes_of(const Object& object) {
    std::vector<Hash> hashes;
    for (const Representation& representation : object.representations)
        hashes.push_back(representation.summary.hash);
    return hashes;
}

size_t bound_files(const fs::path& folder) {
    std::error_code error;
    size_t count = 0;
    for (const auto& entry : fs::directory_iterator(folder / "b", error))
        count += entry.path().extension() == ".bound";
    return count;
}

class Followed : public WithRays {};

}  // namespace

TEST_F(Followed, WithoutPosesWhatDeformsIsDrawnAsItIsAndNothingIsSaidOfIt) {
    const Built built = build_frame(3, scratch("none"), {});
    EXPECT_EQ(built.flag().representations.size(), 1u);
    EXPECT_TRUE(built.problems.empty());
}

TEST_F(Followed, TooFewTrianglesToSimplifyHaveNoLevels) {
    const fs::path folder = scratch("small");
    const Built built = build_frame(3, folder, some_poses(1), 1);
    EXPECT_EQ(built.flag().representations.size(), 1u);
    EXPECT_EQ(build_frame(4, folder, some_poses(1), 1).report.built, 0u);
}

TEST_F(Followed, EveryFrameHasTheSameTrianglesElsewhere) {
    const fs::path folder = scratch("frames");
    const std::vector<Model> poses = some_poses();
    const Built first = build_frame(2, folder, poses);
    EXPECT_EQ(first.report.built, 2u);  // the ball, and one collapse
    ASSERT_GT(first.flag().representations.size(), 3u);
    std::vector<Mesh> levels;
    for (size_t lod = 1; lod < first.flag().representations.size(); ++lod)
        levels.push_back(first.level(folder, lod));
    for (const int frame : {7, 3, 20}) {
        const Built next = build_frame(frame, folder, poses);
        EXPECT_EQ(next.report.built, 0u);
        ASSERT_EQ(next.flag().representations.size(), first.flag().representations.size());
        for (size_t lod = 1; lod < next.flag().representations.size(); ++lod) {
            const Mesh level = next.level(folder, lod);
            EXPECT_EQ(level.triangles, levels[lod - 1].triangles);
            EXPECT_NE(level.positions, levels[lod - 1].positions);
        }
        EXPECT_EQ(next.model.objects[next.model.root].representations.size(), 1u);
    }
}

TEST_F(Followed, ErrorIsThatOfTheFrame) {
    const fs::path folder = scratch("error");
    const std::vector<Model> poses = some_poses();
    for (const int frame : {1, 12}) {
        const Built built = build_frame(frame, folder, poses);
        const Mesh finest = built.level(folder, 0);
        const measure::DeviationReference reference(finest, {4096, 4096, 5});
        double last = 0;
        for (size_t lod = 1; lod < built.flag().representations.size(); ++lod) {
            const double error = built.flag().representations[lod].summary.error;
            const double again = reference.of(built.level(folder, lod)).error;
            EXPECT_GT(error, last);
            // What witnesses know is never less, and not much more.
            EXPECT_GT(error, 0.9 * again) << "frame " << frame << ", LOD " << lod;
            EXPECT_LT(error, 3 * again + 1e-6) << "frame " << frame << ", LOD " << lod;
            last = error;
        }
        const double finest_error = built.flag().representations[1].summary.error;
        EXPECT_LT(finest_error, 0.02 * frame) << "nowhere near the wave's height";
    }
}

TEST_F(Followed, OrderOfFramesStoresAndThreadsMakeNoDifference) {
    const std::vector<Model> poses = some_poses();
    const fs::path forward = scratch("forward");
    std::vector<std::vector<Hash>> seen;
    for (const int frame : {2, 5, 9})
        seen.push_back(hashes_of(build_frame(frame, forward, poses).flag()));
    const fs::path backward = scratch("backward");
    const ThreadLimit one(1);
    for (const size_t i : {2, 1, 0}) {
        const int frame = std::vector<int>{2, 5, 9}[i];
        EXPECT_EQ(hashes_of(build_frame(frame, backward, poses).flag()), seen[i]) << frame;
    }
}

TEST_F(Followed, AnotherConnectivityIsDrawnAsItIsAndNamed) {
    const Built built = build_frame(3, scratch("cells"), some_poses(32), 33);
    EXPECT_EQ(built.flag().representations.size(), 1u);
    ASSERT_EQ(built.problems.size(), 1u);
    EXPECT_EQ(built.problems[0].object, "flag");
    EXPECT_EQ(built.problems[0].code, "not_followed");
    EXPECT_EQ(built.problems[0].severity, Severity::Info);
}

TEST_F(Followed, WhatGrowsNewFacesFollowsThePosesThatHaveThem) {
    const fs::path folder = scratch("grows");
    std::vector<Model> poses;
    poses.push_back(scene_at(1, 20));
    poses.push_back(scene_at(4, 32));
    poses.push_back(scene_at(8, 32));
    const Built young = build_frame(2, folder, poses, 20);
    const Built old = build_frame(9, folder, poses, 32);
    EXPECT_GT(young.flag().representations.size(), 1u);
    EXPECT_GT(old.flag().representations.size(), 1u);
    EXPECT_NE(young.flag().bind_hash, old.flag().bind_hash);
    EXPECT_TRUE(young.problems.empty() && old.problems.empty());
}

TEST_F(Followed, TheSameFrameAgainIsTakenFromTheStore) {
    const fs::path folder = scratch("again");
    const std::vector<Model> poses = some_poses();
    const Built first = build_frame(5, folder, poses);
    const Built second = build_frame(5, folder, poses);
    EXPECT_EQ(hashes_of(second.flag()), hashes_of(first.flag()));
    EXPECT_EQ(second.flag().bind_hash, first.flag().bind_hash);
    EXPECT_FALSE(second.flag().representations.at(1).resident());
    EXPECT_EQ(segment::Store(folder).read().objects[0].bind_hash, first.flag().bind_hash);
}

TEST_F(Followed, TheCollapseIsKeptOnlyWhileSomethingFollowsIt) {
    const fs::path folder = scratch("kept");
    const std::vector<Model> poses = some_poses();
    for (const int frame : {1, 2, 3, 4})
        build_frame(frame, folder, poses);
    EXPECT_EQ(bound_files(folder), 1u);
    build_frame(5, folder, {});
    EXPECT_EQ(bound_files(folder), 1u) << "the store before needs it";
    build_frame(6, folder, {});
    EXPECT_EQ(bound_files(folder), 0u);
}

TEST_F(Followed, DamagedBoundLevelsAreMadeAgain) {
    const fs::path folder = scratch("damaged");
    const std::vector<Model> poses = some_poses();
    const Built first = build_frame(2, folder, poses);
    const fs::path file = folder / "b" / (hex16(first.flag().bind_hash) + ".bound");
    const std::string whole = read_file(file);
    EXPECT_EQ(hashes_of(build_frame(3, folder, poses).flag()).size(),
              first.flag().representations.size());
    for (size_t cut : {size_t{0}, size_t{7}, size_t{24}, whole.size() / 2, whole.size() - 1}) {
        write_file(file, whole.substr(0, cut));
        EXPECT_EQ(build_frame(4, folder, poses).report.built, 1u) << cut;
        EXPECT_EQ(read_file(file), whole);
        build_frame(3, folder, poses);  // so that frame 4 is not in the store
    }
    std::string changed = whole;
    changed[whole.size() / 2] ^= 1;
    EXPECT_THROW(segment::bound_levels_of(changed), Error);
    EXPECT_NO_THROW(segment::bound_levels_of(whole));
}

TEST_F(Followed, PosesThatAreNoNumbersAreNotUsed) {
    std::vector<Model> poses = some_poses();
    PosedSurface broken = *poses[0].objects[0].pose;
    broken.points[0].x = std::numeric_limits<float>::quiet_NaN();
    poses[0].objects[0].pose = std::make_shared<const PosedSurface>(broken);
    const fs::path folder = scratch("nan");
    EXPECT_GT(build_frame(3, folder, poses).flag().representations.size(), 1u);
    // A frame's own broken point: nothing hangs on it, or the level is left out.
    Model model = scene_at(3);
    model.objects[0].pose = std::make_shared<const PosedSurface>(broken);
    hierarchy::BuildSettings settings;
    for (const Model& pose : poses)
        settings.poses.push_back(&pose);
    Problems problems;
    hierarchy::build_hierarchy(model, segment::Store(folder), settings, problems, {});
    EXPECT_GE(model.objects[0].representations.size(), 1u);
}

TEST_F(Followed, ACancelledBuildLeavesTheModelAsItWas) {
    const std::vector<Model> poses = some_poses();
    Model model = scene_at(3);
    hierarchy::BuildSettings settings;
    for (const Model& pose : poses)
        settings.poses.push_back(&pose);
    volatile int32_t cancel = 1;
    int32_t stage = 0;
    double fraction = 0;
    Problems problems;
    EXPECT_THROW(hierarchy::build_hierarchy(model, segment::Store(scratch("cancel")), settings,
                                            problems, Job(&cancel, &stage, &fraction)),
                 Error);
    EXPECT_EQ(model.objects[0].representations.size(), 1u);
}
