// SPDX-License-Identifier: GPL-3.0-or-later
// Tests that cast rays: skipped, with the reason, where Embree is missing.
#pragma once

#include "ray/mesh_scene.h"

#include <gtest/gtest.h>
#include <string>

class WithRays : public testing::Test {
protected:
    void SetUp() override {
        std::string reason;
        if (!lodestone::ray::available(&reason))
            GTEST_SKIP() << reason;
    }
};
