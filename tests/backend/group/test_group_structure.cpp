// SPDX-License-Identifier: GPL-3.0-or-later
// Guards structuring: what is near and alike is together, occurrences exactly where they were.
#include "base/parallel.h"
#include "base/random.h"
#include "group/group_structure.h"
#include "scenes/small_models.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <set>

using namespace lodestone;

namespace {

double random_unit(int seed, uint64_t stream) {
    return PcgRandom(static_cast<uint64_t>(seed), stream).uniform();
}

group::GroupingItem point_item(const glm::dvec3& at, double half = 0.5) {
    group::GroupingItem item;
    item.box = {at - half, at + half};
    return item;
}

/// `clusters` heaps of `each` boxes, far from each other; items of a heap follow each other.
std::vector<group::GroupingItem> heaps(int clusters, int each, double scale = 1,
                                       const glm::dvec3& origin = glm::dvec3(0.0)) {
    std::vector<group::GroupingItem> items;
    for (int i = 0; i < clusters * each; ++i) {
        const int number = i / each;
        const double heap = 1000.0 * number;
        const glm::dvec3 at(heap + 20 * random_unit(i, 0), 20 * random_unit(i, 1),
                            20 * random_unit(i, 2));
        items.push_back(point_item(origin + scale * at, 0.5 * scale));
    }
    return items;
}

/// The items below every group, as sets of their numbers.
std::set<std::set<uint32_t>> sets_of(const group::GroupingTree& tree) {
    std::set<std::set<uint32_t>> out;
    const std::function<std::set<uint32_t>(uint32_t)> below = [&](uint32_t node) {
        std::set<uint32_t> items;
        if (tree.is_item(node))
            items.insert(node);
        for (const uint32_t child : tree.nodes[node].children)
            items.merge(below(child));
        if (!tree.is_item(node))
            out.insert(items);
        return items;
    };
    below(tree.root);
    return out;
}

std::set<uint32_t> numbers(uint32_t first, uint32_t count) {
    std::set<uint32_t> out;
    for (uint32_t i = 0; i < count; ++i)
        out.insert(first + i);
    return out;
}

/// Every item once, nothing with fewer than two or more than `most` children but the root.
void expect_whole(const group::GroupingTree& tree, size_t items, size_t most) {
    std::vector<int> seen(items, 0);
    std::vector<uint32_t> stack{tree.root};
    while (!stack.empty()) {
        const uint32_t node = stack.back();
        stack.pop_back();
        if (tree.is_item(node)) {
            ++seen[node];
            continue;
        }
        const std::vector<uint32_t>& children = tree.nodes[node].children;
        EXPECT_LE(children.size(), most);
        EXPECT_TRUE(node == tree.root || children.size() >= 2);
        for (const uint32_t child : children) {
            EXPECT_EQ(tree.nodes[child].parent, node);
            stack.push_back(child);
        }
    }
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int count) { return count == 1; }));
}

/// Bricks in two colors, strewn so that place alone tells nothing.
Model bricks(int count, double spread = 10) {
    Model model;
    const ObjectIndex red = models::add_leaf(model, "red", shapes::sphere(0.1, 1),
                                             models::colored("red", {0.8, 0.05, 0.05}));
    const ObjectIndex blue = models::add_leaf(model, "blue", shapes::sphere(0.1, 1),
                                              models::colored("blue", {0.05, 0.05, 0.8}));
    std::vector<Placement> placements;
    for (int i = 0; i < count; ++i) {
        Affine place;
        place.offset = {spread * random_unit(i, 0), spread * random_unit(i, 1), 0};
        placements.push_back({i % 2 == 0 ? red : blue, place, "brick " + std::to_string(i)});
    }
    model.root = models::add_group(model, "heap", std::move(placements));
    summarize_assemblies(model, bottom_up(model));
    return model;
}

const std::vector<Placement>& placements_of(const Model& model, ObjectIndex group) {
    return model.objects[group].representations[0].assembly().placements;
}

std::vector<Placement>& change_placements(Model& model, ObjectIndex group) {
    auto own = std::make_shared<Assembly>(model.objects[group].representations[0].assembly());
    std::vector<Placement>& placements = own->placements;
    model.objects[group].representations[0].payload =
        std::shared_ptr<const Assembly>(std::move(own));
    return placements;
}

