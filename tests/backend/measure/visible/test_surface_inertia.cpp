// SPDX-License-Identifier: GPL-3.0-or-later
// Guards SurfaceInertia: closed forms against quadrature, traversal against closed forms.
#include "measure/visible/surface_inertia.h"
#include "scenes/closed_forms.h"
#include "scenes/small_meshes.h"

#include <functional>
#include <gtest/gtest.h>
#include <numbers>

using namespace lodestone;
using measure::SurfaceInertia;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using Patch = std::function<glm::dvec3(double, double)>;

/// Area and moments of a smooth patch over the unit square, by tensor Gauss quadrature of five
/// points in n x n cells and exact derivatives replaced by sixth-order differences.
SurfaceInertia integrate(const Patch& patch, int n) {
    constexpr double kAt[5] = {0.046910077030668, 0.230765344947158, 0.5, 0.769234655052841,
                               0.953089922969332};
    constexpr double kWeight[5] = {0.118463442528095, 0.239314335249683, 0.284444444444444,
                                   0.239314335249683, 0.118463442528095};
    const auto slope = [](const auto& f) {
        const double h = 2e-3;
        return ((f(3 * h) - f(-3 * h)) / 60.0 - 3.0 / 20 * (f(2 * h) - f(-2 * h)) +
                0.75 * (f(h) - f(-h))) /
               h;
    };
    SurfaceInertia out;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            for (int p = 0; p < 5; ++p) {
                for (int q = 0; q < 5; ++q) {
                    const double u = (i + kAt[p]) / n;
                    const double v = (j + kAt[q]) / n;
                    const glm::dvec3 du = slope([&](double h) { return patch(u + h, v); });
                    const glm::dvec3 dv = slope([&](double h) { return patch(u, v + h); });
                    const double weight =
                        kWeight[p] * kWeight[q] / (n * n) * glm::length(glm::cross(du, dv));
                    const glm::dvec3 x = patch(u, v);
                    out.area += weight;
                    out.moments += weight * glm::outerProduct(x, x);
                }
            }
        }
    }
    return out;
}

SurfaceInertia sum(const SurfaceInertia& a, const SurfaceInertia& b) {
    SurfaceInertia out = a;
    out.area += b.area;
    out.moments += b.moments;
    return out;
}

double size(const glm::dmat3& m) {
    double square = 0;
    for (int i = 0; i < 3; ++i)
        square += glm::dot(m[i], m[i]);
    return std::sqrt(square);
}

/// The largest relative difference of area and tensor.
double difference(const SurfaceInertia& a, const SurfaceInertia& b) {
    return std::max(std::abs(a.area / b.area - 1), size(a.moments - b.moments) / size(b.moments));
}

/// n-sided prism around the closed cylinder's axis, inscribed, with caps; or only its lower cap.
Mesh prism(uint32_t n, double radius, double height, bool only_cap) {
    Mesh mesh;
    for (uint32_t i = 0; i < n; ++i) {
        const double turn = 2 * kPi * i / n;
        for (const double z : {-0.5 * height, 0.5 * height})
            mesh.positions.emplace_back(radius * std::cos(turn), radius * std::sin(turn), z);
    }
    mesh.positions.emplace_back(0.0, 0.0, -0.5 * height);
    mesh.positions.emplace_back(0.0, 0.0, 0.5 * height);
    for (uint32_t i = 0; i < n; ++i) {
        const uint32_t j = (i + 1) % n;
        mesh.triangles.emplace_back(2 * n, 2 * j, 2 * i);
        if (only_cap)
            continue;
        mesh.triangles.emplace_back(2 * n + 1, 2 * i + 1, 2 * j + 1);
        mesh.triangles.emplace_back(2 * i, 2 * j, 2 * j + 1);
        mesh.triangles.emplace_back(2 * i, 2 * j + 1, 2 * i + 1);
    }
    return mesh;
}

}  // namespace

TEST(SurfaceInertia, EmptyAndDegenerateMeshesHaveNone) {
    EXPECT_TRUE(measure::inertia_of_mesh(Mesh{}).empty());
    Mesh line;
    line.positions = {{0, 0, 0}, {1, 1, 1}};
    line.triangles = {{0, 1, 1}, {0, 0, 1}};
    EXPECT_TRUE(measure::inertia_of_mesh(line).empty());
    EXPECT_EQ(measure::principal_variances({}).values, glm::dvec3(0));
    EXPECT_TRUE(measure::combined({}, {}).empty());
}

