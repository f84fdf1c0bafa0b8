// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/fit_samples.h"

#include <algorithm>
#include <cmath>

namespace lodestone::simplify {
namespace {

/// The damping of a step of block Jacobi.
/// Law: with three unknown vertices in a row it converges below 2/3.
constexpr float kDamping = 0.65f;

/// A vector x, y, z; its users say what the last lane means.
using Lanes = float __attribute__((vector_size(16)));

Lanes lanes_of(const glm::vec3& v, float last) {
    return Lanes{v.x, v.y, v.z, last};
}

/// A symmetric matrix.
struct SymmetricMatrix {
    Lanes first{};  // xx, xy, xz, and the sum of the samples' areas
    Lanes rest{};   // yy, yz, zz, nothing
    Lanes times(const Lanes& p) const {
        const Lanes second = __builtin_shufflevector(first, rest, 1, 4, 5, 7);
        const Lanes third = __builtin_shufflevector(first, rest, 2, 5, 6, 7);
        return first * p[0] + second * p[1] + third * p[2];
    }
};

/// The inverse of the matrix, with `hold` times the areas added to hold the vertex; zero where
/// there is none.
SymmetricMatrix damped_inverse(const SymmetricMatrix& m, float hold) {
    const float trace = m.first[0] + m.rest[0] + m.rest[2];
    if (!(trace > 1e-30f))
        return {};
    const float held = hold * m.first[3];
    const float xx = m.first[0] + held, yy = m.rest[0] + held, zz = m.rest[2] + held;
    const float xy = m.first[1], xz = m.first[2], yz = m.rest[1];
    const float cxx = yy * zz - yz * yz;
    const float cxy = xz * yz - xy * zz;
    const float cxz = xy * yz - xz * yy;
    const float det = xx * cxx + xy * cxy + xz * cxz;
    const float f = kDamping / det;
    if (!std::isfinite(f))
        return {};
    return {Lanes{f * cxx, f * cxy, f * cxz, 0},
            Lanes{f * (xx * zz - xz * xz), f * (xy * xz - xx * yz), f * (xx * yy - xy * xy), 0}};
}

}  // namespace

void solve_fit(const CollapseMesh& mesh, const FitSamples& samples, int iterations, float hold,
               std::vector<glm::vec3>& moves) {
    const size_t count = mesh.points.size();
    std::vector<SymmetricMatrix> matrices(count);
    std::vector<float> most(count, 0);  // the largest miss of the samples near a vertex
    std::vector<Lanes> pulls(count);    // at first, where nothing has moved yet
    for (const FitSample& s : samples) {
        const Triangle& c = mesh.triangles[s.triangle];
        const Lanes toward = lanes_of(s.toward, 1);
        const Lanes pull = (s.area * s.miss) * toward;
        for (int i = 0; i < 3; ++i) {
            pulls[c[i]] += s.weights[i] * pull;
            const float mass = s.area * s.weights[i];
            const Lanes weighted = (mass * s.weights[i]) * toward;
            SymmetricMatrix& m = matrices[c[i]];
            m.first += Lanes{weighted[0], weighted[0], weighted[0], mass} * toward;
            m.rest += __builtin_shufflevector(weighted, weighted, 1, 1, 2, 3) *
                      __builtin_shufflevector(toward, toward, 1, 2, 2, 3);
            if (s.weights[i] > 0.1f)
                most[c[i]] = std::max(most[c[i]], std::abs(s.miss));
        }
    }
    for (SymmetricMatrix& m : matrices)
        m = damped_inverse(m, hold);
    std::vector<Lanes> moved(count);
    for (int iteration = 0; iteration < iterations; ++iteration) {
        if (iteration > 0) {
            std::fill(pulls.begin(), pulls.end(), Lanes{});
            for (const FitSample& s : samples) {
                const Triangle& c = mesh.triangles[s.triangle];
                const Lanes toward = lanes_of(s.toward, 0);
                const Lanes off = (s.weights[0] * moved[c.x] + s.weights[1] * moved[c.y] +
                                   s.weights[2] * moved[c.z]) *
                                  toward;
                const Lanes pull = (s.area * (s.miss - (off[0] + off[1] + off[2]))) * toward;
                for (int i = 0; i < 3; ++i)
                    pulls[c[i]] += s.weights[i] * pull;
            }
        }
        for (size_t v = 0; v < count; ++v)
            moved[v] += matrices[v].times(pulls[v]);
    }
    moves.resize(count);
    for (size_t v = 0; v < count; ++v) {
        moves[v] = {moved[v][0], moved[v][1], moved[v][2]};
        const float square = glm::dot(moves[v], moves[v]);
        if (square > most[v] * most[v])
            moves[v] *= most[v] / std::sqrt(square);
    }
}

}  // namespace lodestone::simplify
