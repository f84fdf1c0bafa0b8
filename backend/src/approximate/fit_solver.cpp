// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/fit_sample.h"

#include <algorithm>
#include <cmath>

namespace lodestone::approximate {
namespace {

/// Of a step of block Jacobi: with three unknown vertices a row it converges below 2/3.
constexpr float kDamping = 0.65f;
/// Holds a vertex where it is, relative to the area of the samples near it.
constexpr float kHold = 0.1f;

}  // namespace

void solve_fit(const CollapseMesh& mesh, const FitSamples& samples, int iterations,
               std::vector<glm::vec3>& moves) {
    struct Matrix {
        float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
        float mass = 0, most = 0;
    };
    const size_t count = mesh.points.size();
    std::vector<Matrix> matrices(count);
    for (const FitSample& s : samples) {
        const Triangle& c = mesh.triangles[s.triangle];
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
    moves.assign(count, glm::vec3(0.0f));
    std::vector<glm::vec3> pulls(count);
    for (int iteration = 0; iteration < iterations; ++iteration) {
        std::fill(pulls.begin(), pulls.end(), glm::vec3(0.0f));
        for (const FitSample& s : samples) {
            const Triangle& c = mesh.triangles[s.triangle];
            const glm::vec3 moved =
                s.weights[0] * moves[c.x] + s.weights[1] * moves[c.y] + s.weights[2] * moves[c.z];
            const glm::vec3 pull = (s.area * (s.miss - glm::dot(moved, s.toward))) * s.toward;
            for (int i = 0; i < 3; ++i)
                pulls[c[i]] += s.weights[i] * pull;
        }
        for (size_t v = 0; v < count; ++v) {
            const Matrix& m = matrices[v];
            const glm::vec3& p = pulls[v];
            moves[v] += glm::vec3(m.xx * p.x + m.xy * p.y + m.xz * p.z,
                                  m.xy * p.x + m.yy * p.y + m.yz * p.z,
                                  m.xz * p.x + m.yz * p.y + m.zz * p.z);
        }
    }
    for (size_t v = 0; v < count; ++v) {
        const float square = glm::dot(moves[v], moves[v]);
        const float most = matrices[v].most;
        if (square > most * most)
            moves[v] *= most / std::sqrt(square);
    }
}

}  // namespace lodestone::approximate
