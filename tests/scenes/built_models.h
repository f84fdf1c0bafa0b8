// SPDX-License-Identifier: GPL-3.0-or-later
// Models with all their levels, built in the running test's scratch folder.
#pragma once

#include "hierarchy/hierarchy_build.h"
#include "scratch.h"
#include "segment/store.h"

/// Without a problem.
inline void build_in(lodestone::Model& model, const std::string& name) {
    lodestone::Problems problems;
    const lodestone::segment::Store store(scratch(name));
    lodestone::hierarchy::build_hierarchy(model, store, {}, problems, {});
    EXPECT_TRUE(problems.empty()) << problems[0].message;
}
