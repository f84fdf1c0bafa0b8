// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that whatever a picture shows is spoken for by a lit point that is near it and sees it.
#include "light/light_coverage.h"
#include "povray/povray_scenes.h"
#include "povray_export/lamp/renderer_surfaces.h"
#include "ray/mesh_scene.h"

using namespace lodestone;
using namespace lodestone::light;
using namespace lodestone::povray;

namespace {

class LightCoverage : public testing::Test {
protected:
    void SetUp() override {
        std::string reason;
        if (!ray::available(&reason))
            GTEST_SKIP() << reason;
    }
};

/// From eye height along a floor of 200 m, whose far half is two rows of pixels.
View along_a_floor() {
    View view;
    view.width = 192;
    view.height = 108;
    view.camera.position = {-1, 0, 1.6};
    view.camera.direction = {1, 0, 0};
    view.camera.right = {0, -0.8, 0};
    view.camera.up = {0, 0, 0.45};
    return view;
}

}  // namespace

// The far end of a corridor was black: points of the near half, which see the far half well, spoke
// for it, and no lamp of the far half reached one of them.
TEST_F(LightCoverage, NothingIsSpokenForByAPointFarFromIt) {
    scenes::Builder builder;
    const ObjectIndex box = builder.mesh(shapes::cube());
    const Affine place{{200, 0, 0, 0, 2, 0, 0, 0, .2}, {100, 0, -.1}};
    builder.place(box, place, "floor");
    const Model& model = builder.finish();
    const std::vector<DrawnThing> drawn = {{&model.objects[box].representations[0], place}};
    const LitScene scene(model, povray::renderer_surfaces(model), drawn, {});
    const View view = along_a_floor();
    LitGrid grid = scene.points(view, 1200, 0, {});
    const size_t even = grid.points.size();
    ASSERT_GT(even, 50u);
    const std::vector<uint8_t> divisible = {1};
    const std::vector<uint8_t> all_cells(grid.rows * grid.columns, 1);
    const std::vector<PointSighting> sightings =
        add_missing_lit_points(scene, view, divisible, all_cells, grid, {});
    ASSERT_GT(sightings.size(), 400u);
    size_t far = 0;
    for (const PointSighting& seen : sightings) {
        light::LitPoint look;
        look.position = seen.position;
        const double away = glm::length(grid.points[seen.point].position - seen.position);
        ASSERT_LE(away, reach_beside(view, grid, look));
        far += seen.position.x > 100 ? 1 : 0;
    }
    EXPECT_GT(far, 10u);
    EXPECT_GT(grid.points.size(), even);
    EXPECT_LT(grid.points.size(), 2 * even);  // near by, one point speaks for many pixels
}
