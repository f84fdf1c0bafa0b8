// SPDX-License-Identifier: GPL-3.0-or-later
// Proposal rounds: what proposers are told of an original, and what they have proposed so far.
#pragma once

#include "hierarchy/candidate.h"
#include "hierarchy/evaluators/picture_error.h"
#include "hierarchy/finest.h"
#include "prune/part_pruning.h"

#include <functional>
#include <vector>

namespace lodestone::hierarchy {

/// Where collapsing to this share of the triangles stays near the surface, parts are details of it.
/// Taste: a larger value prunes fewer things.
inline constexpr double kCollapsed = 0.2;
/// The error that is still near, over the radius.
/// Taste: a larger value prunes fewer things.
inline constexpr double kNear = 1.0 / 8;
/// The error of a composite of eight solids, over the radius, more or less.
/// Fitted: to measured composites of eight; the script was not kept.
inline constexpr double kOff = 0.2;

/// Triangles of a mesh that costs so many bytes for each of its occurrences.
size_t triangles_for(double bytes, uint64_t uses, const CostModel& costs);

/// Whether a crowd is many parts of a few triangles each: how far their points are from those of
/// fewer tells little.
bool is_foliage(const prune::Crowd& crowd);

/// The object or group that stand-ins replace, and so what they must be better than.
struct ReplacedObject {
    Bound bound;
    uint64_t uses = 1;
    CostModel costs = {};
    double bytes = 0;     // as one mesh
    double most = 0;      // bytes of an occurrence that are no use any more
    bool many = false;    // its parts are objects
    bool alike = false;   // likewise, and many of these are of about one size
    bool ground = false;  // some of it is: no solid stands for that
    /// The error from which on its parts cost less than so many bytes; empty: never.
    std::function<double(double bytes)> cheaper_from = {};
    /// Whether an occurrence of so many bytes costs less than its parts within an error; empty:
    /// always.
    std::function<bool(double bytes, double error)> pays = {};
};

/// The limits within which proposals are worth their while. All that they refer to must last.
struct ProposalLimits {
    const Mesh& mesh;  // the finest, or what of it can be seen: stand-ins are made of this
    ReplacedObject whole;
    double level_ratio = 0.4;               // as BuildSettings
    std::vector<size_t> targets = {};       // triangles of levels, falling
    bool surface = false;                   // it may be a large surface, of many chunks
    double told = 0;                        // errors up to this are told in any case
    std::vector<uint8_t> environment = {};  // by triangle of the finest; empty: no group
    /// The error from which on a mesh of so many triangles is no use, whatever else there is;
    /// empty: it is always of some use.
    std::function<double(size_t triangles)> useless = {};
    /// Finds the loose parts that may be pruned; empty: there are none.
    std::function<prune::Crowd()> find_crowd = {};
};

/// One original's way along the proposers (proposers.h). Each finds here what those before it
/// proposed and found out. All that is given must last.
struct ProposalRound {
    ProposalRound(const MeasuredFinest& original, FinestPictures& taken,
                  const ProposalLimits& limits_of_it, const Job& asked);

    const MeasuredFinest& finest;
    FinestPictures& pictures;
    const ProposalLimits& limits;
    const Job& job;
    prune::Crowd crowd;  // empty too where looking for it does not pay
    /// Distances tell little of what is seen through, or is a crowd: pictures compare its solids.
    bool by_pictures = false;
    bool pruned = false;   // the crowd's parts are worth thinning out
    bool painted = false;  // painted boxes were proposed
    /// A box and an ellipsoid, by distance: levels that are no nearer are no use. They are no
    /// candidates before it is known that pictures need not compare them.
    std::vector<StandInCandidate> near_solids;
    std::vector<StandInCandidate> candidates;
    std::shared_ptr<const SurfaceLevel> surface;  // the chunks of the finest, where it has some
};

}  // namespace lodestone::hierarchy
