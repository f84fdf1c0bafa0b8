// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the brightness of stand-ins: collapsed meshes, textured leaves and solids scatter as much
// light as what they stand for, by other rays than they were matched with.
#include "base/files.h"
#include "hierarchy/hierarchy_build.h"
#include "measure/pictures/picture_agreement.h"
#include "ray/mesh_scene.h"
#include "scenes/leaf_cards.h"
#include "scenes/rematched_stand_ins.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"
#include "scratch.h"
#include "solids/stand_in_material.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>

using namespace lodestone;

namespace {

class Brightness : public WithRays {};

Mesh table_of_boxes() {
    Mesh table = shapes::box({-1, -0.5, 0.7}, {1, 0.5, 0.75});
    for (const double x : {-0.9, 0.9}) {
        for (const double y : {-0.4, 0.4})
            append(table, shapes::box({x - 0.03, y - 0.03, 0}, {x + 0.03, y + 0.03, 0.7}), {});
    }
    return table;
}

ray::SkinPtr skin_of(const Model& model, const Representation& level, image::TexelCache& texels) {
    std::vector<Material> materials;
    for (const uint32_t index : level.materials)
        materials.push_back(model.materials[index]);
    return std::make_shared<const ray::MeshSkin>(materials, texels);
}

Mesh drawn(const Representation& level) {
    switch (level.summary.kind) {
        case Kind::Mesh:
            return level.mesh();
        case Kind::Composite:
            return tessellate(level.composite(), 3);
        case Kind::Box:
            return tessellate_box(level.primitive());
        default:
            return tessellate_ellipsoid(level.primitive(), 4);
    }
}

/// Builds an object alone and compares all its levels that are off by a twelfth of the radius.
/// Meshes cover as much but for `uncovered`.
void expect_as_bright(Model& model, const std::string& name, size_t fewest_levels,
                      double uncovered) {
    Problems problems;
    hierarchy::build_hierarchy(model, segment::Store(scratch(name)), hierarchy::BuildSettings{},
                               problems, {});
    const Object& object = model.objects[model.root];
    const Representation& finest = object.representations[0];
    image::TexelCache texels;
    // Suns stand elsewhere for each seed.
    std::vector<std::unique_ptr<const measure::AgreementReference>> truths;
    for (const uint64_t seed : {99, 100, 101, 102})
        truths.push_back(std::make_unique<const measure::AgreementReference>(
            finest.mesh(), skin_of(model, finest, texels), seed, 90));
    size_t compared = 0;
    for (size_t i = 1; i < object.representations.size(); ++i) {
        const Representation& level = object.representations[i];
        if (level.summary.error < object.bound().radius / 12)
            continue;
        glm::dvec3 light(0.0);
        double coverage = 0;
        for (const auto& truth : truths) {
            const measure::PictureAgreement seen =
                truth->of(drawn(level), skin_of(model, level, texels));
            light += seen.light / static_cast<double>(truths.size());
            coverage += seen.coverage / static_cast<double>(truths.size());
        }
        // What lay near something else may have been all that closed a gap: shelves without books.
        if (level.summary.kind == Kind::Mesh && level.summary.error < object.bound().radius / 2) {
            EXPECT_NEAR(coverage, 1, uncovered) << name << " level " << i;
        }
        EXPECT_NEAR((light.x + light.y + light.z) / 3, 1, 0.03) << name << " level " << i;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(light[c], 1, 0.06) << name << " level " << i << " channel " << c;
        ++compared;
    }
    EXPECT_GE(compared, fewest_levels);
}

/// Shelves (slot 0) with books (slot 1) on them, open to the front.
Mesh bookcase() {
    PcgRandom random(2);
    Mesh mesh;
    for (int shelf = 0; shelf < 5; ++shelf)
        append(mesh, shapes::box({0, 0, 0.5 * shelf}, {1.6, 0.4, 0.5 * shelf + 0.04}), {});
    for (const double x : {0.0, 1.56})
        append(mesh, shapes::box({x, 0, 0}, {x + 0.04, 0.4, 2.04}), {});
    mesh.slots.assign(mesh.triangles.size(), 0);
    for (int shelf = 0; shelf < 4; ++shelf) {
        double x = 0.06;
        while (x < 1.5) {
            const double wide = 0.02 + 0.03 * random.uniform();
            const double low = 0.5 * shelf + 0.04;
            const double high = low + 0.25 + 0.17 * random.uniform();
            append(mesh, shapes::box({x, 0.05, low}, {x + wide, 0.3, high}), {}, 1);
            x += wide + 0.003;
        }
    }
    return mesh;
}

}  // namespace

