// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/surface_fit.h"

#include "simplify/fit/edge_flips.h"
#include "simplify/fit/fit_samples.h"
#include "simplify/fit/vertex_insertion.h"

#include <algorithm>
#include <cmath>

namespace lodestone::simplify {
namespace {

// The fewest samples of a fit.
// Taste: fewer do not hold the shape of coarse levels.
constexpr size_t kFewSamples = 1000;
/// The samples on a triangle from which on flips are worth their time.
/// Fitted: by tests/bench/peers/bench_simplify.py, nine shared models at 50 % (3 instead of 6).
constexpr size_t kSamplesToFlip = 3;
/// The sweeps are this number times the square root of the original's triangles for each vertex.
/// Fitted: by tests/bench/peers/bench_simplify.py, error and CPU of nine shared models.
constexpr double kSweeps = 0.7;
/// Parts with no more triangles than this, and with at least this closed_share(), are not moved.
/// Fitted: by pictures of samples/street, where a garden wall consists of such bricks.
constexpr uint32_t kFewTriangles = 8;
// Law: a closed part has 1; the rest is rounding.
constexpr float kClosed = 0.99f;

/// The closed share of each part: 1 closed, 0 a flat sheet, which has no inside. The area vectors
/// of a closed part add up to zero.
std::vector<float> closed_share(const CollapseMesh& mesh) {
    std::vector<glm::vec3> sums(mesh.part_count, glm::vec3(0.0f));
    std::vector<float> areas(mesh.part_count, 0);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const uint32_t part = mesh.parts[mesh.triangles[t].x];
        sums[part] += mesh.facets[t];
        areas[part] += glm::length(mesh.facets[t]);
    }
    for (size_t part = 0; part < areas.size(); ++part)
        areas[part] = areas[part] > 0 ? 1 - glm::length(sums[part]) / areas[part] : 0;
    return areas;
}

/// The parts that enclose a volume with so few triangles that these cannot be near all of it: least
/// squares would turn a board's slab into a tetrahedron, which is nearer in the mean and looks
/// wrong.
std::vector<bool> too_few(const CollapseMesh& mesh, const std::vector<float>& closed) {
    std::vector<uint32_t> triangles(mesh.part_count, 0);
    for (const glm::uvec3& triangle : mesh.triangles)
        ++triangles[mesh.parts[triangle.x]];
    std::vector<bool> few(mesh.part_count);
    for (size_t part = 0; part < few.size(); ++part)
        few[part] = triangles[part] <= kFewTriangles && closed[part] > kClosed;
    return few;
}

/// Reweights samples: those that miss by more than the mean of their kind (surface, outline) count
/// in proportion to the distance, not to its square. So a surface that fits already is not moved
/// for the sake of one that cannot fit. source: Huber 1964 (robust estimation).
void weigh_by_distance(FitSamples& samples) {
    const auto outline = std::find_if(samples.begin(), samples.end(), [](const FitSample& s) {
        return s.source == kNone;  // outline samples come last
    });
    const auto weigh = [](std::span<FitSample> kind) {
        double misses = 0;
        double areas = 0;
        for (const FitSample& s : kind) {
            misses += double{s.area} * std::abs(s.miss);
            areas += s.area;
        }
        const float mean = areas > 0 ? static_cast<float>(misses / areas) : 0;
        for (FitSample& s : kind) {
            if (std::abs(s.miss) > mean)
                s.area *= mean / std::abs(s.miss);
        }
    };
    weigh({samples.begin(), outline});
    weigh({outline, samples.end()});
}

/// Gives samples that the mesh lies outside of more weight: silhouettes show what lies outside of
/// the original, and not what lies inside.
void weigh_outside(FitSamples& samples, const CollapseMesh& mesh, const std::vector<float>& closed,
                   float more) {
    for (FitSample& s : samples) {
        if (s.source != kNone && s.miss < 0)
            s.area *= 1 + more * closed[mesh.parts[mesh.triangles[s.triangle].x]];
    }
}

/// Moves the vertices, as far as no triangle turns over.
void move(FitPlaces& places, const Adjacency& adjacency, const std::vector<glm::vec3>& moves,
          const std::vector<bool>& still) {
    CollapseMesh& mesh = places.mesh();
    std::vector<glm::vec3>& points = places.points();
    for (uint32_t v = 0; v < points.size(); ++v) {
        glm::vec3 move = moves[v];
        if (still[mesh.parts[v]] || !std::isfinite(move.x + move.y + move.z) ||
            glm::dot(move, move) == 0)
            continue;
        const std::span<const uint32_t> ring = adjacency.around(v);
        if (mesh.on_border(ring))
            continue;
        const glm::dvec3 before = mesh.points[v];
        for (int attempt = 0; attempt < 3; ++attempt, move *= 0.5f) {
            mesh.points[v] = before + glm::dvec3(move);
            bool fits = true;
            for (const uint32_t t : ring) {
                const glm::dvec3 facet = mesh.facet_of(mesh.triangles[t]);
                const glm::dvec3 old(mesh.facets[t]);
                const double dot = glm::dot(facet, old);
                // A triangle turns by 45 degrees at most, and keeps a quarter of its area.
                if (!(dot > 0 && 2 * dot * dot >= glm::dot(facet, facet) * glm::dot(old, old) &&
                      dot >= 0.25 * glm::dot(old, old))) {
                    fits = false;
                    break;
                }
            }
            if (fits)
                break;
            mesh.points[v] = before;
        }
        for (const uint32_t t : ring)
            mesh.facets[t] = glm::vec3(mesh.facet_of(mesh.triangles[t]));
        points[v] = glm::vec3(mesh.points[v]);
    }
}

}  // namespace

