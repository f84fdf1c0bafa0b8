// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the flat table that choosing reads: it changes no cut, opens nothing in vain, and is safe from
// any thread.
#include "backend/bent.h"
#include "base/parallel.h"
#include "quality/criterion.h"
#include "quality/table.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

using namespace lodestone;

namespace {

void add_box(Model& model, ObjectIndex object, double error) {
    Representation box;
    box.summary.kind = Kind::Box;
    box.payload = Primitive{};
    box.materials = {0};
    summarize(box, model);
    box.summary.error = error;
    model.objects[object].representations.push_back(std::move(box));
}

/// Shared groups in groups, turned, scaled and mirrored, with dear, cheap and no stand-ins.
class Forest {
public:
    explicit Forest(uint32_t seed) : random_(seed) {
        std::vector<ObjectIndex> below(3);
        for (ObjectIndex& kind : below) {
            const ObjectIndex leaf = models::add_leaf(
                model, "leaf " + std::to_string(model.objects.size()), shapes::sphere(1, 3));
            add_levels(leaf, 0.02 * (1 + any()), 3);
            kind = leaf;
        }
        for (int level = 0; level < 3; ++level) {
            std::vector<ObjectIndex> made(3);
            for (ObjectIndex& one : made)
                one = group(below, std::pow(5.0, level + 1), level);
            below = made;
        }
        model.root = group(below, 700, 3);
        summarize_assemblies(model, bottom_up(model));
    }

    double any() { return std::uniform_real_distribution<double>(0, 1)(random_); }

    View view() {
        View made = models::view_from(std::exp2(11 * any()), std::exp2(6 * any() - 3));
        made.camera.position.x = 600 * any() - 300;
        made.camera.orthographic = any() < 0.2;
        return made;
    }

    Model model;

private:
    void add_levels(ObjectIndex object, double error, int finest) {
        for (int subdivisions = finest - 1; subdivisions >= 0; --subdivisions) {
            if (any() < 0.7)
                models::add_level(model, object, error, shapes::sphere(1, subdivisions));
            error *= 2 + 2 * any();
        }
        if (any() < 0.6)
            add_box(model, object, error);
    }

    ObjectIndex group(const std::vector<ObjectIndex>& below, double size, int level) {
        std::vector<Placement> placements;
        const int count = 2 + static_cast<int>(4 * any());
        for (int i = 0; i < count; ++i) {
            Placement placed;
            placed.object = below[static_cast<size_t>(any() * 2.999)];
            placed.name = std::to_string(i);
            placed.transform =
                models::moved(size * (any() - 0.5), size * (any() - 0.5), size * (any() - 0.5));
            if (any() < 0.5) {
                const double angle = 6 * any();
                const double scale = any() < 0.3 ? -1 - any() : 0.5 + any();
                placed.transform.linear =
                    scale * glm::dmat3(std::cos(angle), std::sin(angle), 0, -std::sin(angle),
                                       std::cos(angle), 0, 0, 0, 1);
            }
            if (any() < 0.1)
                placed.importance = std::exp2(4 * any() - 2);
            if (any() < 0.05)
                placed.coarsest = static_cast<uint32_t>(3 * any());
            if (any() < 0.05)
                placed.hidden = any() < 0.5 ? kAllRays : kShadowRays;
            placements.push_back(std::move(placed));
        }
        const ObjectIndex made = models::add_group(
            model, "group " + std::to_string(model.objects.size()), std::move(placements));
        if (any() < 0.85)
            add_levels(made, 0.1 * size * (1 + any()), level == 0 ? 2 : 4);
        return made;
    }

