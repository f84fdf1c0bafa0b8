// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/light_writer.h"

#include "base/maths.h"
#include "light/sun_plan.h"
#include "povray_export/scene/povray_number.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone::povray {
namespace {

/// Law: degrees of a radian.
constexpr double kDegrees = 180 / kPi;
// The radius of a light without one: POV-Ray's fading is 2 / (1 + (d/e)^2), so a tiny e makes it an
// exact 1/d^2 times 2 e^2.
// Taste: a larger value dims what is nearer than it.
constexpr double kNear = 1e-3;
/// The half angle in radians above which the fewest first rays miss shadows.
/// Taste: a larger value loses thin shadows of wide suns.
constexpr double kWideSun = 0.2;
/// The rays along an edge.
/// Taste: a larger value makes the softest penumbrae smoother, for time that grows with its square.
constexpr int kMostRays = 129;

/// The tangent of the angle by which the grid of a sun is turned.
/// Taste: that of turned grids of samples; 20 to 33 degrees are as good.
constexpr double kTurn = 0.5;

/// A unit vector at a right angle to a way, along none of the edges of upright things: rays behind
/// one another along a shadow's edge would be hidden all at once, in a few large steps.
glm::dvec3 turned(const glm::dvec3& way) {
    const glm::dvec3 level = perpendicular(way);
    return glm::normalize(level + kTurn * glm::cross(way, level));
}

/// A grid of rays along both edges: 2^n + 1, for POV-Ray refines by halving.
struct RayGrid {
    int u = 1;
    int v = 1;
    int start = 1;  // POV-Ray's adaptive: the first 2^start + 1 rays of an edge are always cast
};

class LightWriter {
public:
    LightWriter(std::string& out, const Light& light, const LightSampling& sampling)
        : out_(out), light_(light), grid_(sampling.grid), rays_(sampling.rays) {
        soft_ = sampling.rays > 1 && light.shadow && (!grid_ || grid_->rays > 1);
        parts_ = !grid_ || grid_->parts;
        start_ = sampling.thorough ? 1 : 0;
        parts_start_ = start_ + (!grid_ || grid_->soft ? 1 : 0);
        while (most_ < kMostRays && most_ < sampling.steps)
            most_ = 2 * most_ - 1;
    }

    void sun(const glm::dvec3& color, const Bound& bound) {
        const glm::dvec3 way = glm::normalize(light_.direction);
        const double reach = 2 * bound.radius + 1;
        // Cycles spreads the power over the disk tan(angle / 2) at distance 1.
        const double half = std::clamp(light_.angle / 2, 0.0, 1.5);
        const double r = std::tan(half);
        // The mean cosine between the middle and the disk is the light that a surface receives
        // less, as long as no part of the disk is below its horizon. An own light for each part
        // (area_illumination) shows only where some part is below, and shades every point 81 times.
        const double mean = r > 1e-4 ? 2 * (std::sqrt(1 + r * r) - 1) / (r * r) : 1;
        open(bound.center - way * reach, color * mean / kPi);
        out_ += " parallel point_at ";
        append_vector(out_, bound.center, 15);
        if (soft_ && half > 1e-4) {
            const int finest = light::finest_sun_rays(light_, 17);
            RayGrid grid{finest, finest, half > kWideSun ? start_ + 1 : start_};
            const glm::dvec3 u = turned(way);
            const double width = 2 * r * reach;
            append_grid(u * width, glm::cross(way, u) * width, grid);
            out_ += " circular";
        }
        close();
    }

    void point(const glm::dvec3& color) {
        // A disk of radius r that faces what it lights gives exactly 1 / (d^2 + r^2).
        fading(light_.position, color / (4 * kPi * kPi), light_.radius);
        if (soft_ && light_.radius > kNear)
            append_ball({17, 17, start_});
        close();
    }

    void spot(const glm::dvec3& color) {
        const bool soft = soft_ && light_.radius > kNear;
        // Parts of a disk that is drawn in parts lack the cosine at the disk: r / 2 stands for it.
        fading(light_.position, color / (4 * kPi * kPi),
               soft && parts_ ? light_.radius / 2 : light_.radius);
        const double outer = std::min(light_.spot_size / 2, kPi / 2);
        const double inner =
            std::acos(std::min(1.0, std::cos(outer) + (1 - std::cos(outer)) *
                                                          std::clamp(light_.spot_blend, 0.0, 1.0)));
        append_cone(inner, outer, 1);
        if (soft) {  // each part has its own cone, as in Cycles
            append_ball({9, 9, parts_start_});
            if (parts_)
                out_ += " area_illumination on";
        }
        close();
    }

