// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what is measured by rays: visible area and its moments against closed forms, on convex
// shapes, open sheets and a book of which almost nothing shows.
#include "base/parallel.h"
#include "measure/deviation/surface_samples.h"
#include "measure/visible/principal_axes.h"
#include "measure/visible/seen_from_outside.h"
#include "measure/visible/sobol_points.h"
#include "measure/visible/stratified_points.h"
#include "measure/visible/surface_inertia.h"
#include "measure/visible/visible_attributes.h"
#include "measure/visible/visible_sampler.h"
#include "scenes/closed_forms.h"
#include "scenes/small_meshes.h"

#include <bit>
#include <gtest/gtest.h>
#include <numbers>

using namespace lodestone;
using measure::measure_visible;
using measure::VisibleAttributes;
using measure::VisibleOptions;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Attributes attributes_of(const Mesh& mesh, uint64_t rays = 4096, uint64_t seed = 1) {
    VisibleOptions options;
    options.rays = rays;
    options.seed = seed;
    return measure_visible(mesh, {}, options).attributes;
}

Mesh moved(const Mesh& mesh, const Affine& transform) {
    Mesh out;
    append(out, mesh, transform);
    return out;
}

double size(const glm::dmat3& m) {
    double square = 0;
    for (int i = 0; i < 3; ++i)
        square += glm::dot(m[i], m[i]);
    return std::sqrt(square);
}

/// A rotation that is no multiple of anything.
glm::dmat3 turn() {
    const glm::dvec3 z = glm::normalize(glm::dvec3(1, 2, 3));
    const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(0.3, 1, -0.2)));
    return {x, glm::cross(z, x), z};
}

/// Something with all difficulties at once: a closed part, open sheets, things inside others.
Mesh clutter() {
    Mesh mesh = shapes::box({0, 0, 0}, {2, 1, 0.5});
    append(mesh, shapes::sphere(0.2, 2), {glm::dmat3(1.0), {1, 0.5, 0.25}});
    append(mesh, shapes::terrain(6), {glm::dmat3(1.5), {0.2, -0.3, 0.9}});
    append(mesh, shapes::sphere(0.4, 3), {glm::dmat3(1.0), {2.5, 0.5, 1}});
    return mesh;
}

}  // namespace

TEST(VisibleAttributes, EmptyAndDegenerateMeshesHaveEmptyAttributes) {
    EXPECT_TRUE(attributes_of(Mesh{}).empty());
    Mesh line;
    line.positions = {{0, 0, 0}, {1, 1, 1}};
    line.triangles = {{0, 1, 1}, {0, 0, 1}};
    const Attributes none = attributes_of(line);
    EXPECT_TRUE(none.empty());
    EXPECT_EQ(none.visible_area, 0);
    EXPECT_EQ(none.surface_area, 0);
    EXPECT_EQ(none.radius_of_gyration(), 0);
    EXPECT_TRUE(attributes_of(shapes::cube(), 0).empty());
    EXPECT_TRUE(measure::seen_from_outside(Mesh{}, ray::MeshScene(Mesh{}), 4, 1).empty());
}

TEST(VisibleAttributes, SobolPointsFillEveryPairOfCellsOnce) {
    // In each dimension 256 points have one in each 256th; in the first two, one in each cell of
    // 16 x 16: that is what makes them evener than random ones.
    const measure::SobolPoints sobol(42);
    std::array<std::vector<int>, 4> lines;
    lines.fill(std::vector<int>(256, 0));
    std::vector<int> cells(256, 0);
    for (uint32_t i = 0; i < 256; ++i) {
        const std::array<double, 4> u = sobol.point(i);
        for (size_t d = 0; d < 4; ++d) {
            ASSERT_GE(u[d], 0);
            ASSERT_LT(u[d], 1);
            ++lines[d][static_cast<size_t>(u[d] * 256)];
        }
        ++cells[static_cast<size_t>(u[0] * 16) * 16 + static_cast<size_t>(u[1] * 16)];
    }
    for (const std::vector<int>& line : lines)
        EXPECT_EQ(line, std::vector<int>(256, 1));
    EXPECT_EQ(cells, std::vector<int>(256, 1));
}