    std::mt19937 random_;
};

void expect_same(const quality::Cut& a, const quality::Cut& b) {
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    for (size_t i = 0; i < a.nodes.size(); ++i) {
        const quality::Node& one = a.nodes[i];
        const quality::Node& other = b.nodes[i];
        EXPECT_EQ(one.object, other.object);
        EXPECT_EQ(one.parent, other.parent);
        EXPECT_EQ(one.lod, other.lod);
        EXPECT_EQ(one.opened, other.opened);
        EXPECT_EQ(one.error_px, other.error_px);
        EXPECT_EQ(one.need, other.need);
        EXPECT_EQ(one.world.offset, other.world.offset);
    }
    EXPECT_EQ(a.chosen, b.chosen);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.bytes, b.bytes);
    EXPECT_EQ(a.kinds, b.kinds);
    EXPECT_EQ(a.largest_error_node, b.largest_error_node);
}

}  // namespace

TEST(Table, OfAnEmptyGroupHasOneRow) {
    Model model;
    model.root = models::add_group(model, "empty", {});
    summarize_assemblies(model, bottom_up(model));
    const quality::Table table = quality::Table::whole(model, model.root, kAllKinds);
    EXPECT_EQ(table.size(), 1u);
    EXPECT_TRUE(quality::choose(table, View{}).chosen.empty());
}

TEST(Table, KeepsSiblingsBesideEachOther) {
    const Model model = bent::pairs(8);
    const quality::Table table = quality::Table::whole(model, model.root, kAllKinds);
    EXPECT_EQ(table.size(), 3u);  // row, pair, ball: what is shared is there once
    const quality::TableRow& row = table.row(table.find(model.root));
    EXPECT_EQ(row.child_count, 4u);
    EXPECT_EQ(table.child(row.first_child + 1).offset.x, 6);
    EXPECT_EQ(table.child(row.first_child + 1).linear, quality::kUnturned);
    const quality::TableRow& ball = table.row(table.find(bent::kBall));
    ASSERT_EQ(ball.level_count, 3u);
    EXPECT_EQ(table.level(ball.first_level + 1).error, 0.1);
    EXPECT_EQ(table.level(ball.first_level + 1).triangles, 80u);
}

TEST(Table, OpensADearStandInFromTheErrorOnAtWhichItsChildrenCostLess) {
    // Two balls at LOD 2 (20 triangles, .2 m) cost 2 (20 * 245 + 1500) = 12,800 bytes, at LOD 1 42,200;
    // a stand-in of 80 triangles and .15 m costs 21,100.
    Model model = models::row_of_balls(2);
    models::add_level(model, bent::kBall, 0.1, shapes::sphere(1, 1));
    models::add_level(model, bent::kBall, 0.2, shapes::sphere(1, 0));
    models::add_level(model, bent::kPair, 0.15, shapes::sphere(1, 1));
    summarize_assemblies(model, bottom_up(model));
    const quality::Table table = quality::Table::whole(model, model.root, kAllKinds);
    const quality::TableRow& pair = table.row(table.find(bent::kPair));
    EXPECT_EQ(table.level(pair.first_level).opens_from, 0.2);
    EXPECT_EQ(bent::drawn(model, models::view_from(1 + 0.15 * 640 + 0.1)), "pair 0 1");
    EXPECT_EQ(bent::drawn(model, models::view_from(1 + 0.2 * 640 - 0.1)), "pair 0 1");
    EXPECT_EQ(bent::drawn(model, models::view_from(1 + 0.2 * 640 + 0.1)),
              "pair 0/left 2, pair 0/right 2");
}

TEST(Table, ChangesNoCutWhetherWholeOrMadeOnTheWay) {
    size_t openings = 0;
    for (uint32_t seed = 0; seed < 40; ++seed) {
        Forest forest(seed);
        const quality::Table table =
            quality::Table::whole(forest.model, forest.model.root, kAllKinds);
        for (int i = 0; i < 20; ++i) {
            const View view = forest.view();
            const quality::Cut cut = quality::choose(table, view);
            expect_same(cut, quality::choose(forest.model, view));
            for (const quality::Node& node : cut.nodes)
                openings += node.opened && node.need > 0 ? 1 : 0;
        }
    }
    EXPECT_GT(openings, 100u);  // the forests have what this is about
}