TEST(SurfaceInertia, OneTriangleIsFourPointMasses) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}};
    mesh.triangles = {{0, 1, 2}};
    const SurfaceInertia out = measure::inertia_of_mesh(mesh);
    EXPECT_DOUBLE_EQ(out.area, 3);
    EXPECT_NEAR(glm::length(out.center - glm::dvec3(2.0 / 3, 1, 0)), 0, 1e-15);
    // Variance of a side's coordinate over a triangle: a^2 / 18.
    EXPECT_NEAR(out.moments[0][0], 3 * 4.0 / 18, 1e-14);
    EXPECT_NEAR(out.moments[1][1], 3 * 9.0 / 18, 1e-14);
    EXPECT_NEAR(out.moments[0][1], -3 * 6.0 / 36, 1e-14);
}

TEST(SurfaceInertia, UnitCubeHasTensorFiveThirds) {
    const SurfaceInertia cube = measure::inertia_of_mesh(shapes::cube());
    EXPECT_NEAR(cube.area, 6, 1e-14);
    EXPECT_NEAR(cube.inertia()[0][0], 5.0 / 3, 1e-14);
    EXPECT_NEAR(cube.inertia()[0][1], 0, 1e-14);
    EXPECT_NEAR(closed_forms::of_box(1, 1, 1).inertia()[2][2], 5.0 / 3, 1e-14);
}

TEST(SurfaceInertia, BoxMeshEqualsTheBox) {
    const SurfaceInertia mesh = measure::inertia_of_mesh(
        shapes::box(glm::dvec3(-1.5, -1, -0.25), glm::dvec3(1.5, 1, 0.25)));
    EXPECT_LT(difference(mesh, closed_forms::of_box(3, 2, 0.5)), 1e-14);
    EXPECT_NEAR(glm::length(mesh.center), 0, 1e-15);
}

TEST(SurfaceInertia, ClosedFormsEqualQuadrature) {
    const double a = 1.7;
    const double b = 0.6;
    const double c = 0.9;
    SurfaceInertia box;
    for (const double s : {-0.5, 0.5}) {
        box = sum(box, integrate(
                           [&](double u, double v) {
                               return glm::dvec3(s * a, (u - 0.5) * b, (v - 0.5) * c);
                           },
                           1));
        box = sum(box, integrate(
                           [&](double u, double v) {
                               return glm::dvec3((u - 0.5) * a, s * b, (v - 0.5) * c);
                           },
                           1));
        box = sum(box, integrate(
                           [&](double u, double v) {
                               return glm::dvec3((u - 0.5) * a, (v - 0.5) * b, s * c);
                           },
                           1));
    }
    EXPECT_LT(difference(closed_forms::of_box(a, b, c), box), 1e-9);

    const auto disc = [&](double z) {
        return integrate(
            [=](double u, double v) {
                return glm::dvec3(u * b * std::cos(2 * kPi * v), u * b * std::sin(2 * kPi * v), z);
            },
            12);
    };
    EXPECT_LT(difference(closed_forms::of_disc(b), disc(0)), 1e-9);
    const SurfaceInertia wall = integrate(
        [&](double u, double v) {
            return glm::dvec3(b * std::cos(2 * kPi * v), b * std::sin(2 * kPi * v), (u - 0.5) * a);
        },
        12);
    EXPECT_LT(difference(closed_forms::of_closed_cylinder(b, a),
                         sum(wall, sum(disc(a / 2), disc(-a / 2)))),
              1e-9);

    const auto ellipsoid = [](const glm::dvec3& r) {
        return integrate(
            [=](double u, double v) {
                return r * glm::dvec3(std::sin(kPi * u) * std::cos(2 * kPi * v),
                                      std::sin(kPi * u) * std::sin(2 * kPi * v), std::cos(kPi * u));
            },
            24);
    };
    EXPECT_LT(difference(closed_forms::of_sphere(b), ellipsoid(glm::dvec3(b))), 1e-9);
    for (const glm::dvec3& r :
         {glm::dvec3(1, 1, 1), glm::dvec3(1.7, 0.6, 0.9), glm::dvec3(0.4, 2, 0.5)})
        EXPECT_LT(difference(closed_forms::of_ellipsoid(r), ellipsoid(r)), 1e-9);
}

