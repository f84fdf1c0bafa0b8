// SPDX-License-Identifier: GPL-3.0-or-later
// Guards replacement: boxes and ellipsoids keep area, centroid and variances, or are refused; by
// closed forms, and measured again by rays as what they stand for was.
#include "base/random.h"
#include "measure/visible/visible_attributes.h"
#include "scenes/small_meshes.h"
#include "solids/solid_replacement.h"
#include "solids/stand_in_material.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

using namespace lodestone;
using namespace lodestone::solids;

namespace {

glm::dmat3 turn(double angle, glm::dvec3 axis) {
    axis = glm::normalize(axis);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const glm::dmat3 cross({0, axis.z, -axis.y}, {-axis.z, 0, axis.x}, {axis.y, -axis.x, 0});
    return glm::dmat3(c) + s * cross + (1 - c) * glm::outerProduct(axis, axis);
}

Attributes attributes_of(const ShellMoments& shell, const glm::dmat3& axes,
                         const glm::dvec3& center) {
    Attributes out;
    out.visible_area = out.surface_area = shell.area;
    out.centroid = center;
    glm::dmat3 along(0.0);
    for (int i = 0; i < 3; ++i)
        along[i][i] = shell.area * shell.variances[i];
    out.moments = axes * along * glm::transpose(axes);
    out.axes = eigen_symmetric(out.moments).axes;
    return out;
}

/// Of a mesh as if all of it could be seen: triangles 1/12 at the vertices, 3/4 at the middle.
/// Open sheets count both sides.
Attributes attributes_of(const Mesh& mesh, double sides) {
    Attributes out;
    glm::dmat3 second(0.0);
    glm::dvec3 first(0.0);
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const double area = sides * 0.5 * glm::length(area_vector(mesh, i));
        glm::dvec3 middle(0.0);
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 p(mesh.positions[mesh.triangles[i][corner]]);
            middle += p / 3.0;
            second += area / 12 * glm::outerProduct(p, p);
        }
        second += 0.75 * area * glm::outerProduct(middle, middle);
        first += area * middle;
        out.visible_area += area;
    }
    out.centroid = first / out.visible_area;
    out.moments = second - out.visible_area * glm::outerProduct(out.centroid, out.centroid);
    out.axes = eigen_symmetric(out.moments).axes;
    return out;
}

glm::dvec3 sorted(glm::dvec3 v) {
    std::sort(&v[0], &v[0] + 3);
    return v;
}

double worst(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

Mesh spheres(int count, double radius, double apart) {
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        Affine shift;
        shift.offset = {i * apart, 0, 0};
        append(mesh, shapes::sphere(radius, 2), shift);
    }
    return mesh;
}

/// Area, centroid and shape of the tensor are those asked for.
void expect_matched(const Primitive& p, const ShellMoments& shell, const Attributes& wanted,
                    double tolerance) {
    EXPECT_NEAR(shell.area, wanted.visible_area, 1e-9 * wanted.visible_area);
    EXPECT_LT(glm::length(p.center - wanted.centroid), 1e-12);
    const glm::dmat3 got = attributes_of(shell, p.axes, p.center).moments;
    const double trace_got = got[0][0] + got[1][1] + got[2][2];
    const double trace = wanted.moments[0][0] + wanted.moments[1][1] + wanted.moments[2][2];
    for (int i = 0; i < 3; ++i)
        EXPECT_LT(worst(got[i] / trace_got - wanted.moments[i] / trace), tolerance);
    EXPECT_NEAR(glm::determinant(p.axes), 1, 1e-9);
}

Attributes by_rays(const Mesh& mesh, uint64_t rays, uint64_t seed) {
    measure::VisibleOptions options;
    options.rays = rays;
    options.seed = seed;
    return measure::measure_visible(mesh, {}, options).attributes;
}

