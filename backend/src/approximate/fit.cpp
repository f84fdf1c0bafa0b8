// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/fit.h"

#include "approximate/quadric.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::approximate {
namespace {

/// Of a step of block Jacobi: with three unknown vertices a row it converges below 2/3.
constexpr float kDamping = 0.65f;
/// Holds a vertex where it is, relative to the area of the samples near it.
constexpr float kHold = 0.1f;
/// Of outlines, relative to the surface: an edge counts as so many squares on it.
constexpr float kBorder = 2;
constexpr size_t kMostAround = 32;
constexpr size_t kFewSamples = 1000;
constexpr int kMostSteps = 4;

/// A sample misses the place it is nearest to by `miss` along `toward`.
struct Sample {
    uint32_t triangle;
    float weights[3];  // of its corners
    glm::vec3 toward;
    float miss;
    float area;
};

struct Nearest {
    float square = 1e30f;
    uint32_t triangle = kNone;
    glm::vec3 weights{0.0f};
};

/// Barycentric coordinates of the point of triangle abc nearest to the origin (Ericson, Real-Time
/// Collision Detection, 5.1.5).
glm::vec3 nearest_weights(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 ab = b - a;
    const glm::vec3 ac = c - a;
    const float d1 = -glm::dot(ab, a);
    const float d2 = -glm::dot(ac, a);
    if (d1 <= 0 && d2 <= 0)
        return {1, 0, 0};
    const float d3 = -glm::dot(ab, b);
    const float d4 = -glm::dot(ac, b);
    if (d3 >= 0 && d4 <= d3)
        return {0, 1, 0};
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const float t = d1 / (d1 - d3);
        return {1 - t, t, 0};
    }
    const float d5 = -glm::dot(ab, c);
    const float d6 = -glm::dot(ac, c);
    if (d6 >= 0 && d5 <= d6)
        return {0, 0, 1};
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const float t = d2 / (d2 - d6);
        return {1 - t, 0, t};
    }
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const float t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - t, t};
    }
    const float sum = va + vb + vc;
    return {va / sum, vb / sum, vc / sum};
}

class Fit {
public:
    Fit(CollapseMesh& mesh, const Mesh& source, const Adjacency& adjacency)
        : mesh_(mesh), source_(source), adjacency_(adjacency) {
        place_of_.assign(mesh.merged.size(), kNone);
        for (uint32_t v = 0; v < mesh.ids.size(); ++v)
            place_of_[mesh.ids[v]] = v;
        points_.reserve(mesh.points.size());
        for (const glm::dvec3& point : mesh.points)
            points_.emplace_back(point);
    }

    void sample(size_t want, const Job& job);
    void sample_outline(const Job& job);
    void solve(int iterations);
    void move();

private:
    glm::vec3 original(uint32_t vertex) const {
        return glm::vec3((glm::dvec3(source_.positions[vertex]) - mesh_.center) / mesh_.scale);
    }
    uint32_t place(uint32_t vertex) {
        std::vector<uint32_t>& merged = mesh_.merged;
        uint32_t root = vertex;
        while (merged[root] != root) {
            merged[root] = merged[merged[root]];
            root = merged[root];
        }
        return place_of_[root];
    }
    void take(const glm::vec3& point, uint32_t from, const glm::vec3& normal, float area);

    /// The edge from a triangle's corner to the next one lies on a border.
    struct Border {
        uint32_t triangle;
        int corner;
        uint32_t next;  // of the same vertex
    };
    void find_borders();
    void take_border(const glm::vec3& point, uint32_t from, const glm::vec3& edge, float weight);

    CollapseMesh& mesh_;
    const Mesh& source_;
    const Adjacency& adjacency_;
    std::vector<uint32_t> place_of_;
    std::vector<glm::vec3> points_;
    std::vector<Sample> samples_;
    std::vector<glm::vec3> moves_;
    std::vector<uint32_t> heads_;  // of each vertex the first of its borders
    std::vector<Border> borders_;
};