TEST(Table, NothingIsOpenedInVain) {
    for (uint32_t seed = 100; seed < 140; ++seed) {
        Forest forest(seed);
        const Model& model = forest.model;
        for (int i = 0; i < 20; ++i) {
            const View view = forest.view();
            const quality::Cut cut = quality::choose(model, view);
            std::vector<uint64_t> below(cut.nodes.size(), 0);
            std::vector<uint64_t> children(cut.nodes.size(), 0);
            for (size_t at = cut.nodes.size(); at-- > 0;) {
                const quality::Node& node = cut.nodes[at];
                const Object& object = model.objects[node.object];
                if (!node.opened)
                    below[at] =
                        object.representations[node.lod].summary.cost.bytes + kBytesPerOccurrence;
                if (node.opened && node.need > 0) {
                    const auto index = static_cast<uint32_t>(at);
                    const quality::Reason reason = quality::why(model, view, cut, index);
                    for (size_t lod = object.representations.size(); lod-- > 1;) {
                        const Summary& summary = object.representations[lod].summary;
                        if (lod > node.coarsest ||
                            !quality::good_enough(view, summary.error, reason.stretch, reason.z,
                                                  reason.chosen.total))
                            continue;
                        EXPECT_GT(children[at], 0u);
                        EXPECT_LT(below[at], summary.cost.bytes + kBytesPerOccurrence);
                        break;
                    }
                }
                if (node.parent != quality::kNoParent) {
                    below[node.parent] += below[at];
                    ++children[node.parent];
                }
            }
        }
    }
}

TEST(Table, NoChoiceAsksForMoreThanThePixelError) {
    for (uint32_t seed = 200; seed < 220; ++seed) {
        Forest forest(seed);
        const quality::Table table =
            quality::Table::whole(forest.model, forest.model.root, kAllKinds);
        View view = forest.view();
        for (view.pixel_error = 0.1; view.pixel_error < 64; view.pixel_error *= 1.5) {
            for (const quality::Node& node : quality::choose(table, view).nodes) {
                EXPECT_LE(node.need, view.pixel_error * (1 + 1e-12));
            }
        }
    }
}

TEST(Table, WhyTellsWhatWasChosenByUnderAllThatBends) {
    for (uint32_t seed = 300; seed < 320; ++seed) {
        Forest forest(seed);
        View view = forest.view();
        view.modifiers.lenses = {bent::lens(100 * forest.any(), 300 * forest.any(), 5),
                                 bent::lens(-100 * forest.any(), 300 * forest.any(), 0.3)};
        view.modifiers.lenses[1].shape = LensShape::Box;
        view.modifiers.screen_lenses = {bent::screen_lens(320, 180, 200, 3)};
        view.modifiers.depth = 1.5;
        view.modifiers.when_dark = view.modifiers.when_moving = true;
        view.modifiers.closing = view.camera;
        view.modifiers.closing->position.x += 1;
        const quality::Cut cut = quality::choose(forest.model, view);
        for (const uint32_t index : cut.chosen) {
            const quality::Reason reason = quality::why(forest.model, view, cut, index);
            const quality::Node& node = cut.nodes[index];
            if (node.need > 0) {
                EXPECT_EQ(node.need, node.error_px * reason.chosen.total);
            }
            EXPECT_GE(reason.chosen.total, 1.0 / 64);
        }
    }
}

TEST(Table, IsSafeFromManyThreads) {
    Forest forest(7);
    const quality::Table table = quality::Table::whole(forest.model, forest.model.root, kAllKinds);
    std::vector<View> views(32);
    for (View& view : views)
        view = forest.view();
    std::vector<quality::Cut> cuts(views.size());
    parallel_for(views.size(), [&](size_t i) { cuts[i] = quality::choose(table, views[i]); });
    for (size_t i = 0; i < views.size(); ++i)
        expect_same(cuts[i], quality::choose(table, views[i]));
}