/// Measures what was fitted as its original was, with other rays: what a viewer would find.
void expect_remeasured(const Primitive& p, const Mesh& mesh, const Attributes& wanted) {
    const double radius = wanted.radius_of_gyration();
    const double trace = wanted.moments[0][0] + wanted.moments[1][1] + wanted.moments[2][2];
    for (const uint64_t seed : {101u, 102u, 103u}) {
        const Attributes got = by_rays(mesh, 16384, seed);
        EXPECT_NEAR(got.visible_area / wanted.visible_area, 1, 0.01);
        EXPECT_LT(glm::length(got.centroid - wanted.centroid), 0.01 * radius);
        const double trace_got = got.moments[0][0] + got.moments[1][1] + got.moments[2][2];
        double square = 0;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 miss = got.moments[i] / trace_got - wanted.moments[i] / trace;
            square += glm::dot(miss, miss);
        }
        EXPECT_LT(std::sqrt(square), 0.05)
            << "half sizes " << p.half_size.x << " " << p.half_size.y << " " << p.half_size.z;
    }
}

double trace_of(const Attributes& attributes) {
    return attributes.moments[0][0] + attributes.moments[1][1] + attributes.moments[2][2];
}

/// Within .5 % in area, .1 % of the radius of gyration, 1 % in the tensor's shape.
void expect_finely_remeasured(const Attributes& got, const Attributes& wanted) {
    EXPECT_NEAR(got.visible_area / wanted.visible_area, 1, 0.005);
    EXPECT_LT(glm::length(got.centroid - wanted.centroid), 0.001 * wanted.radius_of_gyration());
    for (int i = 0; i < 3; ++i)
        EXPECT_LT(worst(got.moments[i] / trace_of(got) - wanted.moments[i] / trace_of(wanted)),
                  0.01);
}

/// Balls anywhere in a brick, with much air between them.
Mesh scattered_balls(int count) {
    PcgRandom random(7);
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        Affine place;
        place.offset = {6 * random.uniform(), 4 * random.uniform(), 3 * random.uniform()};
        append(mesh, shapes::sphere(0.2, 1), place);
    }
    return mesh;
}

struct Original {
    const char* name;
    Mesh mesh;
};

/// Things of a designer's scene, turned and far from their origin.
std::vector<Original> originals() {
    std::vector<Original> out;
    const auto add = [&](const char* name, const Mesh& mesh) {
        Affine place;
        place.linear = turn(0.3 + static_cast<double>(out.size()), {1, 2, -0.5});
        place.offset = {40, -7, 3};
        Mesh placed;
        append(placed, mesh, place);
        out.push_back({name, placed});
    };
    add("cube", shapes::cube());
    add("brick", shapes::box({-1.5, -1, -0.5}, {1.5, 1, 0.5}));
    add("beam", shapes::box({-2, -0.25, -0.2}, {2, 0.25, 0.2}));
    add("ball", shapes::sphere(2, 4));
    add("egg", shapes::ellipsoid({3, 2, 1}, 4));
    add("sheet", shapes::quad(2, 1));
    add("hill", shapes::terrain(24));
    add("book", shapes::book(50));

    Mesh table = shapes::box({-1, -0.5, 0.7}, {1, 0.5, 0.75});
    for (const double x : {-0.9, 0.9})
        for (const double y : {-0.4, 0.4})
            append(table, shapes::box({x - 0.03, y - 0.03, 0}, {x + 0.03, y + 0.03, 0.7}), {});
    add("table", table);

    Mesh tree = shapes::box({-0.2, -0.2, 0}, {0.2, 0.2, 3});
    append(tree, shapes::sphere(2, 3), {glm::dmat3(1.0), {0, 0, 4.5}});
    add("tree", tree);

    Mesh car = shapes::box({-2.2, -0.9, 0.3}, {2.2, 0.9, 0.9});
    append(car, shapes::box({-1.2, -0.8, 0.9}, {0.9, 0.8, 1.5}), {});
    for (const double x : {-1.4, 1.4})
        for (const double y : {-0.9, 0.9})
            append(car, shapes::sphere(0.33, 2), {glm::dmat3(1.0), {x, y, 0.33}});
    add("car", car);
    return out;
}

}  // namespace

