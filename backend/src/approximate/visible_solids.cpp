// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/visible_solids.h"

#include "approximate/replace.h"
#include "measure/convex_bound.h"
#include "measure/sobol.h"

#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone::approximate {
namespace {

/// Solids of one kind, each in the frame in which it is the unit ball, or the cube -1...1. Single
/// precision: points are relative to the middle of all.
struct Frames {
    std::array<std::vector<float>, 12> columns;  // of a 3 x 4 matrix, row by row
    std::vector<glm::vec4> balls;                // around each solid, with squares of radii

    void add(const Primitive& primitive, const glm::dvec3& middle, bool box) {
        const glm::dvec3& half = primitive.half_size;
        balls.emplace_back(
            primitive.center - middle,
            box ? glm::dot(half, half) : std::pow(std::max({half.x, half.y, half.z}), 2));
        for (size_t row = 0; row < 3; ++row) {
            const auto axis = static_cast<int>(row);
            const glm::dvec3 along = primitive.axes[axis] / primitive.half_size[axis];
            for (size_t i = 0; i < 3; ++i)
                columns[4 * row + i].push_back(static_cast<float>(along[static_cast<int>(i)]));
            columns[4 * row + 3].push_back(
                static_cast<float>(-glm::dot(along, primitive.center - middle)));
        }
    }
    size_t size() const { return columns[0].size(); }

