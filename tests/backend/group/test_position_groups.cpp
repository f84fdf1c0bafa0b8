// SPDX-License-Identifier: GPL-3.0-or-later
// Guards grouping by position: small groups of neighbors, occurrences exactly where they were.
#include "base/random.h"
#include "group/position_groups.h"
#include "scenes/small_models.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <set>

using namespace lodestone;

namespace {

double random_unit(int seed, uint64_t stream) {
    return PcgRandom(static_cast<uint64_t>(seed), stream).uniform();
}

/// A meadow: `count` stones at random places in a square, turned and stretched.
Model meadow(int count, double size = 100) {
    Model model;
    const ObjectIndex stone = models::add_leaf(model, "stone", shapes::sphere(0.1, 1));
    std::vector<Placement> placements;
    for (int i = 0; i < count; ++i) {
        Affine place;
        place.linear[0][0] = 1 + random_unit(i, 3);
        place.linear[1][0] = random_unit(i, 4);
        place.offset = {size * (random_unit(i, 0) - 0.5), size * (random_unit(i, 1) - 0.5),
                        random_unit(i, 2)};
        placements.push_back({stone, place, "stone " + std::to_string(i)});
    }
    model.root = models::add_group(model, "meadow", std::move(placements));
    summarize_assemblies(model, bottom_up(model));
    return model;
}

std::multiset<std::vector<double>> occurrences(const Model& model) {
    std::multiset<std::vector<double>> out;
    for_each_occurrence(model, [&](const Occurrence& occurrence) {
        std::vector<double> rows(12);
        occurrence.world.to_rows(rows.data());
        rows.push_back(occurrence.object);
        out.insert(rows);
    });
    return out;
}

size_t most_children(const Model& model) {
    size_t most = 0;
    for (const ObjectIndex index : bottom_up(model)) {
        if (model.objects[index].group())
            most = std::max(most,
                            model.objects[index].representations[0].assembly().placements.size());
    }
    return most;
}

/// uid -> source hash of the groups.
std::map<std::string, Hash> groups(Model& model) {
    summarize_assemblies(model, bottom_up(model));
    std::map<std::string, Hash> out;
    for (const Object& object : model.objects) {
        if (object.group())
            out[object.uid] = object.source_hash;
    }
    return out;
}

}  // namespace

TEST(GroupByPosition, SmallGroupsStayAsTheyAre) {
    Model model = meadow(0);
    EXPECT_EQ(group::group_by_position(model, model.root), 0u);
    model = meadow(64);
    EXPECT_EQ(group::group_by_position(model, model.root), 0u);
    EXPECT_EQ(model.objects.size(), 2u);
}

TEST(GroupByPosition, OccurrencesAreExactlyWhereTheyWere) {
    for (const int count : {65, 1000, 20000}) {
        Model model = meadow(count);
        const auto before = occurrences(model);
        const size_t added = group::group_by_position(model, model.root);
        EXPECT_GT(added, static_cast<size_t>(count / 64));
        EXPECT_LT(added, static_cast<size_t>(count / 4));
        EXPECT_EQ(occurrences(model), before);
        EXPECT_LE(most_children(model), 64u);
    }
}

TEST(GroupByPosition, NeighborsAreTogether) {
    Model model = meadow(4096);
    group::group_by_position(model, model.root);
    summarize_assemblies(model, bottom_up(model));
    for (const ObjectIndex index : bottom_up(model)) {
        const Object& object = model.objects[index];
        if (!object.group() || index == model.root)
            continue;
        size_t leaves = 0;
        for (const Placement& placement : object.representations[0].assembly().placements)
            leaves += model.objects[placement.object].group() ? 1000 : 1;
        if (leaves <= 64) {
            // 16 x 16 cells would hold 16 each: none is wider than two of them.
            EXPECT_LT(object.bound().radius, 100.0 / 8) << object.name;
        }
    }
}