TEST(Replace, NothingToSeeHasNoReplacement) {
    EXPECT_FALSE(fit_box(Attributes{}, Bound{}));
    EXPECT_FALSE(fit_ellipsoid(Attributes{}, Bound{}));
}

TEST(Replace, ShellsHaveTheirClosedForms) {
    const ShellMoments cube = box_shell(glm::dvec3(0.5));
    EXPECT_NEAR(cube.area, 6, 1e-12);
    EXPECT_NEAR(cube.area * 2 * cube.variances.x, 5.0 / 3, 1e-12);  // T_xx of the unit cube
    const double pi = 3.14159265358979323846;
    const ShellMoments sphere = ellipsoid_shell(glm::dvec3(2));
    EXPECT_NEAR(sphere.area, 16 * pi, 1e-11);
    EXPECT_NEAR(sphere.variances.y, 4.0 / 3, 1e-12);
    for (const double ratio : {0.9, 0.3, 1e-2, 1e-4}) {
        const double e = std::sqrt(1 - ratio * ratio);
        const double oblate = 2 * pi * (1 + ratio * ratio / e * std::atanh(e));
        EXPECT_NEAR(ellipsoid_shell({1, ratio, 1}).area / oblate, 1, 1e-10) << ratio;
        const double prolate = 2 * pi * ratio * (ratio + std::asin(e) / e);
        EXPECT_NEAR(ellipsoid_shell({ratio, ratio, 1}).area / prolate, 1, 1e-10) << ratio;
    }
}

TEST(Replace, BoxComesBackAsItself) {
    const Mesh mesh = shapes::box({-1.5, -1, -0.5}, {1.5, 1, 0.5});
    const auto box = fit_box(attributes_of(mesh, 1), bound_of(mesh.positions));
    ASSERT_TRUE(box);
    EXPECT_LT(worst(box->half_size - glm::dvec3(1.5, 1, 0.5)), 1e-9);
    EXPECT_LT(worst(box->center), 1e-12);
    EXPECT_NEAR(std::abs(box->axes[0].x), 1, 1e-12);
}

TEST(Replace, TurnedAndMovedBoxesComeBackAsThemselves) {
    PcgRandom random(3);
    for (int i = 0; i < 300; ++i) {
        Primitive p;
        p.axes = turn(6 * random.uniform(), {random.uniform(), random.uniform() - 0.5, 0.3});
        p.center = {100 * random.uniform(), -7, 3};
        p.half_size = {std::exp(4 * random.uniform()), std::exp(4 * random.uniform()),
                       std::exp(4 * random.uniform())};
        const ShellMoments shell = box_shell(p.half_size);
        const auto box = fit_box(attributes_of(shell, p.axes, p.center), bound_of_box(p));
        ASSERT_TRUE(box);
        const glm::dvec3 want = sorted(p.half_size);
        EXPECT_LT(worst(sorted(box->half_size) / want - 1.0), 1e-9);
        expect_matched(*box, box_shell(box->half_size), attributes_of(shell, p.axes, p.center),
                       1e-9);
    }
}

TEST(Replace, CubeAnyTurnKeepsItsSides) {
    for (const double angle : {0.0, 0.3, 1.0, 2.5}) {
        Primitive cube;
        cube.axes = turn(angle, {1, 2, 3});
        cube.half_size = glm::dvec3(0.5);
        const auto box = fit_box(attributes_of(box_shell(cube.half_size), cube.axes, cube.center),
                                 bound_of_box(cube));
        ASSERT_TRUE(box);
        EXPECT_LT(worst(box->half_size - 0.5), 1e-9);
    }
}

