// SPDX-License-Identifier: GPL-3.0-or-later
// Guards height maps: the slopes of what is found are those of the normal map.
#include "povray/povray_scenes.h"
#include "povray_export/texture/height_map.h"

using namespace lodestone;
using namespace lodestone::povray;

namespace {

/// Normal map of heights (in widths of a texel) given by their slopes across and down.
template <typename Slope>
Texture normals(int width, int height, const Slope& slope) {
    std::vector<glm::vec4> texels;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const glm::dvec2 s = slope(x, y);
            const glm::dvec3 n = glm::normalize(glm::dvec3(-s.x, s.y, 1));
            texels.emplace_back(glm::vec3(0.5 + 0.5 * n), 1);
        }
    }
    Texture texture;
    texture.picture = scenes::picture(width, texels);
    return texture;
}

/// Height of a texel in widths of one.
double at(const HeightMap& map, int x, int y) {
    return map.range * map.values[static_cast<size_t>(y) * static_cast<size_t>(map.width) +
                                  static_cast<size_t>(x)];
}

}  // namespace

TEST(HeightMap, FlatNormalsAreAFlatSurface) {
    const auto map = height_map(normals(4, 4, [](int, int) { return glm::dvec2(0); }));
    EXPECT_NEAR(map->range, 0, 0.03);  // 8 bits have no middle
}

TEST(HeightMap, HillsAreFoundAgain) {
    const double turn = 2 * kPi / 64;
    const auto hills = [=](double x, double y) {
        return 5 * std::sin(turn * x) + 2 * std::cos(3 * turn * y + turn * x);
    };
    const auto map = height_map(normals(64, 64, [&](int x, int y) {
        return glm::dvec2(hills(x + 0.5, y) - hills(x - 0.5, y),
                          hills(x, y + 0.5) - hills(x, y - 0.5));
    }));
    ASSERT_EQ(map->width, 64);
    ASSERT_EQ(map->height, 64);
    const double base = at(*map, 0, 0) - hills(0, 0);
    for (int y = 0; y < 64; y += 5) {
        for (int x = 0; x < 64; x += 3)
            EXPECT_NEAR(at(*map, x, y) - base, hills(x, y), 0.15) << x << ' ' << y;
    }
}

TEST(HeightMap, AnySizeBecomesAPowerOfTwoOfAtMost1024) {
    const auto bump = [](int x, int) { return glm::dvec2(x % 2 == 0 ? 0.5 : -0.5, 0); };
    auto map = height_map(normals(1, 3, bump));
    EXPECT_EQ(map->width, 2);
    EXPECT_EQ(map->height, 4);
    map = height_map(normals(1500, 5, bump));
    EXPECT_EQ(map->width, 1024);
    EXPECT_EQ(map->height, 8);
    for (const float value : map->values)
        ASSERT_TRUE(value >= 0 && value <= 1);
}

TEST(HeightMap, TheGrayOfItsPictureIsItsHeight) {
    HeightMap map;
    map.width = 256;
    map.height = 4;
    for (int i = 0; i < 1024; ++i)
        map.values.push_back(static_cast<float>(i) / 1023.0F);
    const image::Image image = image::read(png_of(map), "map");
    for (size_t i = 0; i < 1024; ++i) {
        const float* texel = image.pixels.data() + 4 * i;
        const double gray = .297 * texel[0] + .589 * texel[1] + .114 * texel[2];
        EXPECT_NEAR(gray, static_cast<double>(i) / 1023.0, 0.13 / 255) << i;
    }
}