TEST(GroupByPosition, SameGroupsEveryTime) {
    Model one = meadow(3000);
    Model two = meadow(3000);
    group::group_by_position(one, one.root);
    group::group_by_position(two, two.root);
    EXPECT_EQ(groups(one), groups(two));
}

TEST(GroupByPosition, OneMoreChildMakesOnlyItsOwnGroupsStale) {
    Model one = meadow(3000);
    Model two = meadow(3000);
    auto more = std::make_shared<Assembly>(two.objects[two.root].representations[0].assembly());
    more->placements.push_back({0, models::moved(3, 4, 0.5), "one more"});
    two.objects[two.root].representations[0].payload = std::shared_ptr<const Assembly>(more);
    group::group_by_position(one, one.root);
    group::group_by_position(two, two.root);
    const auto before = groups(one);
    size_t stale = 0;
    for (const auto& [uid, hash] : groups(two)) {
        const auto at = before.find(uid);
        stale += at == before.end() || at->second != hash ? 1 : 0;
    }
    EXPECT_GE(stale, 2u);
    EXPECT_LE(stale, 8u);
    EXPECT_GT(before.size(), 60u);
}

TEST(GroupByPosition, ThingsInOnePlaceAreGroupedInTheirOrder) {
    Model model = meadow(1000, 0);
    auto same = std::make_shared<Assembly>();
    same->placements.assign(5000, {0, models::moved(7, 8, 9), "same"});
    model.objects[model.root].representations[0].payload = std::shared_ptr<const Assembly>(same);
    const auto before = occurrences(model);
    group::group_by_position(model, model.root, 8);
    EXPECT_EQ(occurrences(model), before);
    EXPECT_LE(most_children(model), 8u);
    std::set<std::string> uids;
    for (const Object& object : model.objects)
        EXPECT_TRUE(uids.insert(object.uid).second) << object.name;
}

TEST(GroupByPosition, FarAwayAndHugeAndTinyPlacesDoNoHarm) {
    for (const double scale : {1e-300, 1e-12, 1e12, 1e300}) {
        Model model = meadow(0);
        auto spread = std::make_shared<Assembly>();
        for (int i = 0; i < 300; ++i)
            spread->placements.push_back(
                {0, models::moved(scale * random_unit(i, 0), -scale * random_unit(i, 1), 1e9), ""});
        model.objects[model.root].representations[0].payload =
            std::shared_ptr<const Assembly>(spread);
        const auto before = occurrences(model);
        group::group_by_position(model, model.root, 8);
        EXPECT_EQ(occurrences(model), before);
        EXPECT_LE(most_children(model), 8u);
    }
}

TEST(GroupByPosition, PlacesThatAreNoNumbersDoNotHang) {
    Model model = meadow(100);
    auto wild = std::make_shared<Assembly>(model.objects[model.root].representations[0].assembly());
    for (const double place : {std::nan(""), HUGE_VAL, -HUGE_VAL})
        wild->placements.push_back({0, models::moved(place, 0, 0), "nowhere"});
    model.objects[model.root].representations[0].payload = std::shared_ptr<const Assembly>(wild);
    group::group_by_position(model, model.root, 8);
    EXPECT_LE(most_children(model), 8u);
    size_t count = 0;
    for_each_occurrence(model, [&](const Occurrence&) { ++count; });
    EXPECT_EQ(count, 103u);
}

TEST(GroupByPosition, RoleIsKeptAndMistakesAreRefused) {
    Model model = meadow(100);
    model.objects[model.root].role = ObjectRole::Environment;
    EXPECT_THROW(group::group_by_position(model, 0), Error);
    EXPECT_THROW(group::group_by_position(model, 99), Error);
    EXPECT_THROW(group::group_by_position(model, model.root, 7), Error);
    group::group_by_position(model, model.root);
    for (size_t i = 1; i < model.objects.size(); ++i)
        EXPECT_EQ(model.objects[i].role, ObjectRole::Environment);
}