TEST(Replace, EllipsoidsComeBackAsThemselves) {
    PcgRandom random(5);
    for (int i = 0; i < 60; ++i) {
        Primitive p;
        p.axes = turn(6 * random.uniform(), {random.uniform(), random.uniform() - 0.5, 0.3});
        p.half_size = {std::exp(4 * random.uniform()), std::exp(4 * random.uniform()),
                       std::exp(4 * random.uniform())};
        const ShellMoments shell = ellipsoid_shell(p.half_size);
        const auto out =
            fit_ellipsoid(attributes_of(shell, p.axes, p.center), bound_of_ellipsoid(p));
        ASSERT_TRUE(out);
        EXPECT_LT(worst(sorted(out->half_size) / sorted(p.half_size) - 1.0), 1e-8);
    }
    const Mesh ball = shapes::sphere(2, 5);
    const auto sphere = fit_ellipsoid(attributes_of(ball, 1), bound_of(ball.positions));
    ASSERT_TRUE(sphere);
    EXPECT_LT(worst(sphere->half_size - 2.0), 2e-3);
}

TEST(Replace, SphereAsABoxAndCubeAsAnEllipsoidKeepAreaAndShape) {
    const Mesh ball = shapes::ellipsoid({1, 2, 3}, 4);
    const Attributes wanted = attributes_of(ball, 1);
    const auto box = fit_box(wanted, bound_of(ball.positions));
    ASSERT_TRUE(box);
    expect_matched(*box, box_shell(box->half_size), wanted, 1e-6);
    const Attributes cube = attributes_of(shapes::cube(), 1);
    const auto ellipsoid = fit_ellipsoid(cube, bound_of(shapes::cube().positions));
    ASSERT_TRUE(ellipsoid);
    expect_matched(*ellipsoid, ellipsoid_shell(ellipsoid->half_size), cube, 1e-6);
}

TEST(Replace, WhatWasFittedToMeasuredThingsMeasuresTheSameAgain) {
    for (const Original& original : originals()) {
        SCOPED_TRACE(original.name);
        const Attributes wanted = by_rays(original.mesh, 4096, 1);
        const Bound bound = bound_of(original.mesh.positions);
        const auto box = fit_box(wanted, bound);
        ASSERT_TRUE(box);
        expect_remeasured(*box, tessellate_box(*box), wanted);
        const auto ellipsoid = fit_ellipsoid(wanted, bound);
        ASSERT_TRUE(ellipsoid);
        expect_remeasured(*ellipsoid, tessellate_ellipsoid(*ellipsoid, 5), wanted);
    }
}

TEST(Replace, ManyRaysFindAreaCentroidAndTensorOfFinelyMeasuredThingsAgain) {
    for (const Original& original : originals()) {
        const std::string name = original.name;
        if (name != "car" && name != "table" && name != "book")
            continue;
        SCOPED_TRACE(name);
        const Attributes wanted = by_rays(original.mesh, 131072, 1);
        const Bound bound = bound_of(original.mesh.positions);
        const auto box = fit_box(wanted, bound);
        ASSERT_TRUE(box);
        expect_finely_remeasured(by_rays(tessellate_box(*box), 131072, 2), wanted);
        const auto ellipsoid = fit_ellipsoid(wanted, bound);
        ASSERT_TRUE(ellipsoid);
        expect_finely_remeasured(by_rays(tessellate_ellipsoid(*ellipsoid, 5), 131072, 2), wanted);
    }
}

TEST(Replace, ClearShellsHaveTheWholeTensorAndCoverAsMuch) {
    const Mesh flock = scattered_balls(60);
    const Attributes wanted = by_rays(flock, 131072, 1);
    const Bound bound = bound_of(flock.positions);
    const auto box = fit_clear_box(wanted, bound);
    const auto ellipsoid = fit_clear_ellipsoid(wanted, bound);
    ASSERT_TRUE(box);
    ASSERT_TRUE(ellipsoid);
    for (const auto& [mesh, opacity] :
         {std::pair{tessellate_box(box->primitive), box->opacity},
          std::pair{tessellate_ellipsoid(ellipsoid->primitive, 5), ellipsoid->opacity}}) {
        Attributes got = by_rays(mesh, 131072, 2);
        got.visible_area *= opacity;
        got.moments *= opacity;
        expect_finely_remeasured(got, wanted);
        for (int i = 0; i < 3; ++i)  // not its shape alone
            EXPECT_LT(worst(got.moments[i] - wanted.moments[i]), 0.01 * trace_of(wanted));
    }
}