TEST_F(Brightness, ABookcaseStaysAsBrightWhenItIsCollapsed) {
    Model model;
    model.root = models::add_leaf(model, "case", bookcase(), models::colored("a", {0.3, 0.2, 0.1}));
    Representation& finest = model.objects[model.root].representations[0];
    finest.materials.push_back(static_cast<uint32_t>(model.materials.size()));
    model.materials.push_back(models::colored("book", {0.5, 0.1, 0.1}));
    summarize(finest, model);
    expect_as_bright(model, "bookcase", 1, 0.1);  // what lost its books is no level
}

TEST_F(Brightness, TexturedLeavesStayAsBrightWhenTheyArePruned) {
    const PicturePtr picture = foliage::picture(
        16, [](double x, double y) { return glm::dvec4(0.2 + 0.2 * x, 0.3 + 0.4 * y, 0.1, 1); });
    Material leaf;
    leaf.base_color = glm::dvec3(picture->mean);
    leaf.base_color_texture = foliage::texture(picture);
    Model model;
    model.root = models::add_leaf(model, "tree", foliage::tree(300),
                                  models::colored("bark", {0.2, 0.1, 0.05}));
    Representation& finest = model.objects[model.root].representations[0];
    finest.materials.push_back(static_cast<uint32_t>(model.materials.size()));
    model.materials.push_back(leaf);
    summarize(finest, model);
    expect_as_bright(model, "textured tree", 2, 0.25);
}

TEST_F(Brightness, WallsThatPrunedTilesUncoverMakeAHouseNoDarker) {
    // Whatever color the tiles got, it was .95 as bright: the rest of it shows more.
    Mesh house = shapes::box({-3, -2.5, 0}, {3, 2.5, 3});
    house.slots.assign(house.triangles.size(), 0);
    const double slope = std::hypot(2.5, 2.2);
    for (const int side : {1, -1}) {
        for (int row = 0; row < 12; ++row) {
            for (int column = 0; column < 20; ++column) {
                Affine place;
                place.linear[1] = glm::dvec3(0, -side * 2.5, 2.2) / slope;
                place.linear[2] = glm::cross(place.linear[0], place.linear[1]);
                place.offset = {0.31 * column - 3, side * 2.5 * (1 - row / 12.0),
                                3 + 2.2 * row / 12.0};
                append(house, shapes::box({0, 0, 0}, {0.3, 0.42, 0.03}), place, 1);
            }
        }
    }
    Model model;
    model.root = models::add_leaf(model, "house", house, models::colored("a", {0.5, 0.2, 0.1}));
    Representation& finest = model.objects[model.root].representations[0];
    finest.materials.push_back(static_cast<uint32_t>(model.materials.size()));
    model.materials.push_back(models::colored("tile", {0.15, 0.15, 0.2}));
    summarize(finest, model);
    expect_as_bright(model, "house", 1, 0.1);
}

