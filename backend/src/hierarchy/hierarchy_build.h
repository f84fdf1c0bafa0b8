// SPDX-License-Identifier: GPL-3.0-or-later
// Hierarchy: gives every object of a model its stand-ins, from the store where they still fit.
#pragma once

#include "base/job.h"
#include "hierarchy/build_settings.h"
#include "model/model.h"
#include "segment/store.h"

namespace lodestone::hierarchy {

struct BuildReport {
    uint64_t objects = 0;  // reachable from the root
    uint64_t built = 0;    // of these, new or changed
    uint64_t left = 0;     // stale still: what settings.demand does not call for
    uint64_t representations = 0;
    uint64_t triangles = 0;  // of the finest meshes that are new or changed
    uint64_t bytes_written = 0;
    double wall_s = 0;
    double cpu_s = 0;
};

/// Tells what build_hierarchy() would do; wall_s is a guess from the triangles.
BuildReport estimate_build(Model& model, const segment::Store& store,
                           const BuildSettings& settings);

/// `model` has its finest representations resident, what else it has is replaced; afterwards every
/// reachable object has its list and the store holds it. Objects are matched with the store's by
/// source hash, so names and places may change freely. The same result on any number of threads.
/// Throws Error(Cancelled): then the model's lists are as before, and the store has what was
/// finished by settings.keep_every_s before. A broken object gets a problem and only its finest
/// level.
BuildReport build_hierarchy(Model& model, const segment::Store& store,
                            const BuildSettings& settings, Problems& problems, const Job& job);

}  // namespace lodestone::hierarchy
