// SPDX-License-Identifier: GPL-3.0-or-later
#include "solids/visible_solids.h"

#include "measure/visible/sobol_points.h"
#include "solids/solid_replacement.h"

#include <glm/matrix.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone::solids {
namespace {

/// The solids of one kind, each in the frame in which it is the unit ball, or the cube -1...1.
/// Single precision: points are relative to the middle of all. Rays ask all of them at once, four
/// in one instruction, which takes less time than to stop at the first.
struct SolidFrames {
    std::array<std::vector<float>, 12> columns;  // by solid: the numbers of a 3 x 4 matrix

    void add(const Primitive& primitive, const glm::dvec3& middle) {
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

    /// Calls `meets` with start and direction in the frame of each, and keeps the results.
    template <typename Meets>
    void ask(const glm::vec3& from, const glm::vec3& along, std::vector<int32_t>& met,
             const Meets& meets) const {
        const size_t count = size();
        std::array<const float*, 12> of{};
        for (size_t i = 0; i < of.size(); ++i)
            of[i] = columns[i].data();
        int32_t* out = met.data();
        for (size_t i = 0; i < count; ++i) {
            const float dx = of[0][i] * along.x + of[1][i] * along.y + of[2][i] * along.z;
            const float dy = of[4][i] * along.x + of[5][i] * along.y + of[6][i] * along.z;
            const float dz = of[8][i] * along.x + of[9][i] * along.y + of[10][i] * along.z;
            const float x = of[0][i] * from.x + of[1][i] * from.y + of[2][i] * from.z + of[3][i];
            const float y = of[4][i] * from.x + of[5][i] * from.y + of[6][i] * from.z + of[7][i];
            const float z = of[8][i] * from.x + of[9][i] * from.y + of[10][i] * from.z + of[11][i];
            out[i] = meets(x, y, z, dx, dy, dz);
        }
    }
    void ask_balls(const glm::vec3& from, const glm::vec3& along, std::vector<int32_t>& met) const {
        ask(from, along, met, [](float x, float y, float z, float dx, float dy, float dz) {
            const float outside = x * x + y * y + z * z - 1;
            const float towards = x * dx + y * dy + z * dz;
            const float square = dx * dx + dy * dy + dz * dz;
            const int32_t ahead =
                (towards < 0 ? 1 : 0) & (towards * towards > square * outside ? 1 : 0);
            return (outside < 0 ? 1 : 0) | ahead;
        });
    }
    void ask_cubes(const glm::vec3& from, const glm::vec3& along, std::vector<int32_t>& met) const {
        const auto lesser = [](float a, float b) { return a < b ? a : b; };
        const auto greater = [](float a, float b) { return a > b ? a : b; };
        ask(from, along, met, [&](float x, float y, float z, float dx, float dy, float dz) {
            float first = 0;
            float last = std::numeric_limits<float>::max();
            const auto slab = [&](float at, float way) {
                const float inverse = 1 / way;  // infinity is right: 0 is no way out of a slab
                const float a = (-1 - at) * inverse;
                const float b = (1 - at) * inverse;
                first = greater(first, lesser(a, b));
                last = lesser(last, greater(a, b));
            };
            slab(x, dx);
            slab(y, dy);
            slab(z, dz);
            return first < last ? 1 : 0;
        });
    }
};

class SolidScene {
public:
    SolidScene(const Composite& composite, const glm::dvec3& middle) {
        for (const Solid& solid : composite.solids) {
            SolidFrames& frames = solid.box ? boxes_ : balls_;
            number_.push_back(frames.size());
            frames.add(solid.primitive, middle);
        }
        met_.resize(composite.solids.size(), 0);
    }

    /// Whether anything but solid `own` lies along a ray, or around its start.
    bool hidden(size_t own, bool box, const glm::vec3& from, const glm::vec3& along) {
        balls_.ask_balls(from, along, met_);
        if (!box)
            met_[number_[own]] = 0;
        if (any(balls_.size()))
            return true;
        boxes_.ask_cubes(from, along, met_);
        if (box)
            met_[number_[own]] = 0;
        return any(boxes_.size());
    }

private:
    bool any(size_t count) const {
        int32_t out = 0;
        for (size_t i = 0; i < count; ++i)
            out |= met_[i];
        return out != 0;
    }

    SolidFrames balls_;
    SolidFrames boxes_;
    std::vector<size_t> number_;  // the index of a solid among its kind
    std::vector<int32_t> met_;
};

/// Area and moments about a fixed point.
struct MomentSums {
    double area = 0;
    glm::dvec3 first{0.0};
    glm::dmat3 second{0.0};

