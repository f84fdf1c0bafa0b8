// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the parts of a mesh: each triangle is in one part that is not halved, within its box.
#include "geometry/part_tree.h"
#include "scenes/small_meshes.h"

#include <gtest/gtest.h>
#include <limits>

using namespace lodestone;
using geometry::PartTree;

TEST(PartTree, NothingHasNoPartsAndAFewTrianglesAreOne) {
    EXPECT_TRUE(PartTree(Mesh{}).parts().empty());
    const PartTree quad(shapes::quad(2, 1));
    ASSERT_EQ(quad.parts().size(), 1u);
    EXPECT_TRUE(quad.leaf(0));
    EXPECT_EQ(quad.triangles(quad.parts()[0]).size(), 2u);
    EXPECT_EQ(quad.parts()[0].box.high, glm::dvec3(2, 1, 0));
}

TEST(PartTree, EveryTriangleLiesInOnePartThatIsNotHalved) {
    const Mesh mesh = shapes::sphere(2, 4);
    const PartTree tree(mesh);
    std::vector<int> count(mesh.triangles.size(), 0);
    for (size_t i = 0; i < tree.parts().size(); ++i) {
        const geometry::MeshPart& part = tree.parts()[i];
        Box3 box;
        for (const uint32_t triangle : tree.triangles(part)) {
            count[triangle] += tree.leaf(i) ? 1 : 0;
            for (int corner = 0; corner < 3; ++corner)
                box.add(glm::dvec3(mesh.positions[mesh.triangles[triangle][corner]]));
        }
        EXPECT_EQ(box.low, part.box.low);
        EXPECT_EQ(box.high, part.box.high);
        EXPECT_EQ(tree.leaf(i), tree.triangles(part).size() <= PartTree::kFewTogether);
        if (!tree.leaf(i)) {  // the halves lie one behind the other, and are all of it
            const geometry::MeshPart& first = tree.parts()[i + 1];
            const geometry::MeshPart& second = tree.parts()[first.next];
            EXPECT_EQ(first.begin, part.begin);
            EXPECT_EQ(first.end, second.begin);
            EXPECT_EQ(second.end, part.end);
            EXPECT_EQ(second.next, part.next);
        }
    }
    for (const int times : count)
        EXPECT_EQ(times, 1);
}

TEST(PartTree, TheSameMeshGivesTheSameTree) {
    const Mesh mesh = shapes::torus(40, 20);
    const PartTree a(mesh);
    const PartTree b(mesh);
    ASSERT_EQ(a.parts().size(), b.parts().size());
    for (size_t i = 0; i < a.parts().size(); ++i) {
        const auto ours = a.triangles(a.parts()[i]);
        const auto theirs = b.triangles(b.parts()[i]);
        EXPECT_TRUE(std::equal(ours.begin(), ours.end(), theirs.begin(), theirs.end()));
    }
}

TEST(PartTree, TrianglesOnOnePlaceAreHalvedAllTheSame) {
    Mesh mesh = shapes::quad(1, 1);
    const std::vector<Triangle> two = mesh.triangles;
    for (int i = 0; i < 500; ++i)
        mesh.triangles.insert(mesh.triangles.end(), two.begin(), two.end());
    const PartTree tree(mesh);
    EXPECT_EQ(tree.parts()[0].end, mesh.triangles.size());
    EXPECT_FALSE(tree.leaf(0));
}

TEST(PartTree, PlacesThatAreNoNumbersHarmNobody) {
    Mesh mesh = shapes::sphere(1, 3);
    const float bad[] = {std::numeric_limits<float>::quiet_NaN(),
                         std::numeric_limits<float>::infinity(), -1e38f, 3e38f};
    for (size_t i = 0; i < mesh.positions.size(); i += 3)
        mesh.positions[i][static_cast<int>(i % 3)] = bad[i / 3 % 4];
    const PartTree tree(mesh);
    size_t count = 0;
    for (size_t i = 0; i < tree.parts().size(); ++i)
        count += tree.leaf(i) ? tree.triangles(tree.parts()[i]).size() : 0;
    EXPECT_EQ(count, mesh.triangles.size());
}