TEST_F(Brightness, PagesShowAtTheSidesOfABookThatIsABox) {
    // A pile shows little else of them: it was .63 as bright where each was as dark as its cover.
    constexpr int kSheets = 24;
    Mesh book;
    for (const double z : {0.0, 0.04})
        append(book, shapes::box({0, 0, z}, {0.17, 0.24, z + 0.003}), {});
    append(book, shapes::box({0, 0, 0}, {0.003, 0.24, 0.04}), {});
    book.slots.assign(book.triangles.size(), 0);
    for (int sheet = 0; sheet < kSheets; ++sheet) {
        const double z = 0.003 + 0.037 * (sheet + 0.5) / kSheets;
        append(book, shapes::quad(0.16f, 0.23f), models::moved(0.005, 0.005, z), 1);
    }
    Model model;
    model.root = models::add_leaf(model, "book", book, models::colored("cover", glm::dvec3(0.03)));
    Representation& finest = model.objects[model.root].representations[0];
    finest.materials.push_back(static_cast<uint32_t>(model.materials.size()));
    model.materials.push_back(models::colored("paper", glm::dvec3(0.8)));
    summarize(finest, model);
    // By other seeds the coarsest level may be a mesh of the collapsed pile, not a box.
    constexpr uint64_t kSeeds = 6;
    int boxes = 0;
    for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
        hierarchy::BuildSettings settings;
        settings.seed = seed;
        Problems problems;
        Model built = model;
        hierarchy::build_hierarchy(built, segment::Store(scratch("book")), settings, problems, {});
        const std::vector<Representation>& levels = built.objects[built.root].representations;
        const auto painted = std::find_if(levels.begin(), levels.end(), [&](const auto& level) {
            return built.materials[level.materials[0]].vertex_colors;
        });
        if (painted == levels.end())
            continue;
        ++boxes;
        ASSERT_EQ(painted->summary.kind, Kind::Mesh);
        const Mesh& box = painted->mesh();
        ASSERT_EQ(box.triangles.size(), 12u);
        float cover = 0;
        float sides = 0;
        for (size_t i = 0; i < box.colors.size(); ++i)
            (std::abs(box.normals[i].z) > 0.5f ? cover : sides) += box.colors[i].x;
        EXPECT_GT(sides / 16, 2 * cover / 8);
    }
    EXPECT_GE(boxes, 1);
}

TEST_F(Brightness, ATextureIsBrightenedByItsScaleAndMixturesBothWays) {
    Material inner;
    inner.base_color = {0.5, 0.5, 0.9};
    Material material;
    material.base_color = {0.4, 0.2, 0.1};
    material.base_color_texture = foliage::texture(foliage::left_half());
    material.other = std::make_shared<Material>(inner);
    material.emission = {3, 3, 3};
    solids::brighten(material, {1.2, 1.1, 1.3});
    EXPECT_NEAR(material.base_color.x, 0.48, 1e-12);
    EXPECT_NEAR(material.base_color_texture.scale.x, 1.2, 1e-12);
    EXPECT_EQ(material.base_color_texture.scale.x, material.base_color_texture.scale.z);
    EXPECT_NEAR(material.other->base_color.x, 0.6, 1e-12);
    EXPECT_EQ(material.other->base_color.z, 1);  // a color reflects no more than there is
    EXPECT_EQ(material.emission, glm::dvec3(3));
    EXPECT_EQ(inner.base_color.x, 0.5) << "what others share stays";
}

TEST_F(Brightness, WhatIsUsedFromAfarIsAboutAsBrightByFewSamples) {
    for (const double error : {0.125, 0.5, 2.0}) {
        for (const Rematched& found : rematched(table_of_boxes(), false, 8, error))
            EXPECT_LT(found.brightness, 5) << found.kind << " at " << error;
    }
}

TEST_F(Brightness, EveryKindOfStandInIsFoundAgainBySixteenTimesTheRays) {
    const Mesh table = table_of_boxes();
    std::set<std::string> kinds;
    for (const Mesh& mesh : {table, foliage::tree(100)}) {
        for (const Rematched& found : rematched(mesh, false, 8)) {
            EXPECT_LT(found.color, 2) << found.kind;
            EXPECT_LT(found.brightness, 2) << found.kind;
            kinds.insert(found.kind);
        }
    }
    for (const char* kind : {"box", "ellipsoid", "composite 8", "clear composite 8", "collapsed"})
        EXPECT_EQ(kinds.count(kind), 1u) << kind;
}
