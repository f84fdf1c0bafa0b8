// SPDX-License-Identifier: GPL-3.0-or-later
// Surroundings: what the stand-ins of an object depend on besides what it is made of.
#pragma once

#include "base/hash.h"
#include "base/job.h"
#include "hierarchy/mesh_source.h"
#include "model/model.h"

namespace lodestone::hierarchy {

/// The surroundings of every object of a model, by index; made once for a build.
struct StandInSurroundings {
    std::vector<uint64_t> uses;        // how often each object is drawn (uses_of)
    std::vector<uint8_t> environment;  // whether it is or holds Environment (with_environment)
    std::vector<uint8_t> hidden;       // whether it hides anything from some rays (with_hidden)
    std::vector<Hash> layers;          // what lies in thin layers (layers_of)
    std::vector<uint8_t> marked;       // what is nothing but Environment (marked_environment)
    std::vector<uint8_t> ground;       // what is recognized as such (grounds_of)
};

/// `order`: children before parents.
StandInSurroundings surroundings_of(const Model& model, const std::vector<ObjectIndex>& order,
                                    const MeshSource& source, const Job& job);

/// How often each object is drawn: the number of paths to it from the root.
std::vector<uint64_t> uses_of(const Model& model);

}  // namespace lodestone::hierarchy
