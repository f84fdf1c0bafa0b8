// SPDX-License-Identifier: GPL-3.0-or-later
// Levels of what deforms: collapsed once, put where the surface is in each frame.
#pragma once

#include "hierarchy/build_settings.h"
#include "hierarchy/candidate.h"
#include "hierarchy/mesh_source.h"
#include "hierarchy/run/deforming_poses.h"
#include "image/decoded_texels.h"
#include "segment/bound_level_file.h"

namespace lodestone::hierarchy {

/// The levels of something that deforms, one collapse for all frames: the one that suits all poses
/// of a bind together, tied to the surface it has in the first of them.
segment::BoundLevels bound_levels_of_leaf(const PoseBinding& bind, const BuildSettings& settings,
                                          const MeshSource& source, image::TexelCache& texels,
                                          const Job& job);

/// These levels where the object has them now. The errors are those of now, by samples: nothing
/// is measured anew. All that can be drawn, fine to coarse; an error is raised to the finer one's
/// where it would not be larger.
std::vector<StandInCandidate> followed_levels(const Model& model, const Object& object,
                                              const segment::BoundLevels& levels, const Job& job);

}  // namespace lodestone::hierarchy
