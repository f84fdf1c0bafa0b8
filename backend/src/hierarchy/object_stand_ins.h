// SPDX-License-Identifier: GPL-3.0-or-later
// Stand-ins of one object: which are tried, and the list that is kept.
#pragma once

#include "base/job.h"
#include "hierarchy/build_settings.h"
#include "hierarchy/candidate.h"
#include "hierarchy/mesh_source.h"
#include "image/decoded_texels.h"
#include "model/model.h"

#include <vector>

namespace lodestone::hierarchy {

struct StandIns {
    Attributes attributes;
    std::vector<StandInCandidate> candidates;  // errors rise strictly, costs fall
    std::vector<SourceMaterial> sources;       // Object::sources
    /// The chunks of the finest, if that is a large surface.
    std::shared_ptr<const SurfaceLevel> surface;
};

struct StandInSurroundings;  // hierarchy/run/stand_in_surroundings.h

/// Levels and primitives of an object whose finest representation is a mesh. Something see-through
/// (foliage on cards, glass) has levels alone: no solid shows what it shows. `texels` are shared by
/// all objects of a build.
StandIns stand_ins_of_leaf(const Model& model, ObjectIndex leaf,
                           const StandInSurroundings& surroundings, const BuildSettings& settings,
                           const MeshSource& source, image::TexelCache& texels, const Job& job);

/// Stand-ins of a group whose children have theirs: flattened as finely as a stand-in can pay,
/// without what cannot be seen from outside, simplified and replaced. Never empty when anything
/// below can be drawn.
StandIns stand_ins_of_group(const Model& model, ObjectIndex group,
                            const StandInSurroundings& surroundings, const BuildSettings& settings,
                            const MeshSource& source, image::TexelCache& texels, const Job& job);

}  // namespace lodestone::hierarchy
