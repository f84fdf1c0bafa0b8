// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the flat table that choosing reads: it changes no cut, opens nothing in vain, and is safe
// from any thread.
#include "base/parallel.h"
#include "choose/choice_table.h"
#include "choose/criterion.h"
#include "scenes/random_models.h"

using namespace lodestone;
using forest::expect_same;
using forest::Forest;

namespace {

/// A group that has a level which would do.
bool opened_though_good(const Model& model, const View& view, const choose::Cut& cut,
                        uint32_t index) {
    const choose::CutNode& node = cut.nodes[index];
    if (!node.opened)
        return false;
    const choose::ChoiceReason reason = choose::explain_choice(model, view, cut, index);
    const Object& object = model.objects[node.object];
    for (size_t lod = 1; lod < object.representations.size(); ++lod) {
        if (lod <= node.coarsest &&
            choose::good_enough(view, object.representations[lod].summary.error, reason.stretch,
                                reason.z, reason.chosen.total))
            return true;
    }
    return false;
}

}  // namespace

TEST(ChoiceTable, OfAnEmptyGroupHasOneRow) {
    Model model;
    model.root = models::add_group(model, "empty", {});
    summarize_assemblies(model, bottom_up(model));
    const choose::ChoiceTable table = choose::ChoiceTable::whole(model, model.root, kAllKinds);
    EXPECT_EQ(table.size(), 1u);
    EXPECT_TRUE(choose::choose_cut(table, View{}).chosen.empty());
}

TEST(ChoiceTable, KeepsSiblingsBesideEachOther) {
    const Model model = bent::pairs(8);
    const choose::ChoiceTable table = choose::ChoiceTable::whole(model, model.root, kAllKinds);
    EXPECT_EQ(table.size(), 3u);  // row, pair, ball: what is shared is there once
    const choose::TableObject& row = table.object(table.find(model.root));
    EXPECT_EQ(row.child_count, 4u);
    EXPECT_EQ(table.child(row.first_child + 1).offset.x, 6);
    EXPECT_EQ(table.child(row.first_child + 1).linear, choose::kUnturned);
    const choose::TableRow& ball = table.row(table.find(bent::kBall));
    ASSERT_EQ(ball.level_count, 3u);
    EXPECT_EQ(table.level(ball.first_level + 1).error, 0.1);
    EXPECT_EQ(table.level(ball.first_level + 1).triangles, 80u);
}

TEST(ChoiceTable, KeepsAllToTheLastBitAlthoughItIsPacked) {
    Forest forest(17);
    Model& model = forest.model;
    // A sphere that is not around the middle of its box, and one that is as a signed zero.
    model.objects[0].representations[0].summary.bound.center += glm::dvec3(0.1, -0.0, 0.3);
    model.objects[1].demand = 3;
    model.objects[2].representations[0].summary.bound = {};
    const choose::ChoiceTable table = choose::ChoiceTable::whole(model, model.root, kAllKinds);
    size_t wishes = 0;
    for (uint32_t row = 0; row < table.size(); ++row) {
        const Object& object = model.objects[table.object(row).object];
        const Bound bound = table.bound(row);
        EXPECT_EQ(bound.center, object.bound().center);
        EXPECT_EQ(bound.radius, object.bound().radius);
        EXPECT_EQ(bound.box.low, object.bound().box.low);
        EXPECT_EQ(bound.box.high, object.bound().box.high);
        EXPECT_EQ(table.object(row).demand, object.demand);
        for (uint32_t i = 0; i < table.object(row).child_count; ++i) {
            const Placement& placed = object.representations[0].assembly().placements[i];
            const choose::TableChild& child = table.child(table.object(row).first_child + i);
            const choose::PlacementOverrides& overrides = table.overrides(child.overrides);
            const Object& below = model.objects[placed.object];
            EXPECT_EQ(child.object, placed.object);
            EXPECT_EQ(child.offset, placed.transform.offset);
            EXPECT_EQ(overrides.importance, placed.importance);
            EXPECT_EQ(overrides.demand, below.demand);
            EXPECT_EQ(overrides.coarsest, placed.coarsest);
            EXPECT_EQ(overrides.finest, placed.finest);
            EXPECT_EQ(overrides.hidden, placed.hidden);
            EXPECT_EQ(child.first_child, table.object(child.row).first_child);
            EXPECT_EQ(child.child_count, table.object(child.row).child_count);
            EXPECT_TRUE(below.group() || child.finest_error == 0);
            wishes += child.overrides != 0 ? 1 : 0;
        }
    }
    EXPECT_GT(wishes, 2u);
}

