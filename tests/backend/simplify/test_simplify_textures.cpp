// SPDX-License-Identifier: GPL-3.0-or-later
// Guards texture coordinates in simplification: textures stay where they are on a surface.
#include "scenes/fine_grids.h"
#include "simplify/collapse/attribute_kink.h"
#include "simplify/simplify.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

using namespace lodestone;
using simplify::SimplifyMode;
using simplify::SimplifyOptions;

namespace {

/// How far the texture coordinates of a level are from f(position), at most and in the mean over
/// its area, at 15 places of each triangle.
template <typename F>
std::pair<double, double> slip(const Mesh& level, const F& f) {
    double most = 0;
    double sum = 0;
    double area = 0;
    for (size_t i = 0; i < level.triangles.size(); ++i) {
        const Triangle& t = level.triangles[i];
        double here = 0;
        for (int a = 0; a <= 4; ++a) {
            for (int b = 0; a + b <= 4; ++b) {
                const glm::vec3 w = glm::vec3(a, b, 4 - a - b) * 0.25f;
                const glm::vec3 place = w.x * level.positions[t.x] + w.y * level.positions[t.y] +
                                        w.z * level.positions[t.z];
                const glm::vec2 uv =
                    w.x * level.uvs[t.x] + w.y * level.uvs[t.y] + w.z * level.uvs[t.z];
                const double off = glm::length(uv - f(place));
                most = std::max(most, off);
                here += off / 15;
            }
        }
        const double weight = glm::length(area_vector(level, i));
        sum += weight * here;
        area += weight;
    }
    return {most, sum / area};
}

Mesh textured(Mesh mesh, glm::vec2 (*map)(const glm::vec3&)) {
    for (const glm::vec3& p : mesh.positions)
        mesh.uvs.push_back(map(p));
    return mesh;
}

/// Three times as fast to the right of x = 1/2.
glm::vec2 stretched(const glm::vec3& p) {
    return {p.x < 0.5f ? p.x : 3 * p.x - 1, p.y};
}

}  // namespace

TEST(SimplifyTextures, TexturesDoNotSlideWhenVerticesAreFitted) {
    const auto from_above = [](const glm::vec3& p) { return glm::vec2(p.x, p.y); };
    const Mesh mesh = textured(shapes::terrain(60), from_above);
    for (const SimplifyMode mode : {SimplifyMode::Fast, SimplifyMode::Best}) {
        SimplifyOptions options;
        options.mode = mode;
        for (const size_t target : {1800, 360, 100}) {
            const Mesh level = simplify::simplify_mesh(mesh, target, options);
            const auto [most, mean] = slip(level, from_above);
            SCOPED_TRACE(testing::Message()
                         << "mode " << static_cast<int>(mode) << ", " << target << " triangles");
            EXPECT_LT(mean, 0.002);
            EXPECT_LT(most, 0.02);
        }
    }
}

TEST(SimplifyTextures, FlatSurfacesKeepWhereTheirTextureIsStretched) {
    const Mesh mesh = textured(shapes::grid(40), stretched);
    const Mesh level = simplify::simplify_mesh(mesh, 60);
    ASSERT_LE(level.triangles.size(), 60u);
    EXPECT_LT(slip(level, stretched).second, 0.005);
    SimplifyOptions sliding;
    sliding.seam_weight = 0;
    const Mesh slid = simplify::simplify_mesh(mesh, 60, sliding);
    EXPECT_GT(slip(slid, stretched).second, 4 * slip(level, stretched).second);
}

TEST(SimplifyTextures, IslandsDoNotMix) {
    // Two halves of a plane whose textures lie far apart, mirrored.
    const auto left = [](const glm::vec3& p) { return glm::vec2(0.1f * p.x, 0.1f * p.y); };
    const auto right = [](const glm::vec3& p) { return glm::vec2(7 - 0.1f * p.x, 0.1f * p.y); };
    Mesh mesh;
    for (int half = 0; half < 2; ++half) {
        Mesh side = shapes::terrain(40);
        for (glm::vec3& p : side.positions)
            p.x = 0.5f * (p.x + static_cast<float>(half));
        append(mesh, textured(side, half == 0 ? +left : +right), Affine{});
    }
    SimplifyOptions options;
    options.mode = SimplifyMode::Best;
    const Mesh level = simplify::simplify_mesh(mesh, 300, options);
    const auto [most, mean] =
        slip(level, [&](const glm::vec3& p) { return p.x < 0.5f ? left(p) : right(p); });
    (void)most;  // a place on the border belongs to either
    double mixed = 0;
    for (const Triangle& t : level.triangles)
        mixed += (level.uvs[t.x].x > 3) != (level.uvs[t.y].x > 3) ||
                 (level.uvs[t.x].x > 3) != (level.uvs[t.z].x > 3);
    EXPECT_EQ(mixed, 0);
    EXPECT_LT(mean, 0.1);  // the border moves by a hundredth of the width at most
    for (const glm::vec2& uv : level.uvs) {
        EXPECT_TRUE((uv.x > -0.01f && uv.x < 0.06f) || (uv.x > 6.89f && uv.x < 6.96f)) << uv.x;
    }
}

TEST(SimplifyTextures, CoordinatesWithoutMeaningDoNoHarm) {
    Mesh mesh = textured(shapes::terrain(30), stretched);
    for (size_t v = 0; v < mesh.uvs.size(); v += 7)
        mesh.uvs[v] = v % 2 == 0 ? glm::vec2(3e38f, -3e38f) : glm::vec2(0.0f);
    for (const SimplifyMode mode : {SimplifyMode::Fast, SimplifyMode::Best}) {
        SimplifyOptions options;
        options.mode = mode;
        const Mesh level = simplify::simplify_mesh(mesh, 200, options);
        ASSERT_NO_THROW(check(level));
        EXPECT_LE(level.triangles.size(), 200u);
        for (const glm::vec3& p : level.positions)
            EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
        for (const glm::vec2& uv : level.uvs)
            EXPECT_TRUE(std::isfinite(uv.x) && std::isfinite(uv.y));
    }
}
