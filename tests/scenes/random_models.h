// SPDX-License-Identifier: GPL-3.0-or-later
// Random models and views, and what it is for two cuts to be the same.
#pragma once

#include "choose/cut.h"
#include "scenes/lens_views.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace lodestone::forest {

inline void add_box(Model& model, ObjectIndex object, double error) {
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

/// To the last bit, and in all.
inline void expect_same(const choose::Cut& a, const choose::Cut& b) {
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    for (size_t i = 0; i < a.nodes.size(); ++i) {
        const choose::CutNode& one = a.nodes[i];
        const choose::CutNode& other = b.nodes[i];
        ASSERT_EQ(one.object, other.object);
        ASSERT_EQ(one.parent, other.parent);
        ASSERT_EQ(one.placement, other.placement);
        ASSERT_EQ(one.lod, other.lod);
        ASSERT_EQ(one.kind, other.kind);
        ASSERT_EQ(one.opened, other.opened);
        ASSERT_EQ(one.importance, other.importance);
        ASSERT_EQ(one.coarsest, other.coarsest);
        ASSERT_EQ(one.finest, other.finest);
        ASSERT_EQ(one.hidden, other.hidden);
        ASSERT_EQ(a.world(one).offset, b.world(other).offset);
        ASSERT_EQ(a.world(one).linear, b.world(other).linear);
    }
    EXPECT_EQ(a.chosen, b.chosen);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.bytes, b.bytes);
    EXPECT_EQ(a.originals, b.originals);
    EXPECT_EQ(a.kinds, b.kinds);
    EXPECT_EQ(a.largest_error_px, b.largest_error_px);
    EXPECT_EQ(a.largest_error_node, b.largest_error_node);
}

}  // namespace lodestone::forest