TEST(ChoiceTable, OpensADearStandInFromTheErrorOnAtWhichItsChildrenCostLess) {
    // Two balls at LOD 2 (20 triangles, 0.2 m) cost 2 (20 * 245 + 1500) = 12,800 bytes, at LOD 1
    // 42,200; a stand-in of 80 triangles and 0.15 m costs 21,100.
    Model model = models::row_of_balls(2);
    models::add_level(model, bent::kBall, 0.1, shapes::sphere(1, 1));
    models::add_level(model, bent::kBall, 0.2, shapes::sphere(1, 0));
    models::add_level(model, bent::kPair, 0.15, shapes::sphere(1, 1));
    summarize_assemblies(model, bottom_up(model));
    const choose::ChoiceTable table = choose::ChoiceTable::whole(model, model.root, kAllKinds);
    const choose::TableRow& pair = table.row(table.find(bent::kPair));
    EXPECT_EQ(table.level(pair.first_level).opens_from, 0.2);
    EXPECT_EQ(bent::drawn(model, models::view_from(1 + 0.15 * 640 + 0.1)), "pair 0 1");
    EXPECT_EQ(bent::drawn(model, models::view_from(1 + 0.2 * 640 - 0.1)), "pair 0 1");
    EXPECT_EQ(bent::drawn(model, models::view_from(1 + 0.2 * 640 + 0.1)),
              "pair 0/left 2, pair 0/right 2");
}

TEST(ChoiceTable, ASealedStandInIsNotOpenedThoughItsChildrenCostLess) {
    Model model = models::row_of_balls(2);
    models::add_level(model, bent::kBall, 0.1, shapes::sphere(1, 1));
    models::add_level(model, bent::kBall, 0.2, shapes::sphere(1, 0));
    models::add_level(model, bent::kPair, 0.15, shapes::sphere(1, 1));
    model.objects[bent::kPair].representations[1].summary.sealed = true;
    summarize_assemblies(model, bottom_up(model));
    EXPECT_EQ(bent::drawn(model, models::view_from(1 + 0.2 * 640 + 0.1)), "pair 0 1");
    EXPECT_EQ(bent::drawn(model, models::view_from(1000)), "pair 0 1");
    // It is still opened where it is not good enough.
    EXPECT_EQ(bent::drawn(model, models::view_from(1 + 0.15 * 640 - 0.1)),
              "pair 0/left 1, pair 0/right 1");
}

TEST(ChoiceTable, ChangesNoCutWhetherWholeOrMadeOnTheWay) {
    size_t openings = 0;
    for (uint32_t seed = 0; seed < 40; ++seed) {
        Forest forest(seed);
        const choose::ChoiceTable table =
            choose::ChoiceTable::whole(forest.model, forest.model.root, kAllKinds);
        for (int i = 0; i < 20; ++i) {
            const View view = forest.view();
            const choose::Cut cut = choose::choose_cut(table, view);
            expect_same(cut, choose::choose_cut(forest.model, view));
            for (uint32_t at = 0; at < cut.nodes.size(); ++at)
                openings += opened_though_good(forest.model, view, cut, at) ? 1 : 0;
        }
    }
    EXPECT_GT(openings, 100u);  // the forests have what this is about
}