TEST(VisibleAttributes, OneQuadIsSeenFromBothSides) {
    const Attributes quad = attributes_of(shapes::quad(2, 1));
    EXPECT_NEAR(quad.visible_area, 4, 0.02);
    EXPECT_NEAR(quad.surface_area, 4, 1e-12);
    EXPECT_NEAR(glm::length(quad.centroid - glm::dvec3(1, 0.5, 0)), 0, 0.01);
    EXPECT_NEAR(quad.moments[0][0], 4 * 4.0 / 12, 0.02);
    EXPECT_NEAR(std::abs(quad.axes[2].z), 1, 1e-6);
    EXPECT_NEAR(quad.normal_moment, 1, 1e-6);
}

TEST(VisibleAttributes, ConvexShapesShowAllTheirArea) {
    for (const uint64_t seed : {1u, 2u, 3u}) {
        const Mesh box = shapes::box({0, 0, 0}, {3, 2, 1});
        EXPECT_NEAR(attributes_of(box, 4096, seed).visible_area / 22, 1, 0.005);
        const Mesh sphere = shapes::sphere(1, 4);
        EXPECT_NEAR(attributes_of(sphere, 4096, seed).visible_area / (4 * kPi), 1, 0.005);
        const glm::dvec3 half(2, 1, 0.5);
        EXPECT_NEAR(attributes_of(shapes::ellipsoid(half, 4), 4096, seed).visible_area /
                        closed_forms::of_ellipsoid(half).area,
                    1, 0.005);
    }
}

TEST(VisibleAttributes, MomentsOfABoxAreItsInertia) {
    const Attributes box = attributes_of(shapes::box({1, 1, 1}, {4, 3, 2}), 16384);
    const measure::SurfaceInertia exact = closed_forms::of_box(3, 2, 1);
    const double radius = box.radius_of_gyration();
    EXPECT_NEAR(glm::length(box.centroid - glm::dvec3(2.5, 2, 1.5)) / radius, 0, 0.01);
    EXPECT_LT(size(box.moments - exact.moments) / size(exact.moments), 0.01);
    EXPECT_LT(size(box.inertia() - exact.inertia()) / size(exact.inertia()), 0.01);
    EXPECT_NEAR(box.normal_moment, 1, 1e-3);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(std::abs(box.axes[i][i]), 1, 1e-3);
}

TEST(VisibleAttributes, FourthNormalMomentTellsABoxFromASphere) {
    EXPECT_NEAR(attributes_of(shapes::sphere(1, 4)).normal_moment, 0.6, 0.02);
    EXPECT_NEAR(attributes_of(shapes::cube()).normal_moment, 1, 1e-3);
}

TEST(VisibleAttributes, EqualVariancesAreSettledByTheNormals) {
    // A cube's eigenvectors are noise; a square bar's are in one plane.
    for (const glm::dvec3& half : {glm::dvec3(1, 1, 1), glm::dvec3(3, 1, 1), glm::dvec3(2, 2, 1)}) {
        const Mesh box = moved(shapes::box(-half, half), {turn(), {5, 6, 7}});
        const Attributes out = attributes_of(box);
        EXPECT_GT(out.normal_moment, 0.999);
        EXPECT_NEAR(glm::determinant(out.axes), 1, 1e-9);
        EXPECT_LT(size(glm::transpose(out.axes) * out.axes - glm::dmat3(1.0)), 1e-9);
    }
}

TEST(VisibleAttributes, AxesAreTurnedOnlyWhenNormalsRiseByMoreThanATwentieth) {
    // Normals all round one axis: no frame in that plane is better than another.
    measure::NormalMoments round;
    for (int i = 0; i < 360; ++i)
        round.add({std::cos(i * kPi / 180), std::sin(i * kPi / 180), 0}, 1);
    EXPECT_NEAR(round.in_frame(glm::dmat3(1.0)), 0.75, 1e-12);
    const glm::dmat3 moments(glm::dvec3(2, 0, 0), glm::dvec3(0, 1.99, 0), glm::dvec3(0, 0, 1));
    const glm::dmat3 kept = measure::principal_axes(moments, round);
    EXPECT_NEAR(std::abs(kept[0].x), 1, 1e-12);

    measure::NormalMoments square;  // a square turned by 30 degrees
    const double c = std::cos(kPi / 6);
    const double s = std::sin(kPi / 6);
    square.add({c, s, 0}, 1);
    square.add({-s, c, 0}, 1);
    const glm::dmat3 found = measure::principal_axes(moments, square);
    EXPECT_NEAR(square.in_frame(found), 1, 1e-9);
    // Far apart, variances give the axes, whatever the normals say.
    const glm::dmat3 apart(glm::dvec3(3, 0, 0), glm::dvec3(0, 2, 0), glm::dvec3(0, 0, 1));
    EXPECT_NEAR(std::abs(measure::principal_axes(apart, square)[0].x), 1, 1e-12);
    // A point has no axes at all; the answer is still a frame.
    EXPECT_NEAR(glm::determinant(measure::principal_axes(glm::dmat3(0.0), square)), 1, 1e-9);
}

