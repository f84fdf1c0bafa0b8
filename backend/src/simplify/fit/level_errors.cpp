// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/level_errors.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>

namespace lodestone::simplify {
namespace {

// The most points of the original that distances are measured from.
// Taste: more tell smaller errors apart, in more time.
constexpr size_t kMostPoints = 10000;
// The fewest points of a measurement.
// Taste: more tell the errors of small meshes better.
constexpr size_t kFewPoints = 2000;
/// The points for each vertex of a level.
/// Taste: more tell better which vertices are worse than they were.
constexpr size_t kPointsEach = 4;
/// The share of the original's triangles that is enough to measure from.
/// Taste: a larger share takes more time beside the collapse.
constexpr size_t kTrianglesEach = 8;
/// Everything is measured at half its size, so that the cube of +-1 lies in the unit sphere.
/// Law: what ClosestTree asks for.
constexpr float kHalf = 0.5f;
// Farther than any two points of the unit sphere.
// Law: its diameter is 2.
constexpr double kEverywhere = 4;
/// A corner is searched for only until it is known to be nearer than this part of the worst.
/// Law: below 1, so that every distance above the worst so far is found.
constexpr double kEnough = 0.9;

std::vector<glm::vec3> halved(const CollapseMesh& mesh, const Mesh& source) {
    std::vector<glm::vec3> out;
    out.reserve(source.positions.size());
    for (const glm::vec3& position : source.positions)
        out.emplace_back((glm::dvec3(position) - mesh.center) * (double{kHalf} / mesh.scale));
    return out;
}

/// A place of a mesh and how far it is from the other one.
struct MeasuredPlace {
    uint32_t triangle = kNone;  // of the level
    glm::vec3 weights{0.0f};
    double distance = 0;
};

void share(const MeasuredPlace& place, std::span<const Triangle> triangles, double each,
           LevelErrors& out) {
    const double distance = place.distance;
    out.all.mean += each * distance;
    out.all.square += each * distance * distance;
    out.all.worst = std::max(out.all.worst, distance);
    if (place.triangle == kNone)
        return;
    for (int k = 0; k < 3; ++k) {
        LevelError& of = out.vertices[triangles[place.triangle][k]];
        const double part = each * static_cast<double>(place.weights[k]);
        of.mean += part * distance;
        of.square += part * distance * distance;
        of.worst = std::max(of.worst, distance);
    }
}

/// Nearest points of a mesh, one after the other: where one was, the next is looked for first.
class NearestInTurn {
public:
    NearestInTurn(std::span<const glm::vec3> positions, std::span<const Triangle> triangles,
                  const ray::ClosestTree& tree)
        : positions_(positions), triangles_(triangles), tree_(tree) {}

    /// The nearest place; any place within `enough` will do.
    const ray::ClosestSearch& find(const glm::vec3& point, double enough = 0) {
        const uint32_t perhaps = search_.triangle;
        search_ = {positions_, triangles_, glm::dvec3(point)};
        if (perhaps != ray::kNoTriangle)
            search_.visit(perhaps);
        if (!(search_.square <= enough * enough))
            tree_.search(search_, std::min(kEverywhere, std::sqrt(search_.square)), enough);
        return search_;
    }

private:
    std::span<const glm::vec3> positions_;
    std::span<const Triangle> triangles_;
    const ray::ClosestTree& tree_;
    ray::ClosestSearch search_{};
};

}  // namespace

LevelMeter::LevelMeter(const Mesh& source, const CollapseMesh& opened)
    : source_(source),
      positions_(halved(opened, source)),
      area_(positions_, source.triangles),
      tree_(positions_, source.triangles, false),
      views_(positions_, source.triangles) {}

size_t LevelMeter::samples_for(const CollapseMesh& mesh) const {
    const size_t most =
        std::clamp(source_.triangles.size() / kTrianglesEach, kFewPoints, kMostPoints);
    return std::clamp(kPointsEach * mesh.points.size(), kFewPoints, most);
}

LevelErrors LevelMeter::measure(const FitPlaces& places, size_t samples, const Job& job) const {
    const CollapseMesh& mesh = places.mesh();
    LevelErrors out;
    out.vertices.resize(mesh.points.size());
    std::vector<glm::vec3> positions;
    positions.reserve(mesh.points.size());
    for (const glm::dvec3& point : mesh.points)
        positions.emplace_back(point * double{kHalf});
    const AreaPoints area(positions, mesh.triangles);
    if (area.empty() || area_.empty())
        return out;
    const ray::ClosestTree tree(positions, mesh.triangles, false);
    const auto in_blocks = [&](size_t count, const auto& body) {
        parallel_for((count + kBlock - 1) / kBlock, [&](size_t block) {
            job.check();
            NearestInTurn level(positions, mesh.triangles, tree);
            NearestInTurn source(positions_, source_.triangles, tree_);
            for (size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i)
                body(i, level, source);
        });
    };
    std::vector<MeasuredPlace> found(2 * samples);
    in_blocks(samples, [&](size_t n, NearestInTurn& level, NearestInTurn& source) {
        const ray::ClosestSearch& there = level.find(area_.at(n, samples).place);
        const auto u = static_cast<float>(there.where.u);
        const auto v = static_cast<float>(there.where.v);
        found[n] = {there.triangle, glm::vec3(1 - u - v, u, v), std::sqrt(there.square)};
        const AreaPoints::AreaPoint own = area.at(n, samples);
        found[samples + n] = {own.triangle, own.weights, std::sqrt(source.find(own.place).square)};
    });
    const double each = 0.5 / static_cast<double>(samples);
    for (const MeasuredPlace& place : found)
        share(place, mesh.triangles, each, out);
    // The largest distances are at corners of both, as many of the original as there are samples.
    const double enough = kEnough * out.all.worst;
    const size_t step = 1 + source_.triangles.size() / samples;
    const size_t corners = source_.triangles.size() / step;
    const size_t own_step = 1 + mesh.triangles.size() / samples;
    found.assign(corners + mesh.triangles.size() / own_step, {});
    in_blocks(found.size(), [&](size_t i, NearestInTurn& level, NearestInTurn& source) {
        if (i < corners) {
            const glm::vec3& place =
                positions_[source_.triangles[i * step][static_cast<int>(i % 3)]];
            if (!std::isfinite(place.x + place.y + place.z))
                return;
            const ray::ClosestSearch& there = level.find(place, enough);
            found[i] = {there.triangle, glm::vec3(0.0f), std::sqrt(there.square)};
        } else {
            const auto t = static_cast<uint32_t>((i - corners) * own_step);
            const glm::vec3& place = positions[mesh.triangles[t][static_cast<int>(i % 3)]];
            found[i] = {t, glm::vec3(0.0f), std::sqrt(source.find(place, enough).square)};
        }
    });
    for (const MeasuredPlace& place : found)
        share(place, mesh.triangles, 0, out);
    for (const OutlineViews::OddPixel& pixel : views_.odd_pixels(positions, mesh.triangles)) {
        out.all.outline += 1;
        for (int k = 0; k < 3; ++k) {
            const uint32_t vertex = pixel.triangle != kNone
                                        ? mesh.triangles[pixel.triangle][k]
                                        : places.place(source_.triangles[pixel.source][k]);
            if (vertex != kNone)
                out.vertices[vertex].outline += 1.0 / 3;
        }
    }
    return out;
}

}  // namespace lodestone::simplify
