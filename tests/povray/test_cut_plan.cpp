// SPDX-License-Identifier: GPL-3.0-or-later
// Guards how finely the masks of a crowd are outlined.
#include "povray/mask_cards.h"

using namespace lodestone;
using namespace lodestone::povray;

// Trees some pixels large became more triangles than the picture had pixels.
TEST(CutPlan, ACrowdIsCutHalfAsFinely) {
    const Texture flower = alpha_of(256, [](double u, double v) {
        const double x = u - 0.5;
        const double y = v - 0.5;
        const double edge = 0.35 + 0.06 * std::sin(9 * std::atan2(y, x));
        return std::hypot(x, y) < edge ? 1 : 0;
    });
    const auto cards = [](int count) {
        Mesh mesh;
        for (int i = 0; i < count; ++i)
            append(mesh, card(), {glm::dmat3(1.0), {0, 0, 0.1 * i}});
        return mesh;
    };
    const auto each = [&](int count, std::optional<int> outline) {
        const CutMesh found = cut(cards(count), leaf(flower), outline);
        EXPECT_NEAR(surface_area(found.mesh) / count, flower.picture->mean.w,
                    0.03 * flower.picture->mean.w);
        return static_cast<double>(found.mesh.triangles.size()) / count;
    };
    const int outline = outline_step(4.0 / 256);  // four texels of a card of one metre
    EXPECT_LT(each(32, outline), 0.8 * each(31, outline));
    EXPECT_EQ(each(32, outline), each(31, outline_step(8.0 / 256)));
    // Texels are the finest that anybody sees.
    EXPECT_EQ(each(32, {}), each(31, {}));
    EXPECT_EQ(each(32, outline_step(0.4 / 256)), each(31, {}));
}