TEST(VisibleAttributes, BookIsMeasuredByRaysAndOverestimatedByTraversal) {
    const int pages = 200;
    const Mesh book = shapes::book(pages);
    const double truth = attributes_of(book, uint64_t{1} << 20u, 99).visible_area;
    // Sheets this near each other look like their outer box from almost everywhere.
    const double thick = (pages - 1) * 0.001;
    const double outer = closed_forms::of_box(1, 1.4, thick).area;
    EXPECT_LT(truth, outer);
    EXPECT_GT(truth, 0.99 * outer);
    for (const uint64_t seed : {1u, 2u, 3u, 4u}) {
        const Attributes sampled = attributes_of(book, 4096, seed);
        EXPECT_NEAR(sampled.visible_area / truth, 1, 0.01) << seed;
        EXPECT_NEAR(sampled.visible_area / truth, 1, 3 * sampled.relative_error) << seed;
    }
    // Traversal counts every page, both sides.
    const double all = 2 * pages * 1.0 * 1.4;
    EXPECT_NEAR(measure::inertia_of_mesh(book, true).area / all, 1, 1e-6);
    EXPECT_NEAR(attributes_of(book).surface_area / all, 1, 1e-6);
    EXPECT_NEAR(measure::inertia_of_mesh(book, true).area / truth, all / outer, 0.01 * all / outer);
}

TEST(VisibleAttributes, HalfHiddenFloorHasItsClosedForm) {
    // Two parallel squares: what one hides of the other's inner side is their form factor.
    Mesh mesh = shapes::quad(1, 1);
    append(mesh, shapes::quad(1, 1), {glm::dmat3(1.0), {0, 0, 1}});
    const double x = 1;
    const double factor =
        2 / (kPi * x * x) *
        (std::log((1 + x * x) / std::sqrt(1 + 2 * x * x)) +
         2 * x * std::sqrt(1 + x * x) * std::atan(x / std::sqrt(1 + x * x)) - 2 * x * std::atan(x));
    EXPECT_NEAR(factor, 0.1998, 1e-4);
    const double exact = 4 - 2 * factor;
    EXPECT_NEAR(attributes_of(mesh, 65536).visible_area / exact, 1, 0.005);
}

TEST(VisibleAttributes, BothWaysOfCastingAgree) {
    // The sampler takes lines for the book and surface rays for the flock; a shape between.
    Mesh flock;
    for (int i = 0; i < 12; ++i)
        append(flock, shapes::sphere(0.1, 2),
               {glm::dmat3(1.0), {std::cos(i * 1.7) * 3, std::sin(i * 2.3) * 3, 0.5 * i}});
    const Mesh book = shapes::book(200);
    EXPECT_TRUE(measure::VisibleSampler(flock, ray::MeshScene(flock), 1).from_surface());
    EXPECT_FALSE(measure::VisibleSampler(book, ray::MeshScene(book), 1).from_surface());
    // Twelve separate spheres hide next to nothing of each other.
    const double alone = surface_area(flock);
    EXPECT_NEAR(attributes_of(flock).visible_area / alone, 1, 0.01);
}

TEST(VisibleAttributes, ErrorsAreAsLargeAsTheyAreSaidToBe) {
    const Mesh mesh = clutter();
    const double truth = attributes_of(mesh, uint64_t{1} << 19u, 77).visible_area;
    VisibleOptions options;
    options.relative_error = 0.02;
    int inside = 0;
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        options.seed = seed;
        const Attributes out = measure_visible(mesh, {}, options).attributes;
        EXPECT_LE(out.relative_error, 0.02);
        EXPECT_LT(out.rays, 40000u);
        inside += std::abs(out.visible_area / truth - 1) <= 0.02 ? 1 : 0;
    }
    EXPECT_GE(inside, 36);
    options.relative_error = 1e-9;
    options.most_rays = 1000;
    const uint64_t rays = measure_visible(mesh, {}, options).attributes.rays;
    EXPECT_LE(rays, 1000u);
    EXPECT_GT(rays, 1000u - measure::StratifiedPoints::kStep);
}