TEST(SurfaceInertia, EllipsoidEqualsTheClosedFormOfSpheroids) {
    for (const double c : {1.0, 0.5, 1e-1, 1e-3, 1e-6}) {
        // Oblate: 2 pi a^2 (1 + (1 - e^2) / e artanh e).
        const double e = std::sqrt(1 - c * c);
        const double oblate = c < 1 ? 2 * kPi * (1 + c * c / e * std::log((1 + e) / c)) : 4 * kPi;
        EXPECT_NEAR(closed_forms::of_ellipsoid({1, 1, c}).area / oblate, 1, 1e-10) << c;
        EXPECT_NEAR(closed_forms::of_ellipsoid({c, 1, 1}).area / oblate, 1, 1e-10) << c;
        // Prolate: 2 pi a^2 (1 + c / (a e) asin e) with a the short half size.
        const double prolate = c < 1 ? 2 * kPi * c * c * (1 + std::asin(e) / (c * e)) : 4 * kPi;
        EXPECT_NEAR(closed_forms::of_ellipsoid({c, 1, c}).area / prolate, 1, 1e-10) << c;
    }
    const SurfaceInertia flat = closed_forms::of_ellipsoid({0, 2, 2});
    EXPECT_LT(
        difference(
            flat,
            measure::transformed(
                measure::combined(closed_forms::of_disc(2), closed_forms::of_disc(2)),
                {glm::dmat3(glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0)), {}})),
        1e-10);
    EXPECT_EQ(closed_forms::of_ellipsoid({0, 0, 2}).area, 0);
}

TEST(SurfaceInertia, TessellationsConvergeAtSecondOrder) {
    const auto check_order = [](const char* what, const std::function<SurfaceInertia(int)>& of,
                                const SurfaceInertia& exact) {
        const double coarse = difference(of(0), exact);
        const double fine = difference(of(1), exact);
        const double finer = difference(of(2), exact);
        EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1) << what;
        EXPECT_NEAR(std::log2(fine / finer), 2, 0.1) << what;
    };
    check_order(
        "sphere", [](int i) { return measure::inertia_of_mesh(shapes::sphere(1.5, 2 + i)); },
        closed_forms::of_sphere(1.5));
    check_order(
        "ellipsoid",
        [](int i) {
            return measure::inertia_of_mesh(shapes::ellipsoid({1.5, 1, 0.7}, 3 + i));
        },
        closed_forms::of_ellipsoid({1.5, 1, 0.7}));
    check_order(
        "cylinder", [](int i) { return measure::inertia_of_mesh(prism(16u << i, 0.7, 2, false)); },
        closed_forms::of_closed_cylinder(0.7, 2));
    check_order(
        "disc", [](int i) { return measure::inertia_of_mesh(prism(16u << i, 0.7, 0, true)); },
        closed_forms::of_disc(0.7));
}

TEST(SurfaceInertia, ScalingByThreeMultipliesTheTensorBy81) {
    const SurfaceInertia cube = measure::inertia_of_mesh(shapes::cube());
    const SurfaceInertia large =
        measure::inertia_of_mesh(shapes::box(glm::dvec3(-1.5), glm::dvec3(1.5)));
    EXPECT_NEAR(large.inertia()[0][0] / cube.inertia()[0][0], 81, 1e-12);
    const SurfaceInertia scaled = measure::transformed(cube, {glm::dmat3(3.0), {}});
    EXPECT_LT(difference(scaled, large), 1e-14);
}

TEST(SurfaceInertia, TransformedEqualsTheTransformedMesh) {
    const glm::dvec3 z = glm::normalize(glm::dvec3(1, 2, 3));
    const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(0, 1, 0)));
    for (const double mirror : {1.0, -1.0}) {
        const Affine placed{1.75 * glm::dmat3(mirror * x, glm::cross(z, x), z), {4, -5, 6}};
        Mesh mesh;
        append(mesh, shapes::terrain(8), placed);
        const SurfaceInertia expected = measure::inertia_of_mesh(mesh);
        const SurfaceInertia found =
            measure::transformed(measure::inertia_of_mesh(shapes::terrain(8)), placed);
        EXPECT_LT(difference(found, expected), 1e-6);
        EXPECT_NEAR(glm::length(found.center - expected.center), 0, 1e-6);
    }
}

TEST(SurfaceInertia, NonUniformScaleAndShearAreRefused) {
    Affine uneven;
    uneven.linear[0][0] = 2;
    EXPECT_THROW(measure::transformed(closed_forms::of_sphere(1), uneven), Error);
    Affine shear;
    shear.linear[1][0] = 0.1;
    EXPECT_THROW(measure::transformed(closed_forms::of_sphere(1), shear), Error);
    EXPECT_THROW(measure::transformed(closed_forms::of_sphere(1), {glm::dmat3(0.0), {}}), Error);
    EXPECT_THROW(measure::transformed(closed_forms::of_sphere(1), {glm::dmat3(kNan), {}}), Error);
}

