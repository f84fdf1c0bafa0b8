// SPDX-License-Identifier: GPL-3.0-or-later
// Guards that the picture of a mesh is the same when its loose parts are drawn as clusters.
#include "base/random.h"
#include "group/loose_parts.h"
#include "povray/povray_scenes.h"

#include <cmath>

using namespace lodestone;
using namespace lodestone::povray;
using scenes::Builder;

TEST(PovrayLooseParts, ThePictureIsTheSameBitByBit) {
    if (!scenes::have_povray())
        GTEST_SKIP() << "no POV-Ray";
    Builder builder;
    Material marble = scenes::textured(scenes::checker());
    const std::vector<uint32_t> materials{builder.matte({0.8, 0.1, 0.1}), builder.material(marble)};
    Mesh town;
    for (uint64_t i = 0; i < 60; ++i) {
        const auto step = [&](uint64_t number, double most) {  // whole centimetres: on any lattice
            return std::floor(100 * most * PcgRandom(number, i).uniform()) / 100;
        };
        // No two roofs are equally high: which of two faces in one plane is seen is by chance.
        const double roof = 0.3 + 0.02 * static_cast<double>(i);
        Mesh house = shapes::box({0, 0, 0}, {0.5, 0.5, roof});
        for (size_t v = 0; v < house.positions.size(); ++v)
            house.uvs.emplace_back(0.5f * static_cast<float>(v % 3),
                                   0.25f * static_cast<float>(v % 4));
        house.slots.assign(house.triangles.size(), static_cast<uint16_t>(i % 2));
        append(town, house, {glm::dmat3(1.0), {step(2, 2) - 1, step(3, 2) - 1, 0}});
    }
    builder.place_at(builder.mesh(town, materials), {0.1, 0.2, 0});
    builder.model.lights = {scenes::sun(2, {1, 2, -3})};
    const Model& whole = builder.finish();
    Model parts = whole;
    group::LooseOptions options;
    options.always = true;
    options.fewest_triangles = 100;
    ASSERT_EQ(group::split_loose_parts(parts, group::leaves_of(parts), options, {}).split, 1u);
    summarize_assemblies(parts, bottom_up(parts));
    View view = scenes::above(64, 64);
    view.pixel_error = 0;
    ExportOptions export_options;
    export_options.folder = scratch("loose_whole");
    const scenes::Image first = scenes::render(whole, view, export_options);
    export_options.folder = scratch("loose_parts");
    const scenes::Image second = scenes::render(parts, view, export_options);
    size_t covered = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            EXPECT_EQ(first.at(x, y), second.at(x, y)) << x << ' ' << y;
            covered += first.at(x, y).x > 0 ? 1 : 0;
        }
    }
    EXPECT_GT(covered, 500u);
}