TEST(VisibleAttributes, MovingTurningAndScalingMoveTurnAndScaleTheAttributes) {
    const Mesh mesh = clutter();
    const Attributes before = attributes_of(mesh, 65536);
    const double scale = 2.5;
    const Affine placed{scale * turn(), {100, -200, 300}};
    const Attributes after = attributes_of(moved(mesh, placed), 65536);
    EXPECT_NEAR(after.visible_area / (scale * scale * before.visible_area), 1, 0.01);
    EXPECT_LT(glm::length(after.centroid - placed(before.centroid)),
              0.01 * after.radius_of_gyration());
    const glm::dmat3 expected =
        scale * scale * (placed.linear * before.moments * glm::transpose(placed.linear));
    EXPECT_LT(size(after.moments - expected) / size(expected), 0.02);
    EXPECT_NEAR(after.normal_moment, before.normal_moment, 0.02);
}

TEST(VisibleAttributes, FarFromTheOriginAndTinyAndHugeMeasureTheSame) {
    const Mesh mesh = shapes::book(20, 0.125f);
    const Attributes reference = attributes_of(mesh);
    for (const double s : {1e-6, 1e6, 1e-12}) {
        const Attributes out = attributes_of(moved(mesh, {glm::dmat3(s), {}}));
        EXPECT_NEAR(out.visible_area / (s * s * reference.visible_area), 1, 0.01) << s;
        EXPECT_NEAR(out.moments[0][0] / (s * s * s * s * reference.moments[0][0]), 1, 0.02) << s;
        EXPECT_NEAR(out.normal_moment, 1, 1e-3) << s;
    }
    // A cube of one metre a thousand kilometres away: its corners are exact floats.
    const glm::dvec3 far(0x1p20, -0x1p20, 0x1p19);
    const Attributes out = attributes_of(shapes::box(far, far + 1.0));
    EXPECT_NEAR(out.visible_area, 6, 0.01);
    EXPECT_NEAR(glm::length(out.centroid - far - 0.5), 0, 0.02);
    EXPECT_NEAR(out.moments[0][0], 5.0 / 6, 0.02);
}

TEST(VisibleAttributes, SurfacePropertiesAreMeansOverTheVisibleArea) {
    // White pages between red covers: from outside it is the covers' red and the pages' edges.
    Mesh mesh = shapes::box({0, 0, 0}, {1, 1, 1});
    append(mesh, shapes::sphere(0.4, 3), {glm::dmat3(1.0), glm::dvec3(0.5)}, 1);
    std::vector<Material> materials(2);
    materials[0].base_color = {0.5, 0.1, 0.1};
    materials[0].roughness = 0.25;
    materials[0].emission = {1, 2, 3};
    materials[1].base_color = {1, 1, 1};
    materials[1].metallic = 1;
    const Attributes hidden = measure_visible(mesh, materials, {}).attributes;
    EXPECT_NEAR(glm::length(hidden.color - glm::dvec3(0.5, 0.1, 0.1)), 0, 1e-12);
    EXPECT_NEAR(hidden.roughness, 0.25, 1e-12);
    EXPECT_EQ(hidden.metallic, 0);
    EXPECT_NEAR(hidden.emission.z, 3, 1e-12);

    // Side by side: a cube of area 6 and a quad seen on both sides, area 2.
    Mesh pair = shapes::cube();
    append(pair, shapes::quad(1, 1), {glm::dmat3(1.0), {50, 0, 0}}, 1);
    const Attributes both = measure_visible(pair, materials, {}).attributes;
    EXPECT_NEAR(both.metallic, 0.25, 0.02);
    // A slot nobody described looks like a new material.
    const Attributes plain = measure_visible(pair, {}, {}).attributes;
    EXPECT_NEAR(glm::length(plain.color - glm::dvec3(0.8)), 0, 1e-12);
}

