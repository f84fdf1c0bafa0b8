// SPDX-License-Identifier: GPL-3.0-or-later
// MeshScene: one mesh made ready for rays and closest points.
#pragma once

#include "model/mesh.h"
#include "ray/mesh_skin.h"
#include "ray/recent_blockers.h"

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lodestone::ray {

/// The number of no triangle.
/// Law: the largest number of 32 bits; no mesh has so many triangles.
inline constexpr uint32_t kNoTriangle = ~uint32_t{0};

/// Whether rays can be cast here: Embree 3.13 was found and passed its test of known answers. The
/// library is looked for once, beside our own library and then where the system keeps libraries.
bool available(std::string* reason = nullptr);

/// While an object of this class lives, many rays of its thread cost less: the thread flushes
/// denormal numbers to zero, as Embree wants it, and does so until the end instead of ray by ray.
class FlushDenormals {
public:
    FlushDenormals();
    ~FlushDenormals();
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
    unsigned saved_;
};

/// The first point where a ray meets the mesh: (1-u-v) a + u b + v c of the triangle's corners.
struct RayHit {
    bool hit = false;
    uint32_t triangle = kNoTriangle;  // the lowest of equally near ones
    double u = 0;
    double v = 0;
    double t = std::numeric_limits<double>::infinity();  // point = origin + t direction
    glm::dvec3 point{0.0};                               // on the triangle, in the mesh's frame
};

/// A place where a ray meets something that is there, and may go on behind it.
struct RayCrossing {
    uint32_t triangle = kNoTriangle;
    double u = 0;
    double v = 0;
    double t = 0;       // point = origin + t direction
    bool ends = false;  // no ray goes on
};
/// Tells by a triangle and its alpha at a point whether rays that are stopped there end there.
using EndsRay = std::function<bool(uint32_t triangle, double alpha)>;

/// The point of the mesh nearest to another one; with no point in reach the distance is infinite.
struct ClosestPoint {
    double distance = std::numeric_limits<double>::infinity();  // metres
    uint32_t triangle = kNoTriangle;                            // the lowest of equally near ones
    glm::dvec3 point{0.0};
    double u = 0;
    double v = 0;
};

/// The questions that a scene is asked.
enum class SceneUse : uint8_t { Everything, ClosestPoints };

struct ClosestSearch;

/// A mesh made ready for rays. It keeps its own copy, moved to its bound's center and scaled by a
/// power of two, so that Embree's single precision is spent on the mesh and not on where it is.
/// Const methods may be called from any thread. Every method throws Error(RaysUnavailable) where
/// available() is false. Answers do not depend on the number of threads that built the scene.
class MeshScene {
public:
    /// Makes a mesh ready. Triangles with a non-finite vertex are never hit; an empty mesh is never
    /// hit either. Throws Error(InvalidArgument) when an index is out of range. With a skin rays
    /// pass through transparent points, as often as these cover nothing, and the nearest point is
    /// one where there is something; a mesh that is opaque costs nothing more for it.
    /// A scene for closest points alone takes less time and memory; it may not be asked for hits.
    explicit MeshScene(const Mesh& mesh, SkinPtr skin = nullptr,
                       SceneUse uses = SceneUse::Everything);
    ~MeshScene();
    MeshScene(MeshScene&&) noexcept;
    MeshScene& operator=(MeshScene&&) noexcept;
    MeshScene(const MeshScene&) = delete;
    MeshScene& operator=(const MeshScene&) = delete;

    /// The number of triangles of the mesh.
    size_t triangles() const;

    /// Whether rays may pass through some of its points. Then both sides of every triangle can be
    /// seen, whether or not the mesh is closed.
    bool see_through() const;
    /// Whether a ray that meets a point of a triangle ends there: the same answer at every time,
    /// and over many points as often as their alpha says.
    bool ends_ray(uint32_t triangle, double u, double v) const;
    /// Whether there is anything to see at a point of a triangle.
    bool shows(uint32_t triangle, double u, double v) const;
    /// The share of rays that end at the triangle, where it is the same at all its points; else
    /// none.
    std::optional<double> uniform_alpha(uint32_t triangle) const;

    /// The nearest hit with 0 <= t <= far, from either side. Direction need not have unit length;
    /// a zero or non-finite one hits nothing. An origin may be arbitrarily far away.
    RayHit first_hit(const glm::dvec3& origin, const glm::dvec3& direction,
                     double far = std::numeric_limits<double>::infinity()) const;

    /// Whether first_hit() would hit; faster.
    bool occluded(const glm::dvec3& origin, const glm::dvec3& direction,
                  double far = std::numeric_limits<double>::infinity()) const;

    /// Whether anything blocks a ray without end; faster for rays that the same triangles block
    /// (see RecentBlockers).
    bool occluded(const glm::dvec3& origin, const glm::dvec3& direction,
                  RecentBlockers& blockers) const;

    /// Adds to `out` the places with 0 <= t <= far where first_hit() might stop, in no order, at
    /// least up to the nearest of those where `ends` says so, or the `most` nearest: in one search
    /// what a call of first_hit() for each would find.
    void list_crossings(const glm::dvec3& origin, const glm::dvec3& direction, double far,
                        size_t most, const EndsRay& ends, std::vector<RayCrossing>& out) const;

    /// The nearest point of any triangle within `radius` metres. A small radius is faster; so is
    /// `perhaps`, a triangle that may be near, which changes nothing else. With `enough`, some
    /// point within that distance will do where there is one.
    /// Where something transparent is nearest, the edge of the opaque part is found to an eighth of
    /// its triangle's size.
    ClosestPoint closest_point(const glm::dvec3& point,
                               double radius = std::numeric_limits<double>::infinity(),
                               uint32_t perhaps = kNoTriangle, double enough = 0) const;

    /// The nearest point within `radius` of the triangles whose fronts face a direction, whatever is
    /// shown there.
    ClosestPoint closest_facing(const glm::dvec3& point, const glm::dvec3& direction, double radius,
                                uint32_t perhaps = kNoTriangle) const;

private:
    struct Data;
    ClosestPoint closest(const glm::dvec3& point, ClosestSearch& search, double radius,
                         uint32_t perhaps, double enough) const;
    std::unique_ptr<Data> data_;
};

}  // namespace lodestone::ray
