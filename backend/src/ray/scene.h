// SPDX-License-Identifier: GPL-3.0-or-later
// Scene: rays and closest points against one mesh; the only file pair that sees Embree.
#pragma once

#include "model/mesh.h"

#include <limits>
#include <memory>
#include <string>

namespace lodestone::ray {

inline constexpr uint32_t kNoTriangle = ~uint32_t{0};

/// Whether rays can be cast here: Embree 3.13 was found and passed its test of known answers. It is
/// looked for once, beside our own library and then where the system keeps libraries.
bool available(std::string* reason = nullptr);

/// Where a ray meets the mesh first. The point is (1-u-v) a + u b + v c of the triangle's corners.
struct Hit {
    bool hit = false;
    uint32_t triangle = kNoTriangle;  // among equally near ones the lowest
    double u = 0;
    double v = 0;
    double t = std::numeric_limits<double>::infinity();  // point = origin + t direction
    glm::dvec3 point{0.0};                               // in the mesh's frame, on the triangle
};

/// The point of the mesh nearest to another one; with no point in reach the distance is infinite.
struct Closest {
    double distance = std::numeric_limits<double>::infinity();  // metres
    uint32_t triangle = kNoTriangle;                            // the lowest of equally near ones
    glm::dvec3 point{0.0};
    double u = 0;
    double v = 0;
};

/// A mesh made ready for rays. It keeps its own copy, moved to its bound's center and scaled by a
/// power of two, so that Embree's single precision is spent on the mesh and not on where it is.
/// Const methods may be called from any thread. Every method throws Error(RaysUnavailable) where
/// available() is false. Answers do not depend on the number of threads that built the scene.
class Scene {
public:
    /// Triangles with a non-finite vertex are never hit. An empty mesh is never hit either. Throws
    /// Error(InvalidArgument) when an index is out of range.
    explicit Scene(const Mesh& mesh);
    ~Scene();
    Scene(Scene&&) noexcept;
    Scene& operator=(Scene&&) noexcept;
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    /// How many triangles the mesh had.
    size_t triangles() const;

    /// The nearest hit with 0 <= t <= far, from either side. Direction need not have unit length;
    /// a zero or non-finite one hits nothing. An origin may be arbitrarily far away.
    Hit first_hit(const glm::dvec3& origin, const glm::dvec3& direction,
                  double far = std::numeric_limits<double>::infinity()) const;

    /// Whether first_hit would hit; faster.
    bool occluded(const glm::dvec3& origin, const glm::dvec3& direction,
                  double far = std::numeric_limits<double>::infinity()) const;

    /// The nearest point of any triangle within `radius`. A good guess of the radius is faster.
    Closest closest_point(const glm::dvec3& point,
                          double radius = std::numeric_limits<double>::infinity()) const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace lodestone::ray
