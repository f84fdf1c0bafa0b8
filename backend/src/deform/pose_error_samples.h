// SPDX-License-Identifier: GPL-3.0-or-later
// Pose error samples: pairs of points by which a followed level's error is known in every pose.
#pragma once

#include "geometry/vertex_rings.h"
#include "model/posed_surface.h"

#include <span>

namespace lodestone::deform {

/// A point of the source's surface and the level's point that was nearest to it when the level was
/// bound. Both are carried along, so their distance in another pose is never less than the distance
/// from either point to the other surface; nor is the distance to any place found near the other
/// point. Points are (1-u-v) a + u b + v c of their corners.
struct PoseErrorSample {
    Triangle source{0, 0, 0};  // the corners, as points of the pose
    uint32_t level = 0;        // the triangle of the level
    float source_u = 0, source_v = 0;
    float level_u = 0, level_v = 0;
    float area = 0;     // the area of the surface it stands for, when bound, m^2
    float facet = 0;    // the area of the source's triangle then, m^2
    float longest = 0;  // the longest edge of that triangle then, metres
};

/// The samples of the two directions: points of the source (its vertices), and of the level
/// (vertices and area).
struct PoseErrorSamples {
    std::vector<PoseErrorSample> of_source;
    std::vector<PoseErrorSample> of_level;
};

/// How far a level has strayed from the surface in some pose.
struct PoseError {
    double error = 0;   // in metres: the larger 99.9 % quantile by area of the two directions
    double max = 0;     // the largest distance
    double growth = 0;  // by how much lengths of the source have grown: 99 % quantile
};

/// A level in some pose, and the surface it was made from in that pose.
struct FollowedLevel {
    const Mesh& level;
    /// By vertex of the level: numbers that split vertices share.
    std::span<const uint32_t> places;
    const geometry::VertexRings& level_rings;  // by place
    const PosedSurface& pose;
    const geometry::VertexRings& pose_rings;  // by point
};

/// Every index must be in range; points that are not finite count as infinitely far.
PoseError pose_error(const PoseErrorSamples& error_samples, const FollowedLevel& what);

}  // namespace lodestone::deform
