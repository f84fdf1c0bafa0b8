// SPDX-License-Identifier: GPL-3.0-or-later
// Guards how many rays find the sky's light for pictures of different sizes.
#include "povray/povray_scenes.h"
#include "povray_export/lamp/sky_occlusion.h"
#include "scenes/with_rays.h"

#include <set>

using namespace lodestone;
using namespace lodestone::povray;

class SkyRays : public WithRays {};

TEST_F(SkyRays, ALargerPictureHasMoreAndASmallerOneKeepsThem) {
    std::filesystem::remove_all(own_scratch());  // with what an earlier run kept
    scenes::Builder builder;
    builder.model.world.color = glm::dvec3(0.5);
    builder.place(builder.mesh(shapes::sphere(1, 4)));
    const choose::Cut cut = choose::choose_cut(builder.finish(), scenes::above());
    Problems problems;
    std::set<Hash> hashes;
    SkyOcclusionOptions options;
    options.file = own_scratch() / "sky_light.bin";
    const auto rays = [&](double pixels) {
        options.pixels = pixels;
        const SkyLightPtr light = SkyOcclusion(builder.model, cut, options, problems, {}).of(0);
        hashes.insert(light->hash);
        return light->shares->rays;
    };
    EXPECT_EQ(std::vector({rays(100), rays(1e6), rays(100)}), (std::vector{16u, 64u, 64u}));
    EXPECT_EQ(hashes.size(), 2u);  // each has a file of its own
}