void Fit::take(const glm::vec3& point, uint32_t from, const glm::vec3& normal, float area) {
    if (from == kNone)
        return;
    Nearest best;
    uint32_t at = from;
    bool found = false;
    for (int step = 0; step < kMostSteps && !found; ++step) {
        const std::span<const uint32_t> whole = adjacency_.around(at);
        const std::span<const uint32_t> ring = whole.first(std::min(whole.size(), kMostAround));
        // Mostly it lies above one of them.
        for (const uint32_t t : ring) {
            const Triangle& c = mesh_.triangles[t];
            const glm::vec3& facet = mesh_.facets[t];
            const glm::vec3 a = points_[c.x] - point;
            const glm::vec3 b = points_[c.y] - point;
            const glm::vec3 d = points_[c.z] - point;
            const float x = glm::dot(facet, glm::cross(b, d));
            const float y = glm::dot(facet, glm::cross(d, a));
            const float z = glm::dot(facet, glm::cross(a, b));
            const float sum = x + y + z;
            if (!(x >= 0 && y >= 0 && z >= 0 && sum > 0))
                continue;
            const float agree = glm::dot(facet, normal);
            if (!(agree > 0 && agree * agree > 0.25f * glm::dot(facet, facet)))
                continue;
            const float scale = 1 / sum;
            best = {0, t, glm::vec3(x * scale, y * scale, z * scale)};
            found = true;
            break;
        }
        if (found)
            break;
        for (const uint32_t t : ring) {
            const Triangle& c = mesh_.triangles[t];
            const glm::vec3 a = points_[c.x] - point;
            const glm::vec3 b = points_[c.y] - point;
            const glm::vec3 d = points_[c.z] - point;
            const glm::vec3 weights = nearest_weights(a, b, d);
            const glm::vec3 off = weights.x * a + weights.y * b + weights.z * d;
            const float square = glm::dot(off, off);
            if (square < best.square)
                best = {square, t, weights};
        }
        if (best.triangle == kNone)
            return;
        const Triangle& c = mesh_.triangles[best.triangle];
        // Where the nearest point lies on the far side, what is beyond may be nearer.
        const int corner = best.weights.x >= best.weights.y
                               ? (best.weights.x >= best.weights.z ? 0 : 2)
                               : (best.weights.y >= best.weights.z ? 1 : 2);
        const bool within = best.weights.x > 0 && best.weights.y > 0 && best.weights.z > 0;
        if (within || c[corner] == at)
            break;
        at = c[corner];
    }
    const Triangle& c = mesh_.triangles[best.triangle];
    glm::vec3 toward = point - (best.weights.x * points_[c.x] + best.weights.y * points_[c.y] +
                                best.weights.z * points_[c.z]);
    const bool inside = best.weights.x > 0 && best.weights.y > 0 && best.weights.z > 0;
    const glm::vec3 facet(mesh_.facets[best.triangle]);
    const float length = glm::length(facet);
    if (!(length > 0) || glm::dot(facet, normal) < 0.3f * length)
        return;
    const glm::vec3 direction = inside ? facet / length : normal;
    const float miss = glm::dot(direction, toward);
    toward = direction;
    if (!std::isfinite(miss + toward.x + toward.y + toward.z))
        return;
    samples_.push_back(
        {best.triangle, {best.weights.x, best.weights.y, best.weights.z}, toward, miss, area});
}

void Fit::sample(size_t want, const Job& job) {
    const size_t count = source_.triangles.size();
    // Vertices and middles in turn, as many as wanted, spread evenly.
    const double step = std::max(1.0, static_cast<double>(count) / static_cast<double>(want));
    samples_.clear();
    samples_.reserve(static_cast<size_t>(static_cast<double>(count) / step) + 1);
    for (size_t n = 0;; ++n) {
        const auto at = static_cast<size_t>(step * static_cast<double>(n));
        if (at >= count)
            break;
        if ((n & 0xffffu) == 0)
            job.check();
        const Triangle& t = source_.triangles[at];
        const glm::vec3 a = original(t.x);
        const glm::vec3 b = original(t.y);
        const glm::vec3 c = original(t.z);
        const uint32_t from = place(t.x);
        if (from == kNone)
            continue;
        const glm::vec3 facet = glm::cross(b - a, c - a);
        const float area = glm::length(facet);
        if (!(area > 0))
            continue;
        take((a + b + c) * (1.0f / 3), from, facet / area, 0.75f * area);
        const auto corner = static_cast<int>(n % 3);
        take(corner == 0 ? a : (corner == 1 ? b : c), place(t[corner]), facet / area, 0.25f * area);
    }
}