    void area(const glm::dvec3& color) {
        const double width = glm::length(light_.edge_u);
        const double height = glm::length(light_.edge_v);
        const double size = width * height * (light_.round ? kPi / 4 : 1);
        double fade = 0;
        const bool soft = soft_ && std::max(width, height) > kNear;
        if (!soft || !parts_)  // a disk of this size on its axis
            fade = std::sqrt(size / kPi);
        const SpotCone cone = spread_cone();
        fading(light_.position, color * (cone.strength / (4 * kPi)), fade);
        append_cone(cone.inner, cone.outer, cone.tightness);
        if (soft) {
            RayGrid grid{9, 9, parts_start_};
            const double ratio = std::max(width, height) / std::min(width, height);
            int& longer = width > height ? grid.u : grid.v;
            int& shorter = width > height ? grid.v : grid.u;
            if (ratio > 3) {
                longer = ratio > 12 ? 33 : 17;
                shorter = ratio > 12 ? 3 : 5;
            }
            append_grid(light_.edge_u, light_.edge_v, grid);
            if (light_.round)
                out_ += " circular";
            if (parts_)
                out_ += " area_illumination on";
        }
        close();
    }

private:
    struct SpotCone {
        double inner = kPi / 2;
        double outer = kPi / 2;
        double tightness = 1;
        double strength = 1;
    };

    void open(const glm::dvec3& from, const glm::dvec3& color) {
        out_ += "light_source{";
        append_vector(out_, from, 15);
        out_ += " rgb ";
        append_vector(out_, color, 6);
    }

    /// Appends the fading: `color` / (d^2 + radius^2) at distance d.
    void fading(const glm::dvec3& from, const glm::dvec3& color, double radius) {
        const double e = std::max(radius, kNear);
        open(from, color / (2 * e * e));
        out_ += " fade_power 2 fade_distance ";
        append_number(out_, e);
    }

    /// Appends a cone: from 1 within `inner` to 0 at `outer` (radians), times cos^tightness.
    void append_cone(double inner, double outer, double tightness) {
        out_ += " spotlight point_at ";
        append_vector(out_, light_.position + glm::normalize(light_.direction), 15);
        out_ += " radius ";
        append_number(out_, inner * kDegrees);
        out_ += " falloff ";
        append_number(out_, outer * kDegrees);
        out_ += " tightness ";
        append_number(out_, tightness);
    }

    /// The rays along an edge, for the usual number of 17 along the edge of a lamp; others in
    /// proportion: 2^n + 1, 3 or more.
    int rays_of(int usual) const { return std::max((usual - 1) * (rays_ - 1) / 16, 2) + 1; }

    /// Appends the grid. POV-Ray puts its outermost rays on the edges, but the middles of n equal
    /// parts are wanted.
    void append_grid(const glm::dvec3& u, const glm::dvec3& v, RayGrid grid) {
        if (grid_) {
            const int shorter = light::shorter_edge(light_, grid_->rays);
            grid.u = glm::length(u) < glm::length(v) ? shorter : grid_->rays;
            grid.v = glm::length(u) < glm::length(v) ? grid_->rays : shorter;
        } else {
            grid.u = std::min(rays_of(grid.u), most_);
            grid.v = std::min(rays_of(grid.v), most_);
        }
        while (grid.start > 0 && (1 << grid.start) >= std::min(grid.u, grid.v))
            --grid.start;
        out_ += " area_light ";
        append_vector(out_, u * ((grid.u - 1.0) / grid.u), 15);
        out_ += ',';
        append_vector(out_, v * ((grid.v - 1.0) / grid.v), 15);
        for (const int rays : {grid.u, grid.v}) {
            out_ += ',';
            append_count(out_, static_cast<uint64_t>(rays));
        }
        out_ += " adaptive ";
        append_count(out_, static_cast<uint64_t>(grid.start));
    }

