// SPDX-License-Identifier: GPL-3.0-or-later
// PosedSurface error samples: pairs of points by which a followed level's error is known in every pose.
#pragma once

#include "geometry/vertex_rings.h"
#include "model/posed_surface.h"

#include <span>

namespace lodestone::deform {

/// A point of the source's surface and the one of the level that was nearest when it was bound.
/// Both are carried along, so their distance in another pose is never less than that from the one
/// point to the other surface; nor is that to what is found near the other point. Points are
/// (1-u-v) a + u b + v c of their corners.
struct PoseErrorSample {
    Triangle source{0, 0, 0};  // of the pose's points
    uint32_t level = 0;        // triangle of the level
    float source_u = 0, source_v = 0;
    float level_u = 0, level_v = 0;
    float area = 0;     // of the surface it stands for, when bound, m^2
    float facet = 0;    // area of the source's triangle then, m^2
    float longest = 0;  // its longest edge then, metres
};

/// Of the two directions: points of the source (its vertices), and of the level (vertices and
/// area).
struct PoseErrorSamples {
    std::vector<PoseErrorSample> of_source;
    std::vector<PoseErrorSample> of_level;
};

/// How far a level has strayed from the surface in some pose.
struct PoseError {
    double error = 0;   // metres: the larger 99.9 % quantile by area of both directions
    double max = 0;     // the largest distance
    double growth = 0;  // by how much lengths of the source have grown: 99 % quantile
};

/// A level in some pose, and what it was made from there.
struct FollowedLevel {
    const Mesh& level;
    std::span<const uint32_t> places;  // of the level's vertices: numbers that split ones share
    const geometry::VertexRings& level_rings;  // by place
    const PosedSurface& pose;
    const geometry::VertexRings& pose_rings;  // by point
};

/// Everything must be in range; what is not finite counts as infinitely far.
PoseError pose_error(const PoseErrorSamples& error_samples, const FollowedLevel& what);

}  // namespace lodestone::deform
