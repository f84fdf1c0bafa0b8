// SPDX-License-Identifier: GPL-3.0-or-later
// Level errors: how far a simplified mesh and its original are from each other, in all and by
// vertex.
#pragma once

#include "ray/closest_tree.h"
#include "simplify/fit/area_points.h"
#include "simplify/fit/fit_samples.h"
#include "simplify/fit/outline_views.h"

namespace lodestone::simplify {

/// Errors of a level, or the part of them that one of its vertices carries: the error of a place is
/// shared by the corners of its triangle as its barycentric coordinates say.
struct LevelError {
    double mean = 0;     // of the distances, both ways, in units of the mesh
    double square = 0;   // the mean of their squares
    double worst = 0;    // the largest distance found
    double outline = 0;  // the pixels of outline_views.h that only one of both covers

    /// Whether no error is larger than that of another level.
    bool within(const LevelError& other) const {
        return mean <= other.mean && square <= other.square && worst <= other.worst &&
               outline <= other.outline;
    }
};

struct LevelErrors {
    LevelError all;
    std::vector<LevelError> vertices;
};

/// Measures levels of one original: exact distances from the same points of it, and from points of
/// the level that are spread the same way, so that errors of two levels can be compared. Const
/// methods may be called from any thread; any number of threads gives the same bits.
class LevelMeter {
public:
    /// `opened`: the mesh that the original was opened as, whose frame is used. Keeps a reference
    /// to `source`.
    LevelMeter(const Mesh& source, const CollapseMesh& opened);

    /// The errors of a level from `samples` points each way. `places` are of the source; its mesh
    /// must be compact.
    LevelErrors measure(const FitPlaces& places, size_t samples, const Job& job) const;

    /// The samples that tell the vertices of a level apart.
    size_t samples_for(const CollapseMesh& mesh) const;

private:
    const Mesh& source_;
    std::vector<glm::vec3> positions_;  // of the source, halved: inside the unit sphere
    AreaPoints area_;
    ray::ClosestTree tree_;
    OutlineViews views_;
};

}  // namespace lodestone::simplify