    /// Whether a ray, of length 1, comes near; most do not.
    bool near(size_t i, const glm::vec3& from, const glm::vec3& along) const {
        const glm::vec3 way = glm::vec3(balls[i]) - from;
        const float towards = std::max(0.0f, glm::dot(way, along));
        return glm::dot(way, way) - towards * towards <= balls[i].w;
    }
    glm::vec3 point(size_t i, const glm::vec3& at) const {
        return direction(i, at) + glm::vec3(columns[3][i], columns[7][i], columns[11][i]);
    }
    glm::vec3 direction(size_t i, const glm::vec3& along) const {
        const auto row = [&](size_t first) {
            return columns[first][i] * along.x + columns[first + 1][i] * along.y +
                   columns[first + 2][i] * along.z;
        };
        return {row(0), row(4), row(8)};
    }
};

bool meets_ball(const glm::vec3& from, const glm::vec3& along) {
    const float outside = glm::dot(from, from) - 1;
    if (outside < 0)
        return true;
    const float towards = glm::dot(from, along);
    return towards < 0 && towards * towards > glm::dot(along, along) * outside;
}

bool meets_cube(const glm::vec3& from, const glm::vec3& along) {
    float first = 0;
    float last = std::numeric_limits<float>::max();
    for (int i = 0; i < 3; ++i) {
        const float inverse = 1 / along[i];  // infinite is right: 0 is no way out of a slab
        const float a = (-1 - from[i]) * inverse;
        const float b = (1 - from[i]) * inverse;
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first < last;
}

class Scene {
public:
    Scene(const Composite& composite, const glm::dvec3& middle) {
        for (const Solid& solid : composite.solids) {
            Frames& frames = solid.box ? boxes_ : balls_;
            number_.push_back(frames.size());
            frames.add(solid.primitive, middle, solid.box);
        }
    }

    /// Whether anything but solid `own` lies along a ray, or around its start.
    bool hidden(size_t own, bool box, const glm::vec3& from, const glm::vec3& along) const {
        const size_t number = number_[own];
        for (size_t i = 0; i < balls_.size(); ++i) {
            if ((box || i != number) && balls_.near(i, from, along) &&
                meets_ball(balls_.point(i, from), balls_.direction(i, along)))
                return true;
        }
        for (size_t i = 0; i < boxes_.size(); ++i) {
            if (!(box && i == number) && boxes_.near(i, from, along) &&
                meets_cube(boxes_.point(i, from), boxes_.direction(i, along)))
                return true;
        }
        return false;
    }

private:
    Frames balls_;
    Frames boxes_;
    std::vector<size_t> number_;  // of a solid among its kind
};

/// A point of a solid's surface.
struct Place {
    glm::dvec3 point{0.0};
    glm::dvec3 normal{0.0};
    double weight = 1;  // of its area, over the mean
};

Place on_ball(const Primitive& primitive, double area, double u, double v) {
    const double z = 1 - 2 * u;
    const double radius = std::sqrt(std::max(0.0, 1 - z * z));
    const double turn = 2 * std::numbers::pi * v;
    const glm::dvec3 unit(radius * std::cos(turn), radius * std::sin(turn), z);
    const glm::dvec3& half = primitive.half_size;
    const glm::dvec3 steep = unit / half;
    const double length = glm::length(steep);
    Place out;
    out.point = primitive.center + primitive.axes * (half * unit);
    out.normal = primitive.axes * (steep / length);
    out.weight = 4 * std::numbers::pi * half.x * half.y * half.z * length / area;
    return out;
}

Place on_box(const Primitive& primitive, int face, double u, double v) {
    const int axis = face / 2;
    const double sign = face % 2 == 0 ? 1 : -1;
    glm::dvec3 at(0.0);
    at[axis] = sign;
    at[(axis + 1) % 3] = 2 * u - 1;
    at[(axis + 2) % 3] = 2 * v - 1;
    Place out;
    out.point = primitive.center + primitive.axes * (primitive.half_size * at);
    out.normal = sign * primitive.axes[axis];
    return out;
}

}  // namespace

VisibleSolids::VisibleSolids(uint32_t rays, uint64_t seed) {
    const measure::Sobol sobol(measure::scramble(seed) + 5);
    numbers_.resize(rays);
    for (uint32_t i = 0; i < rays; ++i) {
        const std::array<double, 4> point = sobol.point(i);
        for (size_t k = 0; k < 4; ++k)
            numbers_[i][k] = static_cast<float>(point[k]);
    }
}

measure::SurfaceInertia VisibleSolids::of(const Composite& composite, double share,
                                          const Job& job) const {
    struct Patch {
        size_t solid;
        int face;  // of a box
        double up_to;
        double area;
    };
    glm::dvec3 middle(0.0);
    for (const Solid& solid : composite.solids)
        middle += solid.primitive.center / static_cast<double>(composite.solids.size());
    double area = 0;
    glm::dvec3 first(0.0);
    glm::dmat3 second(0.0);
    std::vector<Patch> patches;
    for (size_t i = 0; i < composite.solids.size(); ++i) {
        const auto& [box, primitive, slot] = composite.solids[i];
        const glm::dvec3& half = primitive.half_size;
        const Shell shell = box ? box_shell(half) : ellipsoid_shell(half);
        const glm::dvec3 arm = primitive.center - middle;
        first += shell.area * arm;
        second += shell.area * glm::outerProduct(arm, arm);
        for (int axis = 0; axis < 3; ++axis)
            second += shell.area * shell.variances[axis] *
                      glm::outerProduct(primitive.axes[axis], primitive.axes[axis]);
        for (int face = 0; face < (box ? 6 : 1); ++face) {
            const int axis = face / 2;
            const double own = box ? 4 * half[(axis + 1) % 3] * half[(axis + 2) % 3] : shell.area;
            area += own;
            patches.push_back({i, face, area, own});
        }
    }
    measure::SurfaceInertia out;
    const auto rays = static_cast<size_t>(share * static_cast<double>(numbers_.size()));
    if (!(area > 0) || !std::isfinite(area) || rays == 0)
        return out;
    const Scene scene(composite, middle);
    double hidden = 0;
    glm::dvec3 hidden_first(0.0);
    glm::dmat3 hidden_second(0.0);
    for (size_t ray = 0; ray < rays; ++ray) {
        if (ray % 1024 == 0)
            job.check();
        const std::array<float, 4>& u = numbers_[ray];
        const double at = static_cast<double>(u[0]) * area;
        const auto patch =
            std::upper_bound(patches.begin(), patches.end() - 1, at,
                             [](double value, const Patch& one) { return value < one.up_to; });
        const double part = std::clamp((at - (patch->up_to - patch->area)) / patch->area, 0.0, 1.0);
        const Solid& solid = composite.solids[patch->solid];
        const Place place =
            solid.box ? on_box(solid.primitive, patch->face, part, static_cast<double>(u[1]))
                      : on_ball(solid.primitive, patch->area, part, static_cast<double>(u[1]));
        const glm::dvec3 along = measure::cosine_direction(place.normal, static_cast<double>(u[2]),
                                                           static_cast<double>(u[3]));
        const glm::dvec3 arm = place.point - middle;
        if (!scene.hidden(patch->solid, solid.box, glm::vec3(arm), glm::vec3(along)))
            continue;
        hidden += place.weight;
        hidden_first += place.weight * arm;
        hidden_second += place.weight * glm::outerProduct(arm, arm);
    }
    const double each = area / static_cast<double>(rays);
    out.area = area - each * hidden;
    if (!(out.area > 0))
        return {};
    const glm::dvec3 mean = (first - each * hidden_first) / out.area;
    out.center = middle + mean;
    out.moments = second - each * hidden_second - out.area * glm::outerProduct(mean, mean);
    return out;
}

}  // namespace lodestone::approximate