TEST(VisibleAttributes, TagsTellWhichChildWasSeen) {
    Mesh mesh = shapes::box({0, 0, 0}, {1, 1, 1});
    std::vector<uint32_t> tags(mesh.triangles.size(), 0);
    append(mesh, shapes::box(glm::dvec3(0.25), glm::dvec3(0.75)), Affine{});
    tags.resize(mesh.triangles.size(), 1);
    append(mesh, shapes::box({0, 0, 3}, {1, 1, 4}), Affine{});
    tags.resize(mesh.triangles.size(), 2);
    const VisibleAttributes out = measure_visible(mesh, {}, {}, tags);
    ASSERT_EQ(out.hits_by_tag.size(), 3u);
    EXPECT_GT(out.hits_by_tag[0], 1000u);
    EXPECT_EQ(out.hits_by_tag[1], 0u);
    EXPECT_NEAR(static_cast<double>(out.hits_by_tag[2]) / static_cast<double>(out.hits_by_tag[0]),
                1, 0.1);
    tags.pop_back();
    EXPECT_THROW(measure_visible(mesh, {}, {}, tags), Error);
    tags.assign(mesh.triangles.size(), ~0u);
    EXPECT_THROW(measure_visible(mesh, {}, {}, tags), Error);
}

TEST(VisibleAttributes, CrossingSheetsAreMeasured) {
    // Two crossed squares: from surface rays and from lines, 4 minus what they hide.
    Mesh mesh = shapes::quad(1, 1);
    Affine upright;
    upright.linear = glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0));
    upright.offset = {0, 0.5, -0.5};
    append(mesh, shapes::quad(1, 1), upright);
    // Each of the eight half sides hides behind a perpendicular half square: 1 x 0.5 at an edge.
    const double w = 0.5;
    const double h = 0.5;
    const double r = std::sqrt(h * h + w * w);
    const double a = (1 + w * w) * (1 + h * h) / (1 + w * w + h * h);
    const double b = w * w * (1 + w * w + h * h) / ((1 + w * w) * (w * w + h * h));
    const double c = h * h * (1 + h * h + w * w) / ((1 + h * h) * (h * h + w * w));
    const double factor = (w * std::atan(1 / w) + h * std::atan(1 / h) - r * std::atan(1 / r) +
                           0.25 * std::log(a * std::pow(b, w * w) * std::pow(c, h * h))) /
                          (kPi * w);
    const double exact = 4 * (1 - factor);
    EXPECT_NEAR(attributes_of(mesh, 65536).visible_area / exact, 1, 0.005);
}

TEST(VisibleAttributes, SameBitsOnOneAndManyThreadsAndOnEveryRun) {
    const Mesh mesh = clutter();
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        VisibleOptions options;
        options.relative_error = 0.01;
        const VisibleAttributes out =
            measure_visible(mesh, {}, options, std::vector<uint32_t>(mesh.triangles.size(), 3));
        const ray::MeshScene scene(mesh);
        return std::tuple(out.attributes.visible_area, out.attributes.centroid,
                          out.attributes.moments, out.attributes.axes, out.attributes.normal_moment,
                          out.attributes.rays, out.hits_by_tag,
                          measure::seen_from_outside(mesh, scene, 8, 5));
    };
    const auto once = run(1);
    EXPECT_EQ(once, run(0));
    EXPECT_EQ(once, run(2));
}

TEST(VisibleAttributes, InsideOutPartsAndNonFiniteVerticesDoNoHarm) {
    Mesh inside_out = shapes::cube();
    for (Triangle& t : inside_out.triangles)
        std::swap(t.y, t.z);
    append(inside_out, shapes::cube(), {glm::dmat3(1.0), {30, 0, 0}});
    ASSERT_TRUE(closed(inside_out));
    EXPECT_NEAR(attributes_of(inside_out).visible_area, 12, 0.1);

    Mesh broken = shapes::cube();
    broken.normals.clear();
    broken.positions.emplace_back(kNan, 0, 0);
    broken.triangles.emplace_back(0, 1, static_cast<uint32_t>(broken.positions.size() - 1));
    broken.triangles.emplace_back(0, 0, 0);
    EXPECT_NEAR(attributes_of(broken).visible_area, 6, 0.05);
}

TEST(VisibleAttributes, CancelledJobsStop) {
    const int32_t cancel = 1;
    const Job job(&cancel, nullptr, nullptr);
    const Mesh mesh = shapes::cube();
    EXPECT_THROW(measure_visible(mesh, {}, {}, {}, job), Error);
    EXPECT_THROW(measure::seen_from_outside(mesh, ray::MeshScene(mesh), 4, 1, job), Error);
}

TEST(VisibleAttributes, SceneOfAnotherMeshIsRefused) {
    const ray::MeshScene scene(shapes::quad(1, 1));
    EXPECT_THROW(measure_visible(shapes::cube(), scene, {}, {}), Error);
    EXPECT_THROW(measure::seen_from_outside(shapes::cube(), scene, 4, 1), Error);
}

