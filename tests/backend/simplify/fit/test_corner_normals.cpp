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

TEST(CornerNormals, CoarseLevelsOfLumpsAreShadedLikeThem) {
    // Lumps that a level of 300 triangles cannot follow: its corners had the normals of points.
    Mesh lumpy = shapes::sphere(1, 5);
    for (glm::vec3& p : lumpy.positions)
        p *= 1 + 0.15f * std::sin(5 * p.x) * std::sin(4 * p.y + 1) * std::sin(6 * p.z + 2);
    const Mesh original = smooth(lumpy);
    const Mesh level = simplify::simplify_mesh(original, 300);
    double off = 0;
    double area = 0;
    for (size_t i = 0; i < level.triangles.size(); ++i) {
        const Triangle& t = level.triangles[i];
        const glm::vec3 middle =
            (level.positions[t.x] + level.positions[t.y] + level.positions[t.z]) / 3.0f;
        size_t nearest = 0;
        for (size_t v = 0; v < original.positions.size(); ++v) {
            if (glm::distance(original.positions[v], middle) <
                glm::distance(original.positions[nearest], middle))
                nearest = v;
        }
        const glm::vec3 shown =
            glm::normalize(level.normals[t.x] + level.normals[t.y] + level.normals[t.z]);
        const double weight = glm::length(area_vector(level, i));
        off += weight * glm::distance(shown, original.normals[nearest]);
        area += weight;
    }
    EXPECT_LT(off / area, 0.175);  // .178 with the normals of points, .16 with facets
}

TEST(CornerNormals, CoarseLevelsOfLumpsHaveNoFacets) {
    // Each triangle had normals of its own where it was far off: what is smooth fell into plates.
    Mesh lumpy = shapes::sphere(1, 5);
    for (glm::vec3& p : lumpy.positions)
        p *= 1 + 0.15f * std::sin(5 * p.x) * std::sin(4 * p.y + 1) * std::sin(6 * p.z + 2);
    const Mesh level = simplify::simplify_mesh(smooth(lumpy), 300);
    EXPECT_LE(level.positions.size(), 0.6 * static_cast<double>(level.triangles.size()));
}

TEST(CornerNormals, RoughThingsKeepTheirReliefInTheLight) {
    // Most triangles of a rough terrain kept wedges that blend its gullies away: only where their
    // own normals left less than a quarter of what was off were they better.
    Mesh rough = shapes::grid(160);
    for (glm::vec3& p : rough.positions)
        p.z = 0.01f * (std::sin(90 * p.x + 3 * p.y) * std::sin(110 * p.y) +
                       0.5f * std::sin(230 * p.x) * std::sin(190 * p.y + 50 * p.x));
    const Mesh level = simplify::simplify_mesh(smooth(rough), 5000);
    EXPECT_GT(level.positions.size(), 2.5 * static_cast<double>(level.triangles.size()));
}

TEST(CornerNormals, RoundThingsWithARidgeHaveNoPlates) {
    // Half of the triangles beside the ridge, of a brow, had one normal each: they curve.
    Mesh ridged = shapes::sphere(1, 6);
    for (glm::vec3& p : ridged.positions)
        p *= 1 + 0.12f * std::exp(-std::pow((p.z - 0.3f) / 0.06f, 2.0f));
    for (const size_t target : {500, 300, 150}) {
        const Mesh level = simplify::simplify_mesh(smooth(ridged), target);
        double plates = 0;
        for (size_t i = 0; i < level.triangles.size(); ++i) {
            const Triangle& t = level.triangles[i];
            const bool one = glm::dot(level.normals[t.x], level.normals[t.y]) > 0.9999f &&
                             glm::dot(level.normals[t.x], level.normals[t.z]) > 0.9999f;
            plates += one ? 0.5 * glm::length(area_vector(level, i)) : 0;
        }
        EXPECT_LT(plates, 0.015 * surface_area(level)) << target << " triangles";
        EXPECT_LE(level.positions.size(), 0.65 * static_cast<double>(target));
    }
}

TEST(CornerNormals, ARoughPlainIsLitByItsMeanNormal) {
    // Each vertex of a coarse level had the normal of one point, up to 20 degrees off.
    Mesh rough = shapes::grid(200);
    uint32_t bits = 1;
    for (glm::vec3& p : rough.positions) {
        bits = 1664525 * bits + 1013904223;
        p.z = 0.001f * static_cast<float>(bits >> 16) / 65536.0f;
    }
    const Mesh level = simplify::simplify_mesh(smooth(rough), 60);
    double up = 1;
    for (const glm::vec3& normal : level.normals)
        up = std::min(up, double{normal.z});
    EXPECT_GT(up, 0.997);  // 4.5 degrees
}
