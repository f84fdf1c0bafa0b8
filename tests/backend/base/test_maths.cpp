// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the small maths: transforms, bounds, eigen-decomposition.
#include "base/maths.h"

#include <glm/gtc/matrix_transform.hpp>

#include <gtest/gtest.h>

using namespace lodestone;

namespace {

Affine turned(double angle, const glm::dvec3& axis) {
    return {glm::dmat3(glm::rotate(glm::dmat4(1.0), angle, axis)), glm::dvec3(0.0)};
}

}  // namespace

TEST(Maths, RowsRoundTrip) {
    const double rows[12] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    double back[12];
    Affine::from_rows(rows).to_rows(back);
    for (int i = 0; i < 12; ++i)
        EXPECT_EQ(rows[i], back[i]);
    EXPECT_EQ(Affine::from_rows(rows)(glm::dvec3(1, 1, 1)), glm::dvec3(10, 26, 42));
}

TEST(Maths, StretchIsTheLargestSingularValue) {
    Affine scale;
    scale.linear = glm::dmat3(2, 0, 0, 0, 5, 0, 0, 0, -3);
    const Affine rotation = turned(0.7, glm::normalize(glm::dvec3(1, 2, 3)));
    EXPECT_NEAR(stretch(rotation * scale * rotation), 5, 1e-12);
    EXPECT_NEAR(stretch(rotation), 1, 1e-12);
}

TEST(Maths, EigenFindsAxesOfATurnedDiagonal) {
    const glm::dmat3 r = turned(1.1, glm::normalize(glm::dvec3(3, -1, 2))).linear;
    const glm::dmat3 diagonal(1, 0, 0, 0, 9, 0, 0, 0, 4);
    const SymmetricEigen eigen = eigen_symmetric(r * diagonal * glm::transpose(r));
    EXPECT_NEAR(eigen.values.x, 9, 1e-12);
    EXPECT_NEAR(eigen.values.y, 4, 1e-12);
    EXPECT_NEAR(eigen.values.z, 1, 1e-12);
    EXPECT_NEAR(std::abs(glm::dot(eigen.axes[0], r[1])), 1, 1e-12);
    EXPECT_NEAR(glm::determinant(eigen.axes), 1, 1e-12);
}

TEST(Maths, BoundDistanceIsTheLargerOfSphereAndBox) {
    const glm::vec3 points[] = {{-10, -1, 0}, {10, 1, 0}};
    const Bound bound = bound_of(points);
    EXPECT_NEAR(distance(bound, {0, 5, 0}), 4, 1e-9);  // the box is nearer to the truth
    EXPECT_NEAR(distance(bound, {20, 5, 0}), std::hypot(10, 4), 1e-9);
    EXPECT_EQ(distance(bound, {0, 0.5, 0}), 0);
    EXPECT_TRUE(bound_of({}).empty());
}

TEST(Maths, MergedBoundContainsBoth) {
    Affine far;
    far.offset = {100, 0, 0};
    const glm::vec3 points[] = {{-1, -1, -1}, {1, 1, 1}};
    const Bound a = bound_of(points);
    const Bound both = merged(a, transformed(a, far));
    EXPECT_NEAR(both.box.high.x, 101, 1e-9);
    EXPECT_GE(both.radius + 1e-9, glm::length(glm::dvec3(101, 1, 1) - both.center));
    EXPECT_EQ(merged(Bound{}, a).radius, a.radius);
}

TEST(Maths, TransformedBoxIsThatOfItsEightCornersToTheLastBit) {
    const glm::vec3 points[] = {{-3.1f, 0.7f, -0.01f}, {1.9f, 2.3f, 57.0f}};
    const Bound bound = bound_of(points);
    for (int i = 0; i < 50; ++i) {
        Affine skewed = turned(0.37 * i, glm::normalize(glm::dvec3(1, 0.1 * i, -2)));
        skewed.linear[0] *= 1 + i;
        skewed.linear[1] += 0.3 * skewed.linear[2];
        skewed.linear[2] *= i % 2 == 0 ? -1 : 1e-3;
        skewed.offset = {1e3 * i, -7.0 / 3, 1e-5};
        Box3 corners;
        for (int corner = 0; corner < 8; ++corner)
            corners.add(skewed({(corner & 1) != 0 ? bound.box.high.x : bound.box.low.x,
                                (corner & 2) != 0 ? bound.box.high.y : bound.box.low.y,
                                (corner & 4) != 0 ? bound.box.high.z : bound.box.low.z}));
        const Bound moved = transformed(bound, skewed);
        EXPECT_EQ(moved.box.low, corners.low) << i;
        EXPECT_EQ(moved.box.high, corners.high) << i;
        EXPECT_EQ(moved.radius, bound.radius * stretch(skewed));
    }
    EXPECT_TRUE(transformed(Bound{}, turned(1, {0, 0, 1})).empty());
}

TEST(Maths, BoxContainsItsFacesAndNothingBeyond) {
    Box3 box;
    EXPECT_FALSE(box.contains({0, 0, 0}));
    box.add({1, 2, 3});
    box.add({2, 4, 6});
    EXPECT_TRUE(box.contains({1, 4, 4}));
    EXPECT_FALSE(box.contains({1, 4, 6.5}));
    EXPECT_FALSE(box.contains({1, std::nan(""), 4}));
}

TEST(Maths, TheLongestAxisIsTheFirstOfThoseThatAreAsLong) {
    const auto axis_of = [](const glm::dvec3& size) {
        Box3 box;
        box.add(glm::dvec3(1));
        box.add(glm::dvec3(1) + size);
        return box.longest_axis();
    };
    EXPECT_EQ(Box3().longest_axis(), 0);
    EXPECT_EQ(axis_of({0, 0, 0}), 0);
    EXPECT_EQ(axis_of({3, 2, 1}), 0);
    EXPECT_EQ(axis_of({2, 3, 3}), 1);
    EXPECT_EQ(axis_of({1, 2, 3}), 2);
}
