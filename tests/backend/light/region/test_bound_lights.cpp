// SPDX-License-Identifier: GPL-3.0-or-later
// Guards the lamps of things on which no lit point lies: those near by, and no fewer than matter.
#include "base/random.h"
#include "light/light_arrival.h"
#include "light/region/bound_lights.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>

using namespace lodestone;
using namespace lodestone::light;

namespace {

Light lamp_at(const glm::dvec3& position, double power = 10) {
    Light lamp;
    lamp.kind = LightKind::Point;
    lamp.position = position;
    lamp.power = power;
    return lamp;
}

Light window_at(const glm::dvec3& position) {
    Light lamp = lamp_at(position);
    lamp.kind = LightKind::Area;
    lamp.direction = {0, -1, 0};
    lamp.edge_u = {1, 0, 0};
    lamp.edge_v = {0, 0, 1};
    return lamp;
}

Bound ball(const glm::dvec3& center, double radius = 0.5) {
    Bound bound;
    bound.center = center;
    bound.radius = radius;
    bound.box.add(center - radius);
    bound.box.add(center + radius);
    return bound;
}

std::vector<BoundGroup> groups_of(const std::vector<Light>& lamps, const std::vector<Bound>& bounds,
                                  double pixel_error = 1) {
    std::vector<const Light*> pointers;
    pointers.reserve(lamps.size());
    for (const Light& lamp : lamps)
        pointers.push_back(&lamp);
    std::vector<uint32_t> things(bounds.size());
    std::iota(things.begin(), things.end(), 0u);
    return group_by_bounds(pointers, bounds, things, pixel_error);
}

/// The lamps of a thing.
std::vector<uint32_t> lamps_of(const std::vector<BoundGroup>& groups, uint32_t thing) {
    for (const BoundGroup& group : groups) {
        if (std::count(group.things.begin(), group.things.end(), thing) != 0)
            return group.lamps;
    }
    ADD_FAILURE() << "thing " << thing << " is in no group";
    return {};
}

}  // namespace

TEST(BoundLights, WithoutThingsOrLampsThereIsNothingToDivide) {
    EXPECT_TRUE(groups_of({lamp_at({0, 0, 0})}, {}).empty());
    const std::vector<BoundGroup> dark = groups_of({}, {ball({0, 0, 0})});
    ASSERT_EQ(dark.size(), 1u);
    EXPECT_TRUE(dark[0].lamps.empty());
}

TEST(BoundLights, NoSurfaceInABoundGetsMore) {
    PcgRandom random(3);
    const auto place = [&](double size) {
        return size * (glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 0.5);
    };
    for (int i = 0; i < 2000; ++i) {
        const Light lamp = i % 2 == 0 ? lamp_at(place(10)) : window_at(place(10));
        const Bound bound = ball(place(10), 0.5 + random.uniform());
        const glm::dvec3 point = bound.center + place(2 * bound.radius / std::sqrt(3.0));
        const double most = most_radiance(lamp, bound).x;
        const glm::dvec3 to_lamp = lamp.position - point;
        if (!(glm::dot(to_lamp, to_lamp) > 0))
            continue;
        const double here = light_arrival(lamp, point, glm::normalize(to_lamp)).surface.x;
        EXPECT_LE(here, most * (1 + 1e-9)) << i;
    }
}

TEST(BoundLights, AThingBehindAWindowGetsNothingOfIt) {
    EXPECT_EQ(most_radiance(window_at({0, 0, 0}), ball({0, 2, 0})).x, 0);
    EXPECT_GT(most_radiance(window_at({0, 0, 0}), ball({0, -2, 0})).x, 0);
    // Beside it, it is small, by the angle.
    EXPECT_LT(most_radiance(window_at({0, 0, 0}), ball({20, -0.1, 0}, 0.1)).x,
              0.1 * most_radiance(window_at({0, 0, 0}), ball({0, -20, 0}, 0.1)).x);
}

// Trees of a forest that no point lay on were lit by the lamps of all houses.
TEST(BoundLights, ThingsAreLitByTheLampsOfTheirPlace) {
    std::vector<Light> lamps;
    std::vector<Bound> bounds;
    for (int house = 0; house < 4; ++house) {
        for (int i = 0; i < 6; ++i) {
            lamps.push_back(lamp_at({1000.0 * house + i, 0, 3}));
            bounds.push_back(ball({1000.0 * house + i, 4, 0}));
        }
    }
    const std::vector<BoundGroup> groups = groups_of(lamps, bounds);
    EXPECT_EQ(groups.size(), 4u);
    for (uint32_t thing = 0; thing < bounds.size(); ++thing) {
        const std::vector<uint32_t> own = lamps_of(groups, thing);
        ASSERT_EQ(own.size(), 6u) << thing;
        EXPECT_EQ(own.front() / 6, thing / 6);
        EXPECT_EQ(own.back() / 6, thing / 6);
    }
    // With 0, none is left out that could be seen in the dark.
    EXPECT_EQ(lamps_of(groups_of(lamps, bounds, 0), 0).size(), lamps.size());
}

TEST(BoundLights, ManyFaintLampsTogetherAreNotLeftOut) {
    std::vector<Light> lamps;
    lamps.reserve(1000);
    for (int i = 0; i < 1000; ++i)
        lamps.push_back(lamp_at({0, 0, 50.0 + 0.01 * i}, 20));
    const std::vector<Bound> bounds{ball({0, 0, 0})};
    const std::vector<uint32_t> lit = lamps_of(groups_of(lamps, bounds), 0);
    const double one = most_radiance(lamps[0], bounds[0]).x;
    const double allowed = light_tolerance(glm::dvec3(0.0), 1).x;
    EXPECT_LT(one, allowed);
    EXPECT_GT(lit.size(), 0u);
    EXPECT_LE(static_cast<double>(lamps.size() - lit.size()) * 0.5 * one, allowed);
}

TEST(BoundLights, TooManyPairsAreOneGroupWithAllLamps) {
    const std::vector<Light> lamps(3000, lamp_at({0, 0, 0}));
    const std::vector<Bound> bounds(1000, ball({1e6, 0, 0}));
    const std::vector<BoundGroup> groups = groups_of(lamps, bounds);
    ASSERT_EQ(groups.size(), 1u);
    EXPECT_EQ(groups[0].things.size(), bounds.size());
    EXPECT_EQ(groups[0].lamps.size(), lamps.size());
}
