// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/better_fit.h"

#include <algorithm>

namespace lodestone::simplify {
namespace {

// The most times that vertices are moved back.
// Taste: more keep more of some fits, in more time.
constexpr int kMoveBacks = 3;
/// Vertices of a level that is better as a whole are moved back for this part of its mean error.
/// Taste: a larger part takes less time and leaves more that was better.
constexpr double kWorth = 0.02;

/// The vertex of one level for each vertex of a later one; kNone for those that were inserted.
std::vector<uint32_t> earlier_vertices(const CollapseMesh& before, const CollapseMesh& after) {
    std::vector<uint32_t> vertex_of(after.merged.size(), kNone);  // by first number
    for (uint32_t v = 0; v < before.ids.size(); ++v)
        vertex_of[before.ids[v]] = v;
    std::vector<uint32_t> out(after.ids.size());
    for (size_t v = 0; v < out.size(); ++v)
        out[v] = vertex_of[after.ids[v]];
    return out;
}

void set_points(CollapseMesh& mesh, std::vector<glm::dvec3>&& points) {
    mesh.points = std::move(points);
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        mesh.facets[t] = glm::vec3(mesh.facet_of(mesh.triangles[t]));
}

/// A level before and after its fit, with the errors of both.
struct FitComparison {
    const CollapseMesh& before;
    const LevelErrors was;
    const std::vector<uint32_t> earlier;  // earlier_vertices()

    /// Marks the vertices that made an error of the whole larger, the worst first, until it is not.
    void mark_until_within(const LevelErrors& is, double LevelError::*error,
                           std::vector<uint8_t>& back) const {
        double excess = is.all.*error - was.all.*error;
        if (!(excess > 0))
            return;
        std::vector<std::pair<double, uint32_t>> grown;
        for (uint32_t v = 0; v < back.size(); ++v) {
            if (earlier[v] == kNone)
                continue;
            const double more = is.vertices[v].*error - was.vertices[earlier[v]].*error;
            if (back[v])
                excess -= more;
            else if (more > 0)
                grown.emplace_back(-more, v);
        }
        std::sort(grown.begin(), grown.end());
        for (size_t i = 0; i < grown.size() && excess >= 0; ++i) {
            back[grown[i].second] = 1;
            excess += grown[i].first;
        }
    }

    std::vector<uint8_t> worse_vertices(const LevelErrors& is) const {
        std::vector<uint8_t> back(earlier.size(), 0);
        for (size_t v = 0; v < back.size(); ++v) {
            if (earlier[v] == kNone)
                continue;
            const LevelError& old = was.vertices[earlier[v]];
            const LevelError& now = is.vertices[v];
            back[v] = (now.mean > old.mean && now.square > old.square) || now.worst > was.all.worst;
        }
        for (double LevelError::*error :
             {&LevelError::mean, &LevelError::square, &LevelError::outline})
            mark_until_within(is, error, back);
        return back;
    }

    /// The mean becomes smaller by this much when the marked vertices have what they had.
    double gain(const LevelErrors& is, const std::vector<uint8_t>& back) const {
        double sum = 0;
        for (size_t v = 0; v < back.size(); ++v)
            sum += back[v] ? is.vertices[v].mean - was.vertices[earlier[v]].mean : 0;
        return sum;
    }

    /// Moves the marked vertices back, but for those that would turn a triangle over; returns
    /// whether any moved.
    bool move_back(std::vector<uint8_t> back, CollapseMesh& mesh) const {
        std::vector<glm::dvec3> points = mesh.points;
        for (size_t v = 0; v < points.size(); ++v) {
            back[v] = back[v] && points[v] != before.points[earlier[v]];
            if (back[v])
                points[v] = before.points[earlier[v]];
        }
        for (bool again = true; again;) {
            again = false;
            for (size_t t = 0; t < mesh.triangles.size(); ++t) {
                const Triangle& c = mesh.triangles[t];
                if (!back[c.x] && !back[c.y] && !back[c.z])
                    continue;
                const glm::dvec3 old(mesh.facets[t]);
                if (glm::dot(CollapseMesh::facet_of(points, c), old) > 0)
                    continue;
                for (int k = 0; k < 3; ++k) {
                    back[c[k]] = 0;
                    points[c[k]] = mesh.points[c[k]];
                }
                again = true;
            }
        }
        if (std::find(back.begin(), back.end(), uint8_t{1}) == back.end())
            return false;
        set_points(mesh, std::move(points));
        return true;
    }
};

}  // namespace

bool keep_better(CollapseMesh& before, CollapseMesh& after, const Mesh& source,
                 const LevelMeter& meter, const Job& job) {
    const size_t samples = meter.samples_for(before);
    const auto errors_of = [&](CollapseMesh& mesh) {
        return meter.measure(FitPlaces(mesh, source), samples, job);
    };
    const FitComparison both{before, errors_of(before), earlier_vertices(before, after)};
    std::optional<LevelError> kept;
    std::vector<glm::dvec3> points;  // of what is kept
    for (int round = 0; round <= kMoveBacks; ++round) {
        const LevelErrors errors = errors_of(after);
        if (errors.all.within(both.was.all) && (!kept || errors.all.mean < kept->mean)) {
            kept = errors.all;
            points = after.points;
        }
        const std::vector<uint8_t> back = both.worse_vertices(errors);
        if ((kept && (round > 0 || both.gain(errors, back) < kWorth * errors.all.mean)) ||
            round == kMoveBacks || !both.move_back(back, after))
            break;
    }
    if (!kept)
        return false;
    set_points(after, std::move(points));
    return true;
}

}  // namespace lodestone::simplify
