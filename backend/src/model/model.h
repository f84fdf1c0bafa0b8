// SPDX-License-Identifier: GPL-3.0-or-later
// Model: objects, materials, lights and cameras; a DAG rooted in one object.
#pragma once

#include "model/cost_model.h"
#include "model/material.h"
#include "model/object.h"
#include "model/view.h"

#include <functional>
#include <vector>

namespace lodestone {

struct Model {
    std::vector<Object> objects;
    std::vector<Material> materials;
    std::vector<Light> lights;
    std::vector<Camera> cameras;
    World world;
    ObjectIndex root = kNoObject;
    CostModel costs;  // of the renderer that draws it
};

/// Objects reachable from the root, children before parents, each once. Throws
/// Error(InvalidArgument) naming an object that contains itself or an index out of range.
std::vector<ObjectIndex> bottom_up(const Model& model);

/// For every object 1 when it is marked Environment or places such an object at any depth.
std::vector<uint8_t> with_environment(const Model& model);

/// For every object 1 when it deforms or places such an object at any depth.
std::vector<uint8_t> with_deforming(const Model& model);

/// For every object 1 when something it places, at any depth, is hidden from some rays: one
/// stand-in for all of it would be seen by rays that must not see a part. Such a group has none.
std::vector<uint8_t> with_hidden(const Model& model);

/// Sets every object's demand from the decisions about the placements below it.
void set_demands(Model& model, const std::vector<ObjectIndex>& order);

/// Fills summaries of every assembly (bound, cost, hash), demands and source hashes from its
/// children. `order` is bottom_up's.
void summarize_assemblies(Model& model, const std::vector<ObjectIndex>& order);

/// Fills bound, cost and hash of a representation from its (mesh or primitive) payload;
/// `mesh_hash`: of the mesh, where it is known already.
void summarize(Representation& representation, const Model& model,
               std::optional<Hash> mesh_hash = std::nullopt);

/// Gives the model another renderer's costs, and prices every resident representation by them.
void set_costs(Model& model, const CostModel& costs);

/// The number of leaf occurrences below the root (each path of placements counts), and the sums of
/// all that they place. Sums that would be more than 64 bits hold are the largest number.
/// An object made of parts (Object::made_of_parts) is one object and one leaf.
struct ModelTotals {
    uint64_t objects = 0;  // with representations, groups included
    uint64_t occurrences = 0;
    uint64_t triangles_placed = 0;
    uint64_t triangles_unique = 0;
};
ModelTotals totals(const Model& model);

/// One leaf reached along one path, in depth-first order of placements.
struct Occurrence {
    ObjectIndex object = kNoObject;
    Affine world;
    std::string path;    // placement names joined by '/'
    RayMask hidden = 0;  // ray classes that do not see it
};
/// Whether an object made of parts is visited itself, or its parts.
enum class OccurrenceUnit { Objects, Parts };
/// The most occurrences of a model; more are refused.
/// Taste: a larger number waits longer for a few groups that place each other twice.
inline constexpr uint64_t kMostOccurrences = uint64_t{1} << 28u;
/// Throws Error(InvalidArgument) for cycles, and when there are more than kMostOccurrences.
void for_each_occurrence(const Model& model, const std::function<void(const Occurrence&)>& visit,
                         OccurrenceUnit below = OccurrenceUnit::Objects);

}  // namespace lodestone