std::multiset<std::vector<double>> occurrences(const Model& model) {
    std::multiset<std::vector<double>> out;
    for_each_occurrence(model, [&](const Occurrence& occurrence) {
        std::vector<double> rows(12);
        occurrence.world.to_rows(rows.data());
        rows.push_back(occurrence.object);
        rows.push_back(occurrence.hidden);
        out.insert(rows);
    });
    return out;
}

group::StructureReport structure(Model& model, size_t fewest = 8, uint64_t seed = 1) {
    group::StructureOptions options;
    options.fewest = fewest;
    options.seed = seed;
    const ObjectIndex root = model.root;
    return group::structure_groups(model, std::span(&root, 1), options, {});
}

std::set<std::string> uids_of_groups(const Model& model) {
    std::set<std::string> out;
    for (const ObjectIndex index : bottom_up(model)) {
        const bool fresh =
            !model.objects[index].group() || out.insert(model.objects[index].uid).second;
        EXPECT_TRUE(fresh) << model.objects[index].uid;
    }
    return out;
}

}  // namespace

TEST(ExpectedCost, IsThatOfTheBoxesByHand) {
    // Two pairs of unit cubes side by side, 8 apart: the whole is 10 x 2 x 1.
    std::vector<group::GroupingItem> items;
    for (const double x : {0.0, 9.0}) {
        for (const double y : {0.0, 1.0})
            items.push_back(point_item({x, y, 0}));
    }
    group::GroupingTree tree = group::flat_tree(4);
    EXPECT_DOUBLE_EQ(group::expected_cost(tree, items), 4);
    tree.nodes.resize(7);
    tree.nodes[5].children = {0, 1};
    tree.nodes[6].children = {2, 3};
    tree.nodes[4].children = {5, 6};
    // Half areas: whole 10*2 + 2*1 + 1*10 = 32, a pair 1*2 + 2*1 + 1*1 = 5.
    EXPECT_DOUBLE_EQ(group::expected_cost(tree, items), 2 + 2 * 2 * 5.0 / 32);
    EXPECT_EQ(group::group_count(tree), 2u);
    EXPECT_EQ(group::expected_cost({}, {}), 0);
}

TEST(Insertion, NothingOneAndTwoStayAsTheyAre) {
    for (const uint32_t count : {0u, 1u, 2u}) {
        std::vector<group::GroupingItem> items(count, point_item({1, 2, 3}));
        const group::GroupingTree tree = group::group_by_insertion(items, {}, {});
        EXPECT_EQ(tree.nodes[tree.root].children.size(), count);
        EXPECT_EQ(group::group_count(tree), 0u);
    }
}

TEST(Insertion, FarHeapsAreGroupsWhateverTheSeedScaleAndOrigin) {
    for (const uint64_t seed : {1u, 2u, 77u}) {
        for (const double scale : {1e-200, 1e-3, 1.0, 1e150}) {
            const std::vector<group::GroupingItem> items =
                heaps(2, 12, scale, glm::dvec3(scale * 1e5, -scale * 1e6, 0));
            group::StructureOptions options;
            options.seed = seed;
            const group::GroupingTree tree = group::group_by_insertion(items, options, {});
            expect_whole(tree, items.size(), options.most);
            const auto sets = sets_of(tree);
            EXPECT_TRUE(sets.contains(numbers(0, 12))) << seed << " " << scale;
            EXPECT_TRUE(sets.contains(numbers(12, 12))) << seed << " " << scale;
        }
    }
}

TEST(Insertion, SameTreeInAnyOrderAndOnAnyNumberOfThreads) {
    const std::vector<group::GroupingItem> items = heaps(5, 40);
    std::vector<uint32_t> turned(items.size());  // number in `items` of each
    for (uint32_t i = 0; i < turned.size(); ++i)
        turned[i] = static_cast<uint32_t>((i * 77u + 13u) % turned.size());
    std::vector<group::GroupingItem> others;
    others.reserve(items.size());
    for (const uint32_t i : turned)
        others.push_back(items[i]);
    const auto one = sets_of(group::group_by_insertion(items, {}, {}));
    std::set<std::set<uint32_t>> two;
    for (const std::set<uint32_t>& members : sets_of(group::group_by_insertion(others, {}, {}))) {
        std::set<uint32_t> named;
        for (const uint32_t i : members)
            named.insert(turned[i]);
        two.insert(named);
    }
    EXPECT_EQ(one, two);
    const ThreadLimit limit(1);
    EXPECT_EQ(one, sets_of(group::group_by_insertion(items, {}, {})));
}

