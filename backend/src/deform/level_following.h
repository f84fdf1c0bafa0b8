// SPDX-License-Identifier: GPL-3.0-or-later
// Level following: one simplified level for all frames, carried along by the surface it was made
// from.
#pragma once

#include "deform/pose_error_samples.h"
#include "model/posed_surface.h"
#include "simplify/simplify.h"

#include <optional>

namespace lodestone::deform {

/// A place of a level, tied to a triangle of the source's vertices: the point (1-u-v) a + u b + v
/// c, and from there `offset` along the surface's own axes (tangent, bitangent, normal), in parts
/// of `size`.
struct SurfaceAnchor {
    Triangle corners{0, 0, 0};
    float u = 0;
    float v = 0;
    glm::vec3 offset{0.0f};
};

/// A level with the data that put it into another pose. Texture coordinates, colors and slots are
/// those of the mesh in every pose.
struct BoundLevel {
    Mesh mesh;                     // in the pose it was bound in
    std::vector<uint32_t> places;  // by vertex, indices of anchors: split vertices stay together
    std::vector<SurfaceAnchor> anchors;  // by place
    /// Empty, or one for each vertex, along its anchor's axes; zero where the normal is that of its
    /// flat triangles, which is made anew.
    std::vector<glm::vec3> normals;
    PoseErrorSamples error_samples;
    /// In metres: its error in the pose it was bound in, if that is an error of materials; else 0.
    double look_error = 0;
};

/// Throws Error(InvalidArgument) unless every index is in range and every number finite. Files are
/// checked by it.
void check(const BoundLevel& level);

/// The surface that levels follow in one pose, computed once for all of them: smooth normals and
/// the area around every vertex.
class PoseSurface {
public:
    /// Keeps a reference to the pose. Throws Error(InvalidArgument) for an index out of range.
    explicit PoseSurface(const PosedSurface& pose);

    const PosedSurface& pose() const { return pose_; }
    /// The sum of the area vectors around a vertex, and a third of the sum of their lengths.
    const glm::dvec3& normal(uint32_t vertex) const { return normals_[vertex]; }
    double area(uint32_t vertex) const { return areas_[vertex]; }
    /// The rings of the pose's triangles, by point.
    const geometry::VertexRings& rings() const { return rings_; }

private:
    const PosedSurface& pose_;
    std::vector<glm::dvec3> normals_;
    std::vector<double> areas_;
    geometry::VertexRings rings_;
};

/// The place of an anchor on a surface: the point, the surface's axes there (columns; axes that it
/// does not have are zero) and the length that offsets are parts of.
struct AnchorFrame {
    glm::dvec3 point{0.0};
    glm::dmat3 axes{0.0};
    double size = 0;
};
AnchorFrame anchor_frame_of(const PoseSurface& surface, const SurfaceAnchor& anchor);

/// For each vertex the sum of its triangles' area vectors, and 1 where its normal is that of all of
/// them, or the mesh has no normals.
struct VertexFacing {
    std::vector<glm::dvec3> sums;
    std::vector<uint8_t> flat;
};
VertexFacing vertex_facing_of(const Mesh& mesh);

/// How far a level is from a surface where it follows it: `followed` is the result of follow().
PoseError pose_error(const BoundLevel& level, const Mesh& followed, const PoseSurface& surface);

/// The level in another pose. None when the pose has fewer points, or where a point that the level
/// depends on is not finite.
std::optional<Mesh> follow(const BoundLevel& level, const PoseSurface& surface);

}  // namespace lodestone::deform