    void append_ball(const RayGrid& grid) {
        append_grid({2 * light_.radius, 0, 0}, {0, 2 * light_.radius, 0}, grid);
        out_ += " circular orient";
    }

    /// The cone of a light with a spread. Cycles lets an area emit cos x (1 - tan x / tan s) / (1 -
    /// s / tan s) within s, half the spread. Here it is one smooth cone, whose tightness and
    /// strength are fitted to that over the sphere.
    SpotCone spread_cone() const {
        const double s = light_.spread / 2;
        if (!(s > 0) || s > kPi / 2 - 0.01)
            return {};
        // Steps of the integral over the cone.
        // Taste: a larger value fits better than anybody can see, in more time.
        constexpr int kSteps = 64;
        const double norm = s < 1e-2 ? 3 / (s * s) : 1 / (1 - s / std::tan(s));
        const double low = std::cos(s);
        SpotCone best;
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i <= 40; ++i) {
            const double tightness = i * 0.2 / (s * s);
            double gg = 0;
            double gf = 0;
            double ff = 0;
            for (int k = 0; k < kSteps; ++k) {
                const double x = s * (k + 0.5) / kSteps;
                const double t = (std::cos(x) - low) / (1 - low);
                const double g = (3 - 2 * t) * t * t * std::pow(std::cos(x), tightness);
                const double f = norm * std::sin(s - x) / std::sin(s);
                gg += g * g * std::sin(x);
                gf += g * f * std::sin(x);
                ff += f * f * std::sin(x);
            }
            const double misfit = ff - gf * gf / gg;
            if (misfit < least) {
                least = misfit;
                best = {0, s, tightness, gf / gg};
            }
        }
        return best;
    }

    void close() { out_ += light_.shadow || conical() ? "}\n" : " shadowless}\n"; }
    // Whether the light has a cone; POV-Ray's shadowless is a kind of light of its own, which has
    // none.
    bool conical() const {
        return light_.kind == LightKind::Spot || light_.kind == LightKind::Area;
    }

    std::string& out_;
    const Light& light_;
    std::optional<light::LampGrid> grid_;
    bool soft_ = true;
    bool parts_ = true;  // each part of a lamp lights by itself
    int rays_ = 17;
    int most_ = 3;         // rays along an edge
    int start_ = 0;        // as RayGrid::start
    int parts_start_ = 1;  // the same of lamps that are drawn in parts
};

bool placed(const Light& light) {
    const double length = glm::length(light.direction);
    if (light.kind != LightKind::Point && !(length > 0 && std::isfinite(length)))
        return false;
    if (light.kind == LightKind::Area && !(finite(light.edge_u) && finite(light.edge_v)))
        return false;
    return light.kind == LightKind::Sun || finite(light.position);
}

}  // namespace

void append_light(std::string& out, const Light& light, const Bound& bound,
                  const LightSampling& sampling, Problems& problems) {
    // Cycles subtracts what a light of negative power would give, and so does POV-Ray.
    const glm::dvec3 color = light.color * light.power;
    if (!finite(color) || color == glm::dvec3(0.0))
        return;
    if (!placed(light)) {
        problems.push_back({light.name, Severity::Warning, "bad_light",
                            "has no finite place or direction, so it is not used"});
        return;
    }
    LightWriter writer(out, light, sampling);
    if (light.kind == LightKind::Sun)
        return writer.sun(color, bound);
    if (light.kind == LightKind::Point)
        return writer.point(color);
    if (!light.shadow)
        problems.push_back(
            {light.name, Severity::Warning, "light_shadow",
             "casts shadows all the same: POV-Ray has no spot or area light without"});
    if (light.kind == LightKind::Spot)
        return writer.spot(color);
    if (!(glm::length(glm::cross(light.edge_u, light.edge_v)) > 0)) {
        problems.push_back({light.name, Severity::Info, "light_size",
                            "is an area light without an area: it gives no light, as in Cycles"});
        return;
    }
    if (light.spread > 0 && light.spread < kPi - 0.02)
        problems.push_back({light.name, Severity::Info, "light_spread",
                            "its spread is drawn as a cone of about the same shape"});
    writer.area(color);
}

}  // namespace lodestone::povray