void Fit::find_borders() {
    std::vector<uint8_t> outer(points_.size(), 0);
    for (const auto& [a, b] : mesh_.outline) {
        for (const uint32_t end : {place(a), place(b)}) {
            if (end != kNone)
                outer[end] = 1;
        }
    }
    heads_.assign(points_.size(), kNone);
    for (uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
        const Triangle& c = mesh_.triangles[t];
        for (int i = 0; i < 3; ++i) {
            const uint32_t u = c[i];
            const uint32_t w = c[(i + 1) % 3];
            if (!outer[u] || !outer[w])
                continue;
            const uint32_t hub = adjacency_.valence(u) <= adjacency_.valence(w) ? u : w;
            const uint32_t end = hub == u ? w : u;
            int uses = 0;
            for (const uint32_t near : adjacency_.around(hub)) {
                const Triangle& n = mesh_.triangles[near];
                uses += n.x == end || n.y == end || n.z == end;
            }
            if (uses != 1)
                continue;
            for (const uint32_t v : {u, w}) {
                borders_.push_back({t, i, heads_[v]});
                heads_[v] = static_cast<uint32_t>(borders_.size() - 1);
            }
        }
    }
}

void Fit::take_border(const glm::vec3& point, uint32_t from, const glm::vec3& edge, float weight) {
    float least = 1e30f;
    const Border* best = nullptr;
    float best_along = 0;
    uint32_t at = from;
    for (int step = 0; step < kMostSteps; ++step) {
        int looked = 0;
        for (uint32_t i = heads_[at]; i != kNone && looked < 8; i = borders_[i].next, ++looked) {
            const Border& border = borders_[i];
            const Triangle& c = mesh_.triangles[border.triangle];
            const glm::vec3& start = points_[c[border.corner]];
            const glm::vec3 run = points_[c[(border.corner + 1) % 3]] - start;
            const float along =
                std::min(std::max(glm::dot(point - start, run) / glm::dot(run, run), 0.0f), 1.0f);
            const glm::vec3 off = start + along * run - point;
            const float square = glm::dot(off, off);
            if (square < least) {
                least = square;
                best = &border;
                best_along = along;
            }
        }
        if (best == nullptr)
            return;
        const Triangle& c = mesh_.triangles[best->triangle];
        const uint32_t nearer = c[(best->corner + (best_along > 0.5f ? 1 : 0)) % 3];
        if (nearer == at || (best_along > 0 && best_along < 1))
            break;
        at = nearer;
    }
    const Triangle& c = mesh_.triangles[best->triangle];
    const int next = (best->corner + 1) % 3;
    const glm::vec3& start = points_[c[best->corner]];
    const glm::vec3 run = points_[c[next]] - start;
    glm::vec3 toward = glm::cross(run, mesh_.facets[best->triangle]);
    const float length = glm::length(toward);
    const float agree = glm::dot(run, edge);
    if (!(length > 0) || !(agree * agree > 0.25f * glm::dot(run, run) * glm::dot(edge, edge)))
        return;
    toward /= length;
    Sample sample{best->triangle, {0, 0, 0}, toward, 0, weight};
    sample.weights[best->corner] = 1 - best_along;
    sample.weights[next] = best_along;
    sample.miss = glm::dot(toward, point - (start + best_along * run));
    if (std::isfinite(sample.miss + toward.x + toward.y + toward.z))
        samples_.push_back(sample);
}

void Fit::sample_outline(const Job& job) {
    if (mesh_.outline.empty())
        return;
    borders_.clear();
    find_borders();
    job.check();
    for (const auto& [first, second] : mesh_.outline) {
        const glm::vec3 a = original(mesh_.sources[first]);
        const glm::vec3 b = original(mesh_.sources[second]);
        const glm::vec3 edge = b - a;
        const float weight = kBorder * glm::dot(edge, edge);
        const uint32_t from = place(first);
        if (from == kNone || !(weight > 0))
            continue;
        take_border(0.5f * (a + b), from, edge, weight);
        take_border(a, from, edge, 0.5f * weight);
    }
}