TEST(Replace, FlatQuadGetsAThinBoxOfItsSize) {
    const Mesh quad = shapes::quad(2, 1);
    const Attributes wanted = attributes_of(quad, 2);
    const auto box = fit_box(wanted, bound_of(quad.positions));
    ASSERT_TRUE(box);
    EXPECT_NEAR(box->half_size.x, 1, 0.005);
    EXPECT_NEAR(box->half_size.y, 0.5, 0.005);
    EXPECT_GT(box->half_size.z, 1e-4);
    EXPECT_LT(box->half_size.z, 1e-3);
    expect_matched(*box, box_shell(box->half_size), wanted, 0.01);
    const auto ellipsoid = fit_ellipsoid(wanted, bound_of(quad.positions));
    ASSERT_TRUE(ellipsoid);
    expect_matched(*ellipsoid, ellipsoid_shell(ellipsoid->half_size), wanted, 0.01);
}

TEST(Replace, RowsAndPairsOfThingsAreRefused) {
    const Mesh row = spheres(10, 0.1, 1);
    EXPECT_FALSE(fit_box(attributes_of(row, 1), bound_of(row.positions)));
    EXPECT_FALSE(fit_ellipsoid(attributes_of(row, 1), bound_of(row.positions)));
    const Mesh pair = spheres(2, 1, 10);
    EXPECT_FALSE(fit_box(attributes_of(pair, 1), bound_of(pair.positions)));
    EXPECT_FALSE(fit_ellipsoid(attributes_of(pair, 1), bound_of(pair.positions)));
}

TEST(Replace, SparseGroupsAreRefused) {
    Mesh flock;
    PcgRandom random(11);
    for (int i = 0; i < 40; ++i) {
        Affine shift;
        shift.offset = {10 * random.uniform(), 10 * random.uniform(), 10 * random.uniform()};
        append(flock, shapes::sphere(0.2, 2), shift);
    }
    EXPECT_FALSE(fit_box(attributes_of(flock, 1), bound_of(flock.positions)));
    EXPECT_FALSE(fit_ellipsoid(attributes_of(flock, 1), bound_of(flock.positions)));
}

TEST(Replace, SparseGroupsAreClearShellsOfTheirExtentAndOpaqueAsThereIsToSee) {
    Mesh flock;
    PcgRandom random(11);
    for (int i = 0; i < 40; ++i) {
        Affine shift;
        shift.offset = {10 * random.uniform(), 10 * random.uniform(), 10 * random.uniform()};
        append(flock, shapes::sphere(0.5, 2), shift);
    }
    const Attributes wanted = attributes_of(flock, 1);
    for (const bool as_box : {true, false}) {
        const auto clear = as_box ? fit_clear_box(wanted, bound_of(flock.positions))
                                  : fit_clear_ellipsoid(wanted, bound_of(flock.positions));
        ASSERT_TRUE(clear);
        const ShellMoments shell = as_box ? box_shell(clear->primitive.half_size)
                                          : ellipsoid_shell(clear->primitive.half_size);
        EXPECT_NEAR(clear->opacity * shell.area, wanted.visible_area, 1e-9 * wanted.visible_area);
        const double alpha = surface_alpha(clear->opacity);
        EXPECT_NEAR((1 - alpha) * (1 - alpha), 1 - clear->opacity, 1e-12);
        // The whole tensor, not its shape alone (4.37).
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3& axis = clear->primitive.axes[i];
            EXPECT_NEAR(shell.variances[i] * wanted.visible_area,
                        glm::dot(axis, wanted.moments * axis), 1e-6 * wanted.moments[0][0]);
        }
    }
    // What is dense, or hardly there, is none.
    const Mesh cube = shapes::cube();
    EXPECT_FALSE(fit_clear_box(attributes_of(cube, 1), bound_of(cube.positions)));
    EXPECT_FALSE(fit_clear_box(Attributes{}, Bound{}));
    Attributes faint = wanted;
    faint.visible_area *= 0.01;
    faint.moments *= 0.01;
    EXPECT_FALSE(fit_clear_box(faint, bound_of(flock.positions)));
}

