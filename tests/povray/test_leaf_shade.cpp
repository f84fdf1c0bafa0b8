// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the sky's light on what is cut out of leaves.
#include "povray/mask_cards.h"
#include "povray/povray_scenes.h"
#include "scenes/with_rays.h"

#include <regex>
#include <set>

using namespace lodestone;
using namespace lodestone::povray;

class LeafShade : public WithRays {};

// Leaves had one shade each, of a large card too.
TEST_F(LeafShade, PartsOfACutLeafHaveTheShadeOfTheirPlaces) {
    scenes::Builder builder;
    builder.model.world.color = glm::dvec3(0.5);
    builder.place(builder.mesh(card(), {builder.material(leaf(disk()))}));
    builder.place(builder.mesh(shapes::box({-9, -9, 0.05}, {0.5, 9, 0.1})));
    builder.place(builder.mesh(shapes::quad(40, 40)), {glm::dmat3(1.0), {-20, -20, -0.01}});
    ExportOptions options;
    options.folder = own_scratch() / "scene";
    std::filesystem::remove_all(options.folder);
    Problems problems;
    scenes::write(builder.finish(), scenes::above(), options, problems);
    std::set<std::string> shades;
    const std::regex ambient("ambient rgb <[^>]*>");
    for (const auto& file : std::filesystem::directory_iterator(options.folder / "r")) {
        const std::string text = read_file(file.path());
        if (text.find("image_map") == std::string::npos)
            continue;  // not the leaf
        for (std::sregex_iterator i(text.begin(), text.end(), ambient), end; i != end; ++i)
            shades.insert(i->str());
    }
    EXPECT_GT(shades.size(), 6u);
}
