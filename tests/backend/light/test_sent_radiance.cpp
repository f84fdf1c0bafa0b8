// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what a lit point sends to the eye: its highlight is POV-Ray's.
#include "light/light_arrival.h"
#include "light/sent_radiance.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <gtest/gtest.h>

using namespace lodestone;
using namespace lodestone::light;

TEST(SentRadiance, AHighlightHasNoCosineAndFadesForALampOverhead) {
    Light lamp;
    lamp.kind = LightKind::Point;
    lamp.power = 100;
    const auto highlight = [&](double angle, double fading) {
        LitPoint point;
        point.albedo = glm::dvec3(0.0);
        point.to_eye = {-std::sin(angle), 0, std::cos(angle)};
        point.highlight = {0.5, 2, fading};
        lamp.position = {10 * std::sin(angle), 0, 10 * std::cos(angle)};
        const glm::dvec3 whole = light_arrival(lamp, {}, glm::normalize(lamp.position)).surface;
        return sent_radiance(lamp, point).x / whole.x;
    };
    const double full = 0.5 * 4 / (4 * (2 - 0.5));
    EXPECT_NEAR(highlight(0, 0), full, 1e-9);
    EXPECT_NEAR(highlight(1.5, 0), full, 1e-9);
    EXPECT_NEAR(highlight(0, 1), 0, 1e-3);
    EXPECT_GT(highlight(1.5, 1), 0.5 * full);
    EXPECT_EQ(highlight(2, 0), 0) << "a lamp below the surface";
}