TEST(Replace, ClearShellSettlesByItsOpacity) {
    Attributes rough;
    rough.visible_area = 1;
    rough.moments = glm::dmat3(1.0);
    Attributes sure = rough;
    sure.visible_area = 1.02;
    sure.centroid = {0.1, 0, 0};
    const solids::ClearSolid clear{{{1, 2, 3}, glm::dmat3(1.0), {1, 2, 3}}, 0.5};
    const solids::ClearSolid now = solids::settled(clear, rough, sure);
    EXPECT_NEAR(now.opacity, 0.51, 1e-12);
    EXPECT_NEAR(glm::length(now.primitive.center - glm::dvec3(1.1, 2, 3)), 0, 1e-12);
    EXPECT_EQ(now.primitive.half_size, clear.primitive.half_size);
    // A solid has nothing but its size.
    EXPECT_NEAR(solids::settled(clear.primitive, rough, sure).half_size.x, std::sqrt(1.02), 1e-12);
    // Nobody knows better by what sees nothing.
    EXPECT_EQ(solids::settled(clear, rough, Attributes{}).opacity, 0.5);
}

TEST(Replace, FourthMomentTellsBoxesFromBalls) {
    EXPECT_TRUE(boxlike(by_rays(shapes::box({-1, -2, -3}, {1, 2, 3}), 2048, 1)));
    EXPECT_TRUE(boxlike(by_rays(shapes::cube(), 2048, 1)));
    EXPECT_FALSE(boxlike(by_rays(shapes::sphere(2, 3), 2048, 1)));
    EXPECT_FALSE(boxlike(by_rays(shapes::ellipsoid({1, 2, 3}), 2048, 1)));
}

TEST(Replace, ExtremeAndBrokenAttributesNeverGiveNaN) {
    const double inf = std::numeric_limits<double>::infinity();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {inf, -inf, nan}) {
        Attributes attributes = attributes_of(shapes::cube(), 1);
        attributes.moments[1][1] = bad;
        EXPECT_FALSE(fit_box(attributes, Bound{}));
        EXPECT_FALSE(fit_ellipsoid(attributes, Bound{}));
        attributes = attributes_of(shapes::cube(), 1);
        attributes.centroid.y = bad;
        EXPECT_FALSE(fit_box(attributes, Bound{}));
    }
    Attributes point;
    point.visible_area = 1;
    EXPECT_FALSE(fit_box(point, Bound{}));
    for (const double x : {1e-30, 1e-12, 1e-6, 1.0})
        for (const double y : {1e-30, 1e-12, 1e-3, 1.0})
            for (const double scale : {1e-20, 1.0, 1e20}) {
                ShellMoments shell;
                shell.variances = scale * glm::dvec3(1, x, y);
                shell.area = scale;
                const Attributes attributes =
                    attributes_of(shell, turn(1, {1, 2, 3}), glm::dvec3(0.0));
                for (const auto& out :
                     {fit_box(attributes, Bound{}), fit_ellipsoid(attributes, Bound{})}) {
                    if (!out)
                        continue;
                    for (int i = 0; i < 3; ++i)
                        EXPECT_TRUE(std::isfinite(out->half_size[i]) && out->half_size[i] > 0);
                }
            }
}

TEST(MeanMaterial, TakesTheMeansAndStaysInRange) {
    Attributes attributes;
    attributes.color = {0.2, 1.0000001, -1e-9};
    attributes.roughness = 0.3;
    attributes.metallic = std::numeric_limits<double>::quiet_NaN();
    attributes.emission = {0, 5, 0};
    const Material material = mean_material(attributes);
    EXPECT_EQ(material.base_color, glm::dvec3(0.2, 1, 0));
    EXPECT_EQ(material.roughness, 0.3);
    EXPECT_EQ(material.metallic, 0);
    EXPECT_EQ(material.emission, glm::dvec3(0, 5, 0));
}