    void add(double weight, const glm::dvec3& arm) {
        area += weight;
        first += weight * arm;
        second += weight * glm::outerProduct(arm, arm);
    }
    void add(double weight, const MomentSums& other) {
        area += weight * other.area;
        first += weight * other.first;
        second += weight * other.second;
    }
    /// Empty where no area is left.
    measure::SurfaceInertia about(const glm::dvec3& origin) const {
        measure::SurfaceInertia out;
        if (!(area > 0))
            return out;
        const glm::dvec3 mean = first / area;
        out.area = area;
        out.center = origin + mean;
        out.moments = second - area * glm::outerProduct(mean, mean);
        return out;
    }
};

/// A point of a solid's surface.
struct SolidPoint {
    glm::dvec3 point{0.0};
    glm::dvec3 normal{0.0};
    double weight = 1;  // that of its area, over the mean
};

/// A point on an ellipsoid; `turn`: cosine and sine of its angle.
SolidPoint on_ball(const Primitive& primitive, double area, double u, const glm::dvec2& turn) {
    const double z = 1 - 2 * u;
    const double radius = std::sqrt(std::max(0.0, 1 - z * z));
    const glm::dvec3 unit(radius * turn.x, radius * turn.y, z);
    const glm::dvec3& half = primitive.half_size;
    const glm::dvec3 steep = unit / half;
    const double length = glm::length(steep);
    SolidPoint out;
    out.point = primitive.center + primitive.axes * (half * unit);
    out.normal = primitive.axes * (steep / length);
    out.weight = 4 * std::numbers::pi * half.x * half.y * half.z * length / area;
    return out;
}

/// The direction in the world of one in the frame around a normal.
glm::dvec3 turned(const glm::dvec3& normal, const glm::dvec3& along) {
    const glm::dvec3 other = std::abs(normal.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(other, normal));
    return along.x * right + along.y * glm::cross(normal, right) + along.z * normal;
}

SolidPoint on_box(const Primitive& primitive, int face, double u, double v) {
    const int axis = face / 2;
    const double sign = face % 2 == 0 ? 1 : -1;
    glm::dvec3 at(0.0);
    at[axis] = sign;
    at[(axis + 1) % 3] = 2 * u - 1;
    at[(axis + 2) % 3] = 2 * v - 1;
    SolidPoint out;
    out.point = primitive.center + primitive.axes * (primitive.half_size * at);
    out.normal = sign * primitive.axes[axis];
    return out;
}

}  // namespace

VisibleSolids::VisibleSolids(uint32_t rays, uint64_t seed) {
    const measure::SobolPoints sobol(measure::scramble(seed) + 5);
    rays_.resize(rays);
    for (uint32_t i = 0; i < rays; ++i) {
        const std::array<double, 4> u = sobol.point(i);
        const double around = 2 * std::numbers::pi * u[1];
        const double turn = 2 * std::numbers::pi * u[3];
        const double out = std::sqrt(u[2]);
        rays_[i] = {static_cast<float>(u[0]), static_cast<float>(u[1]),
                    glm::vec2(std::cos(around), std::sin(around)),
                    glm::vec3(out * std::cos(turn), out * std::sin(turn),
                              std::sqrt(std::max(0.0, 1 - u[2])))};
    }
}

measure::SurfaceInertia VisibleSolids::of(const Composite& composite, double share, const Job& job,
                                          std::vector<measure::SurfaceInertia>* each) const {
    struct SolidPatch {
        size_t solid;
        int face;  // that of a box
        double up_to;
        double area;
    };
    const size_t count = composite.solids.size();
    if (each != nullptr)
        each->assign(count, {});
    glm::dvec3 middle(0.0);
    for (const Solid& solid : composite.solids)
        middle += solid.primitive.center / static_cast<double>(count);
    double area = 0;
    std::vector<MomentSums> seen(count);  // by solid
    std::vector<SolidPatch> patches;
    for (size_t i = 0; i < count; ++i) {
        const auto& [box, primitive, slot] = composite.solids[i];
        const glm::dvec3& half = primitive.half_size;
        const ShellMoments shell = box ? box_shell(half) : ellipsoid_shell(half);
        seen[i].add(shell.area, primitive.center - middle);
        for (int axis = 0; axis < 3; ++axis)
            seen[i].second += shell.area * shell.variances[axis] *
                              glm::outerProduct(primitive.axes[axis], primitive.axes[axis]);
        for (int face = 0; face < (box ? 6 : 1); ++face) {
            const int axis = face / 2;
            const double own = box ? 4 * half[(axis + 1) % 3] * half[(axis + 2) % 3] : shell.area;
            area += own;
            patches.push_back({i, face, area, own});
        }
    }
    const auto rays = static_cast<size_t>(share * static_cast<double>(rays_.size()));
    if (!(area > 0) || !std::isfinite(area) || rays == 0)
        return {};
    SolidScene scene(composite, middle);
    std::vector<MomentSums> hidden(count);
    for (size_t ray = 0; ray < rays; ++ray) {
        if (ray % 1024 == 0)
            job.check();
        const LeavingRay& one = rays_[ray];
        const double at = static_cast<double>(one.at) * area;
        const auto patch = std::upper_bound(
            patches.begin(), patches.end() - 1, at,
            [](double value, const SolidPatch& other) { return value < other.up_to; });
        const double part = std::clamp((at - (patch->up_to - patch->area)) / patch->area, 0.0, 1.0);
        const Solid& solid = composite.solids[patch->solid];
        const SolidPoint place =
            solid.box ? on_box(solid.primitive, patch->face, part, static_cast<double>(one.across))
                      : on_ball(solid.primitive, patch->area, part, glm::dvec2(one.around));
        const glm::dvec3 along = turned(place.normal, glm::dvec3(one.along));
        const glm::dvec3 arm = place.point - middle;
        if (scene.hidden(patch->solid, solid.box, glm::vec3(arm), glm::vec3(along)))
            hidden[patch->solid].add(place.weight, arm);
    }
    MomentSums all;
    for (size_t i = 0; i < count; ++i) {
        seen[i].add(-area / static_cast<double>(rays), hidden[i]);
        all.add(1, seen[i]);
        if (each != nullptr)
            (*each)[i] = seen[i].about(middle);
    }
    return all.about(middle);
}

}  // namespace lodestone::solids
