// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the places that rays are aimed at: on any triangle, and mostly on those that face the eye.
#include "light/seen/random_place.h"
#include "scenes/small_meshes.h"

#include <gtest/gtest.h>
#include <numeric>
#include <set>

using namespace lodestone;
using light::RandomPlace;

namespace {

std::vector<uint32_t> all_of(const Mesh& mesh) {
    std::vector<uint32_t> out(mesh.triangles.size());
    std::iota(out.begin(), out.end(), 0u);
    return out;
}

}  // namespace

TEST(RandomPlace, TheOnlyTriangleIsTakenWhicheverWayItFaces) {
    const Mesh mesh = shapes::quad(1, 1);
    const std::vector<uint32_t> one = {1};
    PcgRandom random(1, 2);
    RandomPlace place(mesh, {}, random);
    EXPECT_EQ(place.one_of(one, {0, 0, 1}), 1u);
    EXPECT_EQ(place.one_of(one, {0, 0, -1}), 1u);
    const glm::dvec3 at = place.point_on(1);
    EXPECT_NEAR(at.z, 0, 1e-12);
    EXPECT_TRUE(at.x >= 0 && at.x <= 1 && at.y >= 0 && at.y <= 1);
}

// A lamp the size of a pixel was missed by four rays of eight: they went to its back.
TEST(RandomPlace, MostTrianglesFaceTheWay) {
    const Mesh mesh = shapes::cube();
    const std::vector<uint32_t> all = all_of(mesh);
    // Mirrored, as placements may be: it is the side in the world that counts.
    for (const double side : {1.0, -1.0}) {
        const Affine world{{2, 0, 0, 0, 3, 0, 0, 0, side}, {5, 6, 7}};
        PcgRandom random(1, 2);
        RandomPlace place(mesh, world, random);
        std::set<uint32_t> met;
        int facing = 0;
        for (int i = 0; i < 1000; ++i) {
            const uint32_t triangle = place.one_of(all, {0, 0, 1});
            met.insert(triangle);
            const Triangle& t = mesh.triangles[triangle];
            const glm::dvec3 a = world(glm::dvec3(mesh.positions[t.x]));
            const glm::dvec3 b = world(glm::dvec3(mesh.positions[t.y]));
            const glm::dvec3 c = world(glm::dvec3(mesh.positions[t.z]));
            facing += glm::cross(b - a, c - a).z > 0 ? 1 : 0;
        }
        EXPECT_GT(facing, 400) << side;  // a sixth of all would be 167
        EXPECT_EQ(met.size(), all.size()) << side;
    }
}
