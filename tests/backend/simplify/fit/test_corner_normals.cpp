// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what simplified surfaces look like in the light: shaded as their originals are.
#include "scenes/fine_grids.h"
#include "scenes/small_meshes.h"
#include "simplify/simplify.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace lodestone;

namespace {

/// A vertex at each place, its normal the mean of what lies around it.
Mesh smooth(const Mesh& mesh) {
    const std::vector<uint32_t> first = weld(mesh);
    Mesh out = mesh;
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
    for (size_t i = 0; i < out.triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            uint32_t& at = out.triangles[i][corner];
            at = first[at];
            sums[at] += area_vector(mesh, i);
        }
    }
    out.normals.assign(mesh.positions.size(), glm::vec3(0, 0, 1));
    for (size_t v = 0; v < sums.size(); ++v) {
        if (glm::length(sums[v]) > 0)
            out.normals[v] = glm::vec3(glm::normalize(sums[v]));
    }
    return out;
}

/// Cosine between what the middle of a triangle shows and the side of a cube it lies on.
double shown_in_the_middle(const Mesh& mesh, size_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    const glm::vec3 sum = mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z];
    return glm::dot(glm::normalize(glm::dvec3(sum)), glm::normalize(area_vector(mesh, triangle)));
}

}  // namespace

TEST(CornerNormals, FlatSidesOfASmoothlyShadedCubeStayEvenlyLit) {
    const Mesh mesh = smooth(shapes::fine_cube(40));
    const size_t targets[] = {2000, 400, 48, 12};
    for (const Mesh& level : simplify::simplify_chain(mesh, targets)) {
        SCOPED_TRACE(level.triangles.size());
        double lit = 0;
        for (size_t i = 0; i < level.triangles.size(); ++i) {
            if (shown_in_the_middle(level, i) > 0.995)
                lit += glm::length(area_vector(level, i));
        }
        // The rims of the original are a tenth of it.
        EXPECT_GT(lit, 0.9 * surface_area(level));
        for (const glm::vec3& normal : level.normals)
            EXPECT_NEAR(glm::length(normal), 1, 1e-5);
    }
}

TEST(CornerNormals, CornersThatComeOutAlikeShareAVertex) {
    const Mesh level = simplify::simplify_mesh(smooth(shapes::fine_cube(40)), 12);
    ASSERT_EQ(level.triangles.size(), 12u);
    EXPECT_LE(level.positions.size(), 24u);
}

TEST(CornerNormals, RoundThingsAreHardlySplit) {
    for (const auto mode : {simplify::SimplifyMode::Fast, simplify::SimplifyMode::Best}) {
        simplify::SimplifyOptions options;
        options.mode = mode;
        const Mesh ball = simplify::simplify_mesh(smooth(shapes::sphere(1, 5)), 500, options);
        EXPECT_EQ(ball.positions.size(), ball.triangles.size() / 2 + 2);
        const Mesh ring = simplify::simplify_mesh(smooth(shapes::torus(120, 60)), 600, options);
        EXPECT_LE(ring.positions.size(), 0.65 * static_cast<double>(ring.triangles.size()));
    }
}