void fit_surface(CollapseMesh& mesh, const Mesh& source, Adjacency& adjacency,
                 const FitOptions& options, const Job& job) {
    if (mesh.live == 0 || mesh.ids.empty() || !mesh.others.empty())
        return;
    FitPlaces places(mesh, source);
    const double want = std::min(options.samples * static_cast<double>(mesh.points.size()),
                                 options.share * static_cast<double>(source.triangles.size()));
    const double coarse =
        static_cast<double>(source.triangles.size()) / static_cast<double>(mesh.points.size());
    const int sweeps = std::clamp(static_cast<int>(std::lround(kSweeps * std::sqrt(coarse))),
                                  options.least_sweeps, options.most_sweeps);
    const std::vector<float> closed = closed_share(mesh);
    const std::vector<bool> still = too_few(mesh, closed);
    FitSamples samples;
    std::vector<glm::vec3> moves;
    std::vector<uint32_t> nearest;  // the triangles nearest to the samples
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        const size_t more = 2 * mesh.outline.size() + (options.careful ? mesh.points.size() : 0);
        sample_surface(places, adjacency, std::max(static_cast<size_t>(want), kFewSamples), more,
                       job, samples, &nearest);
        const bool dense = samples.size() >= kSamplesToFlip * mesh.triangles.size();
        // The last sweep only moves vertices, so that flipped triangles are fitted, too.
        if (options.careful && dense && sweep + 1 < sweeps &&
            flip_edges(places, adjacency, job, samples) > 0)
            adjacency.build(mesh);
        if (options.careful)
            sample_vertices(places, adjacency, samples);
        sample_outline(places, adjacency, job, samples);
        if (options.careful)
            weigh_by_distance(samples);
        if (options.outside > 0)
            weigh_outside(samples, mesh, closed, options.outside);
        solve_fit(mesh, samples, options.iterations, options.hold, moves);
        move(places, adjacency, moves, still);
    }
    // Nothing moves after this, so the largest misses become smaller.
    insert_vertices(places, adjacency, samples, options.insert, job);
}

}  // namespace lodestone::simplify
