// SPDX-License-Identifier: GPL-3.0-or-later
// Traced candidates: what rays meet where a candidate stands.
#pragma once

#include "hierarchy/candidate.h"
#include "hierarchy/finest.h"

namespace lodestone::hierarchy {

/// The mesh that stands for a candidate where rays are cast; `solid` holds it unless it is a mesh.
const Mesh& traced_mesh(const StandInCandidate& candidate, Mesh& solid);

/// The skin of a candidate whose colors are as they were made: the finest's own where it has no
/// others.
ray::SkinPtr skin_of(const StandInCandidate& unmatched, const MeasuredFinest& finest);

}  // namespace lodestone::hierarchy