TEST(Insertion, CostsFarLessThanAFlatGroupAndMoreOrdersNeverCostMore) {
    const std::vector<group::GroupingItem> items = heaps(20, 30);
    const double flat = group::expected_cost(group::flat_tree(items.size()), items);
    group::StructureOptions options;
    options.orders = 1;
    const double one = group::expected_cost(group::group_by_insertion(items, options, {}), items);
    options.orders = 8;
    const double many = group::expected_cost(group::group_by_insertion(items, options, {}), items);
    EXPECT_LE(many, one);
    EXPECT_LT(one, flat / 20);
}

TEST(Insertion, ThousandsOfThingsInOnePlaceAndOnesInsideTheOther) {
    std::vector<group::GroupingItem> same(3000, point_item({5, 5, 5}));
    expect_whole(group::group_by_insertion(same, {}, {}), same.size(), 64);
    std::vector<group::GroupingItem> points(2000, point_item({5, 5, 5}, 0));
    expect_whole(group::group_by_insertion(points, {}, {}), points.size(), 64);
    std::vector<group::GroupingItem> nested;
    nested.reserve(1000);
    for (int i = 0; i < 1000; ++i)
        nested.push_back(point_item({0, 0, 0}, std::pow(0.94, i)));
    expect_whole(group::group_by_insertion(nested, {}, {}), nested.size(), 1000);
    std::vector<group::GroupingItem> huge;
    huge.reserve(300);
    for (int i = 0; i < 300; ++i)
        huge.push_back(point_item({(i % 2 == 0 ? 1 : -1) * 1e308, i, i}, 1e300));
    expect_whole(group::group_by_insertion(huge, {}, {}), huge.size(), 64);
}

TEST(Insertion, TenThousandObjectsAreAllThereOnce) {  // bench_group tells how fast
    const std::vector<group::GroupingItem> items = heaps(100, 100);
    const group::GroupingTree tree = group::group_by_insertion(items, {}, {});
    expect_whole(tree, items.size(), 64);
}

TEST(Insertion, StopsWhenAsked) {
    const int32_t cancel = 1;
    EXPECT_THROW(group::group_by_insertion(heaps(10, 100), {}, Job(&cancel, nullptr, nullptr)),
                 Error);
}

TEST(Structure, OccurrencesAreExactlyWhereTheyWere) {
    for (const int count : {0, 1, 2, 9, 65, 1000}) {
        Model model = bricks(count);
        const auto before = occurrences(model);
        const group::StructureReport report = structure(model);
        EXPECT_EQ(occurrences(model), before);
        EXPECT_EQ(report.structured, count > 8 ? 1u : 0u);
        EXPECT_EQ(report.made > 0, count > 8);
        EXPECT_EQ(report.made, model.objects.size() - 3);
        EXPECT_TRUE(count <= 8 || report.cost_after < report.cost_before);
        uids_of_groups(model);
    }
}

TEST(Structure, ColorsPartWhatPlacesDoNot) {
    Model model = bricks(64, 0.3);
    group::StructureOptions options;
    options.fewest = 8;
    options.similarity = 1;
    const ObjectIndex root = model.root;
    group::structure_groups(model, std::span(&root, 1), options, {});
    size_t pure = 0;
    size_t mixed = 0;
    for (const ObjectIndex index : bottom_up(model)) {
        if (!model.objects[index].group() || index == model.root)
            continue;
        std::set<ObjectIndex> kinds;
        for (const Placement& placement : placements_of(model, index)) {
            if (!model.objects[placement.object].group())
                kinds.insert(placement.object);
        }
        pure += kinds.size() == 1 ? 1 : 0;
        mixed += kinds.size() == 2 ? 1 : 0;
    }
    EXPECT_GE(pure, 2u);
    EXPECT_LE(mixed, pure / 4);
}

TEST(Structure, GroupsOfTheSameMembersHaveTheSameUidsInAnyOrderAndBesideNewOnes) {
    Model one = bricks(200);
    Model two = bricks(200);
    std::vector<Placement>& placements = change_placements(two, two.root);
    std::reverse(placements.begin(), placements.end());
    Model three = bricks(200);
    change_placements(three, three.root).push_back({0, models::moved(1000, 0, 0), "far away"});
    structure(one);
    structure(two);
    structure(three, 8, 5);
    const std::set<std::string> uids = uids_of_groups(one);
    EXPECT_EQ(uids, uids_of_groups(two));
    Model again = bricks(200);
    structure(again, 8, 5);
    uids_of_groups(again);
}