TEST(VisibleAttributes, SamplersAndSidesMadeBeforeChangeNothing) {
    const Mesh mesh = clutter();
    const ray::MeshScene scene(mesh);
    VisibleOptions options;
    options.seed = 9;
    const measure::VisibleSampler sampler(mesh, scene, options.seed);
    const Attributes once = measure::measure_visible(mesh, sampler, nullptr, options).attributes;
    const Attributes again = measure::measure_visible(mesh, scene, nullptr, options).attributes;
    EXPECT_EQ(once.visible_area, again.visible_area);
    EXPECT_EQ(once.moments, again.moments);
    EXPECT_EQ(measure::seen_from_outside(mesh, scene, sampler.sides(), 4, 9),
              measure::seen_from_outside(mesh, scene, 4, 9));
}

TEST(VisibleAttributes, AreaAloneIsWhatAllAttributesTell) {
    std::vector<Mesh> meshes{clutter(), shapes::cube(), shapes::book(8), Mesh{}};
    meshes.push_back(shapes::sphere(0.1, 1));
    append(meshes.back(), meshes[0], {glm::dmat3(1.0), {40, 0, 0}});
    for (const Mesh& mesh : meshes) {
        const ray::MeshScene scene(mesh);
        VisibleOptions options;
        options.rays = 1000;
        options.seed = 4;
        const measure::VisibleSampler sampler(mesh, scene, options.seed);
        EXPECT_EQ(measure::visible_area(sampler, options.rays),
                  measure_visible(mesh, scene, nullptr, options).attributes.visible_area);
    }
}

TEST(VisibleAttributes, RaysEndOnceTheyChangeLittle) {
    constexpr uint64_t kSeeds = 16;
    constexpr double kShare = 0.004;
    const Mesh mesh = clutter();
    const Attributes truth = attributes_of(mesh, uint64_t{1} << 18u, 99);
    VisibleOptions options;
    options.rays = 65536;
    const auto settled = [&](double share, uint64_t seed) {
        options.settled = share;
        options.seed = seed;
        return measure_visible(mesh, {}, options).attributes;
    };
    double off = 0;
    uint64_t rays = 0;
    for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const Attributes fewer = settled(kShare, seed);
        EXPECT_TRUE(std::has_single_bit(fewer.rays)) << seed;
        off += glm::length(fewer.centroid - truth.centroid) / truth.radius_of_gyration() / kSeeds;
        rays += fewer.rays;
        // The rays are the first of the same sequence, however many there are.
        const Attributes same = attributes_of(mesh, fewer.rays, seed);
        EXPECT_EQ(same.centroid, fewer.centroid) << seed;
        EXPECT_EQ(same.visible_area, fewer.visible_area) << seed;
    }
    EXPECT_LT(off, kShare);
    EXPECT_LT(rays, kSeeds * options.rays / 2);
    EXPECT_EQ(settled(1e-9, 1).rays, options.rays);
    EXPECT_EQ(settled(1, 1).rays, 4096u);
}

TEST(VisibleAttributes, RaysThatWereCastBeforeAreNotCastAgain) {
    const Mesh mesh = clutter();
    const ray::MeshScene scene(mesh);
    VisibleOptions options;
    options.seed = 9;
    const measure::VisibleSampler sampler(mesh, scene, options.seed);
    std::vector<measure::SurfaceSample> samples;
    std::vector<measure::CastPoints> known =
        measure::add_visible_points(mesh, sampler, {}, 1500, {}, samples);
    EXPECT_GE(known.size(), 750u);
    EXPECT_LE(known.size(), 3000u);
    const Attributes cast = measure_visible(mesh, sampler, nullptr, options).attributes;
    const Attributes told = measure_visible(mesh, sampler, nullptr, options, {}, known).attributes;
    EXPECT_EQ(told.visible_area, cast.visible_area);
    EXPECT_EQ(told.moments, cast.moments);
    EXPECT_EQ(told.centroid, cast.centroid);
    // What is told is believed.
    for (measure::CastPoints& ray : known)
        ray.count = 0;
    const Attributes less = measure_visible(mesh, sampler, nullptr, options, {}, known).attributes;
    EXPECT_LT(less.visible_area, 0.9 * cast.visible_area);
    // More than there are rays.
    options.rays = 100;
    EXPECT_EQ(measure_visible(mesh, sampler, nullptr, options, {}, known).attributes.visible_area,
              0);
}