void Fit::solve(int iterations) {
    struct Matrix {
        float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
        float mass = 0, most = 0;
    };
    const size_t count = points_.size();
    std::vector<Matrix> matrices(count);
    for (const Sample& s : samples_) {
        const Triangle& c = mesh_.triangles[s.triangle];
        for (int i = 0; i < 3; ++i) {
            const float w = s.area * s.weights[i] * s.weights[i];
            Matrix& m = matrices[c[i]];
            m.xx += w * s.toward.x * s.toward.x;
            m.xy += w * s.toward.x * s.toward.y;
            m.xz += w * s.toward.x * s.toward.z;
            m.yy += w * s.toward.y * s.toward.y;
            m.yz += w * s.toward.y * s.toward.z;
            m.zz += w * s.toward.z * s.toward.z;
            m.mass += s.area * s.weights[i];
            if (s.weights[i] > 0.1f)
                m.most = std::max(m.most, std::abs(s.miss));
        }
    }
    for (Matrix& m : matrices) {
        const float trace = m.xx + m.yy + m.zz;
        if (!(trace > 1e-30f)) {
            m = {};
            continue;
        }
        const float hold = kHold * m.mass;
        m.xx += hold;
        m.yy += hold;
        m.zz += hold;
        const float cxx = m.yy * m.zz - m.yz * m.yz;
        const float cxy = m.xz * m.yz - m.xy * m.zz;
        const float cxz = m.xy * m.yz - m.xz * m.yy;
        const float det = m.xx * cxx + m.xy * cxy + m.xz * cxz;
        const float f = kDamping / det;
        const Matrix inverse{f * cxx,
                             f * cxy,
                             f * cxz,
                             f * (m.xx * m.zz - m.xz * m.xz),
                             f * (m.xy * m.xz - m.xx * m.yz),
                             f * (m.xx * m.yy - m.xy * m.xy),
                             m.mass,
                             m.most};
        m = std::isfinite(f) ? inverse : Matrix{};
    }
    moves_.assign(count, glm::vec3(0.0f));
    std::vector<glm::vec3> pulls(count);
    for (int iteration = 0; iteration < iterations; ++iteration) {
        std::fill(pulls.begin(), pulls.end(), glm::vec3(0.0f));
        for (const Sample& s : samples_) {
            const Triangle& c = mesh_.triangles[s.triangle];
            const glm::vec3 moved = s.weights[0] * moves_[c.x] + s.weights[1] * moves_[c.y] +
                                    s.weights[2] * moves_[c.z];
            const glm::vec3 pull = (s.area * (s.miss - glm::dot(moved, s.toward))) * s.toward;
            for (int i = 0; i < 3; ++i)
                pulls[c[i]] += s.weights[i] * pull;
        }
        for (size_t v = 0; v < count; ++v) {
            const Matrix& m = matrices[v];
            const glm::vec3& p = pulls[v];
            moves_[v] += glm::vec3(m.xx * p.x + m.xy * p.y + m.xz * p.z,
                                   m.xy * p.x + m.yy * p.y + m.yz * p.z,
                                   m.xz * p.x + m.yz * p.y + m.zz * p.z);
        }
    }
    for (size_t v = 0; v < count; ++v) {
        const float square = glm::dot(moves_[v], moves_[v]);
        const float most = matrices[v].most;
        if (square > most * most)
            moves_[v] *= most / std::sqrt(square);
    }
}

void Fit::move() {
    for (uint32_t v = 0; v < points_.size(); ++v) {
        glm::vec3 move = moves_[v];
        if (!std::isfinite(move.x + move.y + move.z) || glm::dot(move, move) == 0)
            continue;
        const std::span<const uint32_t> ring = adjacency_.around(v);
        const glm::dvec3 before = mesh_.points[v];
        for (int attempt = 0; attempt < 3; ++attempt, move *= 0.5f) {
            mesh_.points[v] = before + glm::dvec3(move);
            bool fits = true;
            for (const uint32_t t : ring) {
                const glm::dvec3 facet = mesh_.facet_of(mesh_.triangles[t]);
                const glm::dvec3 old(mesh_.facets[t]);
                const double dot = glm::dot(facet, old);
                // Not by more than 45 degrees, nor below a quarter of the area.
                if (!(dot > 0 && 2 * dot * dot >= glm::dot(facet, facet) * glm::dot(old, old) &&
                      dot >= 0.25 * glm::dot(old, old))) {
                    fits = false;
                    break;
                }
            }
            if (fits)
                break;
            mesh_.points[v] = before;
        }
        for (const uint32_t t : ring)
            mesh_.facets[t] = glm::vec3(mesh_.facet_of(mesh_.triangles[t]));
        points_[v] = glm::vec3(mesh_.points[v]);
    }
}

}  // namespace

void fit(CollapseMesh& mesh, const Mesh& source, Adjacency& adjacency, const FitOptions& options,
         const Job& job) {
    if (mesh.live == 0 || mesh.ids.empty() || !mesh.others.empty())
        return;
    adjacency.build(mesh);
    Fit fit(mesh, source, adjacency);
    const double want = std::min(options.samples * static_cast<double>(mesh.points.size()),
                                 options.share * static_cast<double>(source.triangles.size()));
    for (int sweep = 0; sweep < options.sweeps; ++sweep) {
        fit.sample(std::max(static_cast<size_t>(want), kFewSamples), job);
        fit.sample_outline(job);
        fit.solve(options.iterations);
        fit.move();
    }
}

}  // namespace lodestone::approximate