TEST(Structure, WhatNothingStandsForAndGroundStayApart) {
    Model model = bricks(60);
    const ObjectIndex ground =
        models::add_leaf(model, "ground", shapes::sphere(0.5, 1), {}, ObjectRole::Environment);
    const ObjectIndex flag = models::add_leaf(model, "flag", shapes::sphere(0.5, 1));
    model.objects[flag].deforms = true;
    std::vector<Placement>& placements = change_placements(model, model.root);
    for (int i = 0; i < 20; ++i) {
        const Affine place = models::moved(random_unit(i, 7), random_unit(i, 8), 0);
        placements.push_back({ground, place, "tile"});
        placements.push_back({0, place, "unseen", kShadowRays});
    }
    placements.push_back({flag, models::moved(1, 1, 0), "flag"});
    const auto before = occurrences(model);
    structure(model);
    EXPECT_EQ(occurrences(model), before);
    for (const ObjectIndex index : bottom_up(model)) {
        if (!model.objects[index].group() || index == model.root)
            continue;
        size_t tiles = 0;
        size_t others = 0;
        for (const Placement& placement : placements_of(model, index)) {
            EXPECT_EQ(placement.hidden, 0);
            EXPECT_NE(placement.object, flag);
            tiles += placement.object == ground ? 1 : 0;
            others += placement.object < 2 ? 1 : 0;
        }
        EXPECT_TRUE(tiles == 0 || others == 0) << model.objects[index].name;
    }
}

TEST(Structure, CanBeTakenBack) {
    Model model = bricks(300);
    const ObjectIndex pair =
        models::add_group(model, "pair", {{0, models::moved(1, 0, 0), "a"}, {1, {}, "b"}});
    change_placements(model, model.root).push_back({pair, models::moved(3, 3, 3), "pair"});
    const auto before = occurrences(model);
    const size_t children = placements_of(model, model.root).size();
    const group::StructureReport report = structure(model);
    EXPECT_LT(placements_of(model, model.root).size(), children);
    EXPECT_EQ(group::dissolve_made_groups(model, model.root), report.made);
    EXPECT_EQ(placements_of(model, model.root).size(), children);
    EXPECT_EQ(occurrences(model), before);
    EXPECT_EQ(group::dissolve_made_groups(model, model.root), 0u);
}

TEST(Structure, BoundsThatAreNoNumbersAndEmptyThingsDoNoHarm) {
    Model model = bricks(100);
    const ObjectIndex bad = models::add_leaf(model, "bad", shapes::sphere(1, 1));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    model.objects[bad].representations[0].summary.bound.box.high.x = nan;
    const ObjectIndex nothing = models::add_group(model, "nothing", {});
    const ObjectIndex empty = models::add_leaf(model, "empty", Mesh{});
    std::vector<Placement>& placements = change_placements(model, model.root);
    for (int i = 0; i < 40; ++i) {
        placements.push_back({bad, models::moved(i, 0, 0), "bad"});
        placements.push_back({nothing, models::moved(i, 0, 0), "nothing"});
        placements.push_back({empty, models::moved(i, 0, 0), "empty"});
        Affine flat;
        flat.linear = glm::dmat3(0.0);
        placements.push_back({0, flat, "squeezed to a point"});
        placements.push_back({1, models::moved(nan, 0, 0), "nowhere"});
    }
    const size_t before = placements.size();
    structure(model);
    size_t after = 0;
    for (const ObjectIndex index : bottom_up(model)) {
        if (!model.objects[index].group())
            continue;
        EXPECT_LE(placements_of(model, index).size(), 64u);
        for (const Placement& placement : placements_of(model, index))
            after += !model.objects[placement.object].group() || placement.object == nothing;
    }
    EXPECT_EQ(after, before);
}

TEST(Structure, MistakesAreRefusedAndSmallGroupsStay) {
    Model model = bricks(64);
    const ObjectIndex leaf = 0;
    EXPECT_THROW(group::structure_groups(model, std::span(&leaf, 1), {}, {}), Error);
    const ObjectIndex none = 99;
    EXPECT_THROW(group::structure_groups(model, std::span(&none, 1), {}, {}), Error);
    group::StructureOptions options;
    options.most = 7;
    EXPECT_THROW(group::structure_groups(model, std::span(&model.root, 1), options, {}), Error);
    EXPECT_EQ(structure(model, 64).made, 0u);
    EXPECT_EQ(group::flat_groups(model, 63), std::vector<ObjectIndex>{model.root});
    EXPECT_TRUE(group::flat_groups(model, 64).empty());
}
