// SPDX-License-Identifier: GPL-3.0-or-later
#include "deform/pose_error_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::deform {
namespace {

// The share of the area whose distance is the error.
// Law: the same as in measure/deviation/surface_deviation.
constexpr double kErrorShare = 0.999;
// The share of the source's lengths that have grown by less.
// Taste: a larger one lets single stretched edges decide.
constexpr double kGrowthShare = 0.99;
// The most steps of a walk: farther than this many triangles, surfaces that slide along each other
// seem to be apart.
// Taste: more walk farther, more slowly.
constexpr int kSearchSteps = 24;

struct WeightedValue {
    double value;
    double weight;
};

/// The least value that this share of the weight does not exceed; 0 for no values.
double quantile(std::vector<WeightedValue>& values, double share) {
    double sum = 0;
    for (const WeightedValue& one : values)
        sum += one.weight;
    std::sort(values.begin(), values.end(),
              [](const WeightedValue& a, const WeightedValue& b) { return a.value < b.value; });
    double below = 0;
    for (const WeightedValue& one : values) {
        below += one.weight;
        if (below >= share * sum)
            return one.value;
    }
    return values.empty() ? 0 : values.back().value;
}

/// Three corners in one pose.
struct PosedCorners {
    glm::dvec3 a, b, c;

    PosedCorners(const std::vector<glm::vec3>& points, const Triangle& t)
        : a(points[t.x]), b(points[t.y]), c(points[t.z]) {}
    glm::dvec3 at(double u, double v) const { return (1 - u - v) * a + u * b + v * c; }
    double area() const { return 0.5 * glm::length(glm::cross(b - a, c - a)); }
    double longest() const {
        return std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    }
};

}  // namespace

PoseError pose_error(const PoseErrorSamples& error_samples, const FollowedLevel& what) {
    constexpr double kFar = std::numeric_limits<double>::max();
    const std::vector<glm::vec3>& points = what.pose.points;
    const std::vector<glm::vec3>& positions = what.level.positions;
    PoseError out;
    std::vector<WeightedValue> distances;
    std::vector<WeightedValue> growths;
    // The sample stands for more of the surface, by the factor that its triangle has grown.
    const auto add = [&](const PoseErrorSample& witness, const PosedCorners& source,
                         double distance) {
        if (!std::isfinite(distance))
            distance = kFar;
        const double grown = witness.facet > 0 ? source.area() / witness.facet : 1;
        distances.push_back({distance, std::isfinite(grown) ? witness.area * grown : witness.area});
        out.max = std::max(out.max, distance);
    };
    const auto point_of = [](uint32_t point) { return point; };
    const auto place_of = [&](uint32_t vertex) { return what.places[vertex]; };
    for (const PoseErrorSample& witness : error_samples.of_source) {
        const PosedCorners source(points, witness.source);
        geometry::NearestWalk nearest(positions, what.level.triangles,
                                      source.at(witness.source_u, witness.source_v));
        nearest.visit(witness.level);
        nearest.walk(what.level_rings, place_of, kSearchSteps);
        add(witness, source, std::sqrt(nearest.square()));
        if (witness.longest > 0) {
            const double growth = source.longest() / witness.longest;
            growths.push_back({std::isfinite(growth) ? growth : 1, witness.area});
        }
    }
    out.error = quantile(distances, kErrorShare);
    distances.clear();
    for (const PoseErrorSample& witness : error_samples.of_level) {
        const PosedCorners source(points, witness.source);
        const PosedCorners level(positions, what.level.triangles[witness.level]);
        geometry::NearestWalk nearest(points, what.pose.triangles,
                                      level.at(witness.level_u, witness.level_v));
        nearest.start(what.pose_rings, point_of, witness.source);
        nearest.walk(what.pose_rings, point_of, kSearchSteps);
        add(witness, source, std::sqrt(nearest.square()));
    }
    out.error = std::max(out.error, quantile(distances, kErrorShare));
    out.growth = quantile(growths, kGrowthShare);
    return out;
}

}  // namespace lodestone::deform
