// SPDX-License-Identifier: GPL-3.0-or-later
// Stand-ins of one object: candidates, their errors, and the list that is kept.
#pragma once

#include "base/job.h"
#include "build/poses.h"
#include "build/settings.h"
#include "image/texels.h"
#include "model/model.h"
#include "segment/bound_file.h"

#include <functional>

namespace lodestone::build {

/// A stand-in on its way into the model; its materials are its own until it is added.
struct Candidate {
    Kind kind = Kind::Mesh;
    double error = 0;
    double max_error = 0;
    std::shared_ptr<const Mesh> mesh;  // of a mesh
    Primitive primitive;               // of a box or ellipsoid
    std::shared_ptr<const Composite> composite;
    std::vector<Material> materials;  // by slot
    bool pictured = false;            // compared by pictures, and as bright as they are
};

struct StandIns {
    Attributes attributes;
    std::vector<Candidate> candidates;  // errors rise strictly, costs fall
};

struct Surroundings;  // build/flatten.h

/// Gives the mesh of a representation, resident or not. Called from several threads.
using MeshSource = std::function<std::shared_ptr<const Mesh>(const Representation&)>;

/// Levels and primitives of an object whose finest representation is a mesh. Something see-through
/// (foliage on cards, glass) has levels alone: no solid shows what it shows. `texels` are shared by
/// all objects of a build.
StandIns stand_ins_of_leaf(const Model& model, const Object& object, uint64_t uses,
                           const Settings& settings, const MeshSource& source,
                           image::TexelCache& texels, const Job& job);

/// Of a group whose children have theirs: flattened at a quarter of its finest stand-in's error,
/// without what cannot be seen from outside, simplified and replaced. Never empty when anything
/// below can be drawn.
StandIns stand_ins_of_group(const Model& model, ObjectIndex group, const Surroundings& surroundings,
                            const Settings& settings, const MeshSource& source,
                            image::TexelCache& texels, const Job& job);

/// The levels of something that deforms, one collapse for all frames: the one that suits all poses
/// of a bind together, tied to the surface it has in the first of them.
segment::BoundLevels bound_levels_of_leaf(const Bind& bind, const Settings& settings,
                                          const MeshSource& source, image::TexelCache& texels,
                                          const Job& job);

/// These levels where the object has them now. The errors are those of now, by witnesses: nothing is
/// measured anew. All that can be drawn, fine to coarse; an error is raised to the finer one's where
/// it would not be larger.
std::vector<Candidate> followed_levels(const Model& model, const Object& object,
                                       const segment::BoundLevels& levels, const Job& job);

/// Sorts by cost and drops every candidate that is no better than a cheaper one (Pareto front of
/// bytes and error), and those that cost no less than `finest_bytes`; with so many occurrences.
void keep_useful(std::vector<Candidate>& candidates, uint64_t finest_bytes, uint64_t uses = 1);

}  // namespace lodestone::build