TEST(ChoiceTable, NothingIsOpenedInVain) {
    for (uint32_t seed = 100; seed < 140; ++seed) {
        Forest forest(seed);
        const Model& model = forest.model;
        for (int i = 0; i < 20; ++i) {
            const View view = forest.view();
            const choose::Cut cut = choose::choose_cut(model, view);
            std::vector<uint64_t> below(cut.nodes.size(), 0);
            std::vector<uint64_t> children(cut.nodes.size(), 0);
            for (size_t at = cut.nodes.size(); at-- > 0;) {
                const choose::CutNode& node = cut.nodes[at];
                const Object& object = model.objects[node.object];
                if (!node.opened)
                    below[at] = object.representations[node.lod].summary.cost.bytes +
                                model.costs.occurrence_bytes;
                const auto index = static_cast<uint32_t>(at);
                if (node.opened) {
                    const choose::ChoiceReason reason =
                        choose::explain_choice(model, view, cut, index);
                    for (size_t lod = object.representations.size(); lod-- > 1;) {
                        const RepresentationSummary& summary = object.representations[lod].summary;
                        if (lod > node.coarsest ||
                            !choose::good_enough(view, summary.error, reason.stretch, reason.z,
                                                 reason.chosen.total))
                            continue;
                        EXPECT_GT(children[at], 0u);
                        EXPECT_LT(below[at], summary.cost.bytes + model.costs.occurrence_bytes);
                        break;
                    }
                }
                if (node.parent != choose::kNoParent) {
                    below[node.parent] += below[at];
                    ++children[node.parent];
                }
            }
        }
    }
}

TEST(ChoiceTable, NoChoiceAsksForMoreThanThePixelError) {
    for (uint32_t seed = 200; seed < 220; ++seed) {
        Forest forest(seed);
        const choose::ChoiceTable table =
            choose::ChoiceTable::whole(forest.model, forest.model.root, kAllKinds);
        View view = forest.view();
        for (view.pixel_error = 0.1; view.pixel_error < 64; view.pixel_error *= 1.5) {
            const choose::Cut cut = choose::choose_cut(table, view);
            for (const uint32_t node : cut.chosen) {
                const choose::ChoiceReason reason =
                    choose::explain_choice(forest.model, view, cut, node);
                EXPECT_LE(reason.chosen.error_px * reason.chosen.total,
                          view.pixel_error * (1 + 1e-12));
            }
        }
    }
}

TEST(ChoiceTable, WhyTellsWhatWasChosenByUnderAllThatBends) {
    for (uint32_t seed = 300; seed < 320; ++seed) {
        Forest forest(seed);
        View view = forest.view();
        for (int way = 0; bent::bend(view.modifiers, way);)
            ++way;
        view.modifiers.criterion = DetailCriterion::Resolution;  // others know no pixels
        view.modifiers.lenses = {bent::lens(100 * forest.any(), 300 * forest.any(), 5),
                                 bent::lens(-100 * forest.any(), 300 * forest.any(), 0.3)};
        view.modifiers.lenses[1].shape = LensShape::Box;
        view.modifiers.closing = view.camera;
        view.modifiers.closing->position.x += 1;
        const choose::ChoiceTable table =
            choose::ChoiceTable::whole(forest.model, forest.model.root, kAllKinds);
        const choose::Cut cut = choose::choose_cut(table, view);
        for (const uint32_t index : cut.chosen) {
            const choose::ChoiceReason reason =
                choose::explain_choice(forest.model, view, cut, index);
            const choose::CutNode& node = cut.nodes[index];
            EXPECT_EQ(reason.chosen.error_px, choose::error_on_screen(table, view, cut, node));
            EXPECT_FALSE(reason.chosen.error_px * reason.chosen.total >
                         view.pixel_error * (1 + 1e-12));
            EXPECT_GE(reason.chosen.total, 1.0 / 64);
        }
    }
}

TEST(ChoiceTable, IsSafeFromManyThreads) {
    Forest forest(7);
    const choose::ChoiceTable table =
        choose::ChoiceTable::whole(forest.model, forest.model.root, kAllKinds);
    std::vector<View> views(32);
    for (View& view : views)
        view = forest.view();
    std::vector<choose::Cut> cuts(views.size());
    parallel_for(views.size(), [&](size_t i) { cuts[i] = choose::choose_cut(table, views[i]); });
    for (size_t i = 0; i < views.size(); ++i)
        expect_same(cuts[i], choose::choose_cut(table, views[i]));
}
