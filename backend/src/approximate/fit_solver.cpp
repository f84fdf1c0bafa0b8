// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/fit_sample.h"

#include <algorithm>
#include <cmath>

namespace lodestone::approximate {
namespace {

/// Of a step of block Jacobi: with three unknown vertices a row it converges below 2/3.
constexpr float kDamping = 0.65f;

}  // namespace

void solve_fit(const CollapseMesh& mesh, const FitSamples& samples, int iterations, float hold,
               std::vector<glm::vec3>& moves) {
    struct Matrix {
        float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
        float mass = 0, most = 0;
        glm::vec3 times(const glm::vec3& p) const {
            return {xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z,
                    xz * p.x + yz * p.y + zz * p.z};
        }
    };
    const size_t count = mesh.points.size();
    std::vector<Matrix> matrices(count);
    std::vector<glm::vec3> pulls(count, glm::vec3(0.0f));  // where nothing has moved yet, at first
    for (const FitSample& s : samples) {
        const Triangle& c = mesh.triangles[s.triangle];
        const glm::vec3 pull = (s.area * s.miss) * s.toward;
        for (int i = 0; i < 3; ++i) {
            pulls[c[i]] += s.weights[i] * pull;
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
        const float held = hold * m.mass;
        m.xx += held;
        m.yy += held;
        m.zz += held;
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
    for (int iteration = 0; iteration < iterations; ++iteration) {
        if (iteration > 0) {
            std::fill(pulls.begin(), pulls.end(), glm::vec3(0.0f));
            for (const FitSample& s : samples) {
                const Triangle& c = mesh.triangles[s.triangle];
                const glm::vec3 moved = s.weights[0] * moves[c.x] + s.weights[1] * moves[c.y] +
                                        s.weights[2] * moves[c.z];
                const glm::vec3 pull = (s.area * (s.miss - glm::dot(moved, s.toward))) * s.toward;
                for (int i = 0; i < 3; ++i)
                    pulls[c[i]] += s.weights[i] * pull;
            }
        }
        for (size_t v = 0; v < count; ++v)
            moves[v] += matrices[v].times(pulls[v]);
    }
    for (size_t v = 0; v < count; ++v) {
        const float square = glm::dot(moves[v], moves[v]);
        const float most = matrices[v].most;
        if (square > most * most)
            moves[v] *= most / std::sqrt(square);
    }
}

}  // namespace lodestone::approximate