TEST(SurfaceInertia, CompositionEqualsTheMeshOfBoth) {
    const Mesh a = shapes::box({0, 0, 0}, {1, 2, 3});
    const Mesh b = shapes::box({5, -1, 0.5}, {6, 1, 1});
    Mesh both = a;
    append(both, b, Affine{});
    const SurfaceInertia found =
        measure::combined(measure::inertia_of_mesh(a), measure::inertia_of_mesh(b));
    const SurfaceInertia expected = measure::inertia_of_mesh(both);
    EXPECT_LT(difference(found, expected), 1e-13);
    EXPECT_NEAR(glm::length(found.center - expected.center), 0, 1e-14);
}

TEST(SurfaceInertia, PrincipalAxesOfATurnedBoxAreItsOwn) {
    const glm::dvec3 z = glm::normalize(glm::dvec3(1, 2, 3));
    const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(0, 1, 0)));
    const glm::dmat3 axes(x, glm::cross(z, x), z);
    const SurfaceInertia box = closed_forms::of_box(3, 2, 1);
    const SymmetricEigen out =
        measure::principal_variances(measure::transformed(box, {axes, {1, 2, 3}}));
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(std::abs(glm::dot(out.axes[i], axes[i])), 1, 1e-12);
        EXPECT_NEAR(out.values[i], box.moments[i][i] / box.area, 1e-12);
    }
}

TEST(SurfaceInertia, FarFromTheOriginAndTinyAndHugeKeepTheirDigits) {
    Mesh far = shapes::cube();
    for (glm::vec3& position : far.positions)
        position += 0x1p20f;
    EXPECT_LT(difference(measure::inertia_of_mesh(far), closed_forms::of_box(1, 1, 1)), 1e-9);
    for (const double s : {0x1p-20, 0x1p20, 0x1p-60, 0x1p60}) {
        Mesh scaled = shapes::box({-1.5 * s, -s, -0.5 * s}, {1.5 * s, s, 0.5 * s});
        const SurfaceInertia out = measure::inertia_of_mesh(scaled);
        EXPECT_LT(difference(out, closed_forms::of_box(3 * s, 2 * s, s)), 1e-12);
        const SymmetricEigen eigen = measure::principal_variances(out);
        EXPECT_NEAR(std::abs(eigen.axes[0].x), 1, 1e-12) << s;
    }
}

TEST(SurfaceInertia, OpenSheetsCountTwiceWhenAsked) {
    const Mesh quad = shapes::quad(2, 1);
    EXPECT_DOUBLE_EQ(measure::inertia_of_mesh(quad).area, 2);
    EXPECT_DOUBLE_EQ(measure::inertia_of_mesh(quad, true).area, 4);
    EXPECT_DOUBLE_EQ(measure::inertia_of_mesh(quad, true).moments[0][0],
                     2 * measure::inertia_of_mesh(quad).moments[0][0]);
    EXPECT_NEAR(measure::inertia_of_mesh(shapes::cube(), true).area, 6, 1e-14);
}

TEST(SurfaceInertia, TrianglesWithNonFiniteVerticesCountNothing) {
    Mesh mesh = shapes::cube();
    mesh.normals.clear();
    mesh.positions.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0, 0);
    mesh.triangles.emplace_back(0, 1, static_cast<uint32_t>(mesh.positions.size() - 1));
    EXPECT_NEAR(measure::inertia_of_mesh(mesh).area, 6, 1e-14);
}

TEST(SurfaceInertia, AttributesFollowPlacementsThatKeepShapesAndRefuseOthers) {
    Attributes box;
    box.visible_area = box.surface_area = 22;
    box.centroid = {1, 2, 3};
    box.moments = closed_forms::of_box(3, 2, 1).moments;
    const double s = 2;
    const Affine mirrored{glm::dmat3({-s, 0, 0}, {0, 0, s}, {0, s, 0}), {10, 0, 0}};
    for (const Affine& placed :
         {mirrored, Affine{glm::dmat3({0, s, 0}, {-s, 0, 0}, {0, 0, s}), {}}}) {
        const Attributes out = measure::transformed(box, placed);
        EXPECT_NEAR(out.visible_area, 88, 1e-9);
        EXPECT_NEAR(out.surface_area, 88, 1e-9);
        EXPECT_NEAR(glm::length(out.centroid - placed(box.centroid)), 0, 1e-12);
        EXPECT_NEAR(glm::determinant(out.axes), 1, 1e-12);
        // The longest axis is still the one with the largest variance, s^4 times as large.
        EXPECT_NEAR(glm::dot(out.axes[0], out.moments * out.axes[0]), 16 * box.moments[0][0], 1e-9);
    }
    EXPECT_THROW(measure::transformed(box, {glm::dmat3({2, 0, 0}, {0, 1, 0}, {0, 0, 1}), {}}),
                 Error);
}
