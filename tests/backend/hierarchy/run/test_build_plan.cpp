// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what a build does again after a change: only what depends on it, and nothing where nothing
// changed. What is taken over is what a build from scratch makes.
#include "base/files.h"
#include "hierarchy/hierarchy_build.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"
#include "scratch.h"
#include "segment/store.h"

#include <gtest/gtest.h>

using namespace lodestone;
namespace fs = std::filesystem;

namespace {

class BuildPlans : public WithRays {};

hierarchy::BuildReport build_in(Model& model, const fs::path& folder, bool of_one_frame = false) {
    Problems problems;
    hierarchy::BuildSettings settings;
    settings.of_one_frame = of_one_frame;
    const hierarchy::BuildReport report =
        hierarchy::build_hierarchy(model, segment::Store(folder), settings, problems, {});
    EXPECT_TRUE(problems.empty()) << problems[0].message;
    return report;
}

/// Two tables with a vase each in a room, and a stone beside them.
Model room() {
    Model model;
    const Material wood = models::colored("wood", {0.4, 0.2, 0.1}, 0.6);
    const ObjectIndex top =
        models::add_leaf(model, "top", shapes::box({-1, -0.5, 0.7}, {1, 0.5, 0.75}), wood);
    const ObjectIndex vase = models::add_leaf(model, "vase", shapes::sphere(0.1, 4),
                                              models::colored("red", {0.8, 0.1, 0.1}, 0.3));
    const ObjectIndex stone = models::add_leaf(model, "stone", shapes::torus(24, 12),
                                               models::colored("gray", {0.4, 0.4, 0.4}, 0.8));
    const ObjectIndex table = models::add_group(
        model, "table", {{top, Affine{}, "top"}, {vase, models::moved(0, 0, 0.85), "vase"}});
    model.root = models::add_group(model, "room",
                                   {{table, models::moved(-1.5, 0, 0), "table left"},
                                    {table, models::moved(1.5, 0, 0), "table right"},
                                    {stone, models::moved(0, 4, 0), "stone"}});
    model.cameras.emplace_back();
    return model;
}

}  // namespace

TEST_F(BuildPlans, ABuildInWhichNothingChangedWritesNothing) {
    const fs::path folder = scratch("unchanged");
    Model first = room();
    EXPECT_GT(build_in(first, folder).bytes_written, 0u);
    const FileState state = file_state(folder / "tileset.json");
    Model second = room();
    const hierarchy::BuildReport report = build_in(second, folder);
    EXPECT_EQ(report.built, 0u);
    EXPECT_EQ(report.bytes_written, 0u);
    EXPECT_EQ(file_state(folder / "tileset.json"), state);
}

TEST_F(BuildPlans, AFrameInWhichOnlyTheCameraMovedWritesNothing) {
    const fs::path folder = scratch("frame");
    Model first = room();
    build_in(first, folder);
    const FileState state = file_state(folder / "tileset.json");
    Model frame = room();
    frame.cameras[0].position.x += 1;
    EXPECT_EQ(build_in(frame, folder, true).bytes_written, 0u);
    EXPECT_EQ(file_state(folder / "tileset.json"), state);
    EXPECT_GT(build_in(frame, folder).bytes_written, 0u);  // a picture of the store asks for it
    EXPECT_EQ(segment::Store(folder).read().cameras.at(0).position.x, 1);
}
