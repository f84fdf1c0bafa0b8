// SPDX-License-Identifier: GPL-3.0-or-later
// ViewDistances: how far from the finest a stand-in is where an eye looks at it, from all around.
#pragma once

#include "base/job.h"
#include "measure/pictures/picture_grid.h"
#include "ray/mesh_scene.h"

#include <array>
#include <mutex>
#include <span>
#include <vector>

namespace lodestone::measure {

/// The points that distances are measured from: what is seen of the finest, or of both.
enum class ViewedWay : uint8_t { ToStandIn, Both };

/// Distances of points that are spread over a surface do not tell what one picture shows: a thing
/// in an opening, or on one of the narrow sides, is little of the surface and much of the picture
/// from there. Orthographic pictures are taken along 26 directions, to the faces, edges and corners
/// of a cube, of some 600 pixels around the finest each; of a quarter of these where what counts as
/// near is an eighth of the size or more, so that no eye for whom that is a pixel sees as many.
/// Where the finest covers few of them, as what is strewn does, these are divided, so that about as
/// many see it as of what is compact.
class ViewDistances {
public:
    /// Keeps references to the mesh and its scene; the pictures are taken when they are first asked
    /// for.
    ViewDistances(const Mesh& finest, const ray::MeshScene& scene);

    /// Metres, in the worst of the pictures: the distance that no more than one pixel in a thousand
    /// exceeds, or one in all, from what it shows of the finest to the nearest point of the
    /// stand-in, and if both ways, from what it shows of the stand-in to the nearest point of the
    /// finest, which takes several times as long. What is at most `near` counts as near; where all
    /// is, the result is `near` or less. The bits are the same on any number of threads. Throws
    /// Error: Cancelled.
    double worst(const ray::MeshScene& stand_in, ViewedWay ways, double near,
                 const Job& job = {}) const;

private:
    struct ViewRay {
        glm::dvec3 origin;
        uint32_t view;
        uint32_t pixels = 1;  // stands for so many
        bool seen = false;    // it meets the finest, there:
        glm::dvec3 point{0.0};
    };
    /// Pictures of about so many pixels each.
    struct ViewPictures {
        double pixels;
        std::once_flag taken;  // fills rays where they lead
        std::vector<ViewRay> rays;
    };
    void cast(std::span<ViewRay> rays, const Job& job) const;
    void divide(const PictureGrid& grid, std::span<const ViewRay> whole, size_t parts,
                const Job& job, std::vector<ViewRay>& out) const;
    std::vector<ViewRay> taken(double pixels, const Job& job) const;
    const std::vector<ViewRay>& rays(double near, const Job& job) const;

    const Mesh& finest_;
    const ray::MeshScene& scene_;
    std::vector<glm::dvec3> directions_;  // towards the eye
    double radius_;
    mutable ViewPictures fine_, coarse_;
};

/// No point of `from` is farther from the nearest vertex of `to` than that, metres; infinite where
/// there is none.
double farthest_apart(const Mesh& from, const Mesh& to);

}  // namespace lodestone::measure
