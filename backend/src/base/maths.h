// SPDX-License-Identifier: GPL-3.0-or-later
// Small maths over GLM: affine transforms, bounds, symmetric matrices.
#pragma once

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vector_relational.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

namespace lodestone {

/// The ratio of a circle's circumference to its diameter.
/// Law: std::numbers::pi.
inline constexpr double kPi = std::numbers::pi;
/// The turn in radians that spreads directions evenly, kPi (3 - sqrt 5).
/// Law: the golden angle (Vogel 1979).
inline constexpr double kGoldenAngle = 2.399963229728653;
/// A double larger than every number.
/// Law: std::numeric_limits.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline bool finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool all_finite(std::span<const glm::vec3> points);

/// The value between `low` and `high`; `low` for a value that is not a number.
inline double limited(double value, double low, double high) {
    return value >= low ? glm::min(value, high) : low;
}
inline glm::dvec3 limited(const glm::dvec3& v, double low, double high) {
    return {limited(v.x, low, high), limited(v.y, low, high), limited(v.z, low, high)};
}
inline double largest(const glm::dvec3& v) {
    return glm::max(v.x, glm::max(v.y, v.z));
}

/// A unit vector at a right angle to a unit vector.
inline glm::dvec3 perpendicular(const glm::dvec3& unit) {
    const glm::dvec3 other = std::abs(unit.z) < 0.7 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    return glm::normalize(glm::cross(unit, other));
}

inline double trace(const glm::dmat3& m) {
    return m[0][0] + m[1][1] + m[2][2];
}

/// An affine transform: x -> linear * x + offset. Column-major inside (GLM), row-major 3x4 in the C
/// interface.
struct Affine {
    glm::dmat3 linear{1.0};
    glm::dvec3 offset{0.0};

    glm::dvec3 operator()(const glm::dvec3& point) const { return linear * point + offset; }
    /// The transform that applies `inner` first: (a * b)(x) = a(b(x)).
    Affine operator*(const Affine& inner) const {
        return {linear * inner.linear, linear * inner.offset + offset};
    }
    static Affine from_rows(const double rows[12]);
    void to_rows(double rows[12]) const;
    bool finite() const;
};

/// The largest singular value of the linear part: by how much the transform can enlarge an error.
double stretch(const Affine& transform);

/// The eigenvalues (descending) and orthonormal, right-handed axes (columns) of a symmetric matrix.
struct SymmetricEigen {
    glm::dvec3 values{0.0};
    glm::dmat3 axes{1.0};
};
SymmetricEigen eigen_symmetric(const glm::dmat3& matrix);

/// An axis-aligned box; a new one is empty.
struct Box3 {
    glm::dvec3 low{kInfinity};
    glm::dvec3 high{-kInfinity};

    bool empty() const { return low.x > high.x; }
    void add(const glm::dvec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    void add(const Box3& other) {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
    bool contains(const glm::dvec3& point) const {
        return glm::all(glm::lessThanEqual(low, point)) &&
               glm::all(glm::lessThanEqual(point, high));
    }
    /// How far a point lies outside of the range of each axis; 0 where it is within. Its length is
    /// the distance.
    glm::dvec3 beyond(const glm::dvec3& point) const {
        return glm::max(glm::max(low - point, point - high), glm::dvec3(0.0));
    }
    glm::dvec3 center() const { return 0.5 * (low + high); }
    glm::dvec3 size() const { return empty() ? glm::dvec3(0.0) : high - low; }
    /// 0, 1 or 2; of axes that are as long the first.
    int longest_axis() const {
        const glm::dvec3 edges = size();
        return edges.x >= edges.y && edges.x >= edges.z ? 0 : edges.y >= edges.z ? 1 : 2;
    }
};

/// The place of a thing: a sphere and an axis-aligned box in the same frame; both contain it.
struct Bound {
    glm::dvec3 center{0.0};
    double radius = 0;
    Box3 box;

    bool empty() const { return box.empty(); }
};

Bound bound_of(std::span<const glm::vec3> points);
/// The bound of both, in one frame.
Bound merged(const Bound& a, const Bound& b);
/// The bound of the transformed thing (conservative; the box is that of the transformed corners).
Bound transformed(const Bound& bound, const Affine& transform);
/// The bound of the transformed thing where the transform's stretch is known.
Bound transformed(const Bound& bound, const Affine& transform, double stretch);
/// The distance from a point to the bound: the larger of sphere and box distance, 0 inside.
double distance(const Bound& bound, const glm::dvec3& point);

}  // namespace lodestone
