// SPDX-License-Identifier: GPL-3.0-or-later
// Settings of a build: what a stand-in depends on besides its source.
#pragma once

#include "base/hash.h"
#include "model/cost_model.h"
#include "model/object.h"
#include "model/view.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace lodestone {

struct Model;

}  // namespace lodestone

namespace lodestone::hierarchy {

/// The picture that a build is for when there is no time for all of it.
struct BuildDemand {
    View view;           // with the Pixel Error its picture is taken at
    double share = 0.2;  // most time to build, over what the picture takes as things are (a guess)
};

struct BuildSettings {
    /// Triangles of a level over those of the next finer one; its root below the first level of a
    /// large surface. Larger: a closer fit to every distance, more time and disk.
    double level_ratio = 0.4;
    /// Rays to measure an object's attributes.
    uint64_t rays = 4096;
    /// Area samples to measure an error, each way.
    uint32_t samples = 2048;
    /// Most triangles a group is flattened to before it is simplified.
    uint64_t group_triangles = 40000;
    uint64_t seed = 1;
    /// Also build what the store has already.
    bool rebuild = false;
    /// Build only what is reachable from these; empty: everything. What is stale elsewhere keeps
    /// its finest level alone, and stays stale.
    std::vector<ObjectIndex> scope;
    /// The same scene in a few frames that are always the same ones: what deforms takes its levels
    /// from one collapse for these, in every frame. Empty: it has none. Not part of the hash.
    std::vector<const Model*> poses;
    /// Build only what one picture gains most from, in a share of its time. What is left keeps its
    /// finest level alone, and stays stale. Not part of the hash.
    std::optional<BuildDemand> demand;
    /// Cameras, lights and the world need not be stored: a store that differs in nothing else stays
    /// as it is, as in most frames of an animation. Not part of the hash.
    bool of_one_frame = false;
    /// Finished stand-ins go to the store about this often, so that a build that is stopped or
    /// killed is gone on with, not begun again. Not part of the hash.
    double keep_every_s = 20;
};

/// The hash of every setting that changes a result, and of the version of the algorithms. Levels of
/// what deforms depend on nothing else: their random numbers begin with it.
Hash hash_of(const BuildSettings& settings);
/// The same with what drawing costs, which decides what other stand-ins are kept.
Hash hash_of(const BuildSettings& settings, const CostModel& costs);

}  // namespace lodestone::hierarchy
