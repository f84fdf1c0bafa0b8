// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/wedge_fit.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::simplify {
namespace {

// Rounds of the fit of normals.
// Taste: each comes nearer to the least squares, and to the noise of single samples.
constexpr int kNormalRounds = 3;
// Rounds of the fit of texture coordinates, which have no noise.
// Taste: each comes nearer to the least squares, in more time.
constexpr int kUvRounds = 8;
// A sample tells about a triangle if its texture coordinates are off by at most this part of the
// triangle's longest side in the texture: others are on another UV island, or another sheet.
// Taste: less leaves more as it was carried, more lets islands mix.
constexpr float kSameIsland = 0.5f;
// The fewest samples, counted by their weights, that tell a normal.
// Taste: fewer let single facets of a rough surface decide.
constexpr float kLeastSamples = 1;
// The length of the mean normal of the samples around a wedge, below which they have none in
// common: leaves, corners of boxes. The wedge keeps what it carried.
// Taste: 0.8 is slopes of 37 degrees to all sides.
constexpr float kLeastAlike = 0.8f;

/// The value that the blend of three wedges should have at a sample.
template <typename Value>
struct WedgeSample {
    uint32_t wedges[3];
    glm::vec3 weights;
    Value value;
    float area;
};

/// Jacobi steps towards the values of least squares, with the mass of each wedge (its weights times
/// areas, which is the sum of its row). Wedges without mass keep their value.
template <typename Value>
void solve_wedges(const std::vector<WedgeSample<Value>>& samples, const std::vector<float>& mass,
                  int rounds, std::vector<Value>& values) {
    std::vector<Value> moves(values.size());
    for (int round = 0; round < rounds; ++round) {
        std::fill(moves.begin(), moves.end(), Value(0.0f));
        for (const WedgeSample<Value>& one : samples) {
            Value off = one.value;
            for (int corner = 0; corner < 3; ++corner)
                off -= one.weights[corner] * values[one.wedges[corner]];
            for (int corner = 0; corner < 3; ++corner)
                moves[one.wedges[corner]] += one.area * one.weights[corner] * off;
        }
        for (size_t wedge = 0; wedge < values.size(); ++wedge) {
            if (mass[wedge] > 0)
                values[wedge] += moves[wedge] / mass[wedge];
        }
    }
}

/// For each wedge the first of its vertex that is like it.
std::vector<uint32_t> first_alike(const CollapseMesh& mesh, const Adjacency& adjacency) {
    std::vector<uint32_t> out(mesh.normals.size(), kNone);
    std::vector<uint32_t> firsts;
    for (uint32_t vertex = 0; vertex < mesh.points.size(); ++vertex) {
        firsts.clear();
        for (const uint32_t t : adjacency.around(vertex)) {
            for (int corner = 0; corner < 3; ++corner) {
                const uint32_t wedge = mesh.wedges[t][corner];
                if (mesh.triangles[t][corner] != vertex || out[wedge] != kNone)
                    continue;
                out[wedge] = wedge;
                for (const uint32_t first : firsts) {
                    if (glm::dot(mesh.normals[first], mesh.normals[wedge]) > kOneWedge) {
                        out[wedge] = first;
                        break;
                    }
                }
                if (out[wedge] == wedge)
                    firsts.push_back(wedge);
            }
        }
    }
    return out;
}

}  // namespace

glm::vec3 normal_at(const Mesh& source, const FitSample& sample) {
    const Triangle& t = source.triangles[sample.source];
    const glm::vec3 sum = source.normals[t.x] + source.normals[t.y] + source.normals[t.z];
    const float length = glm::length(sum);
    return length > 1e-6f && std::isfinite(length) ? sum / length : glm::vec3(0.0f);
}

void fit_wedge_normals(CollapseMesh& mesh, const Mesh& source, const Adjacency& adjacency,
                       const FitSamples& samples) {
    const std::vector<uint32_t> first = first_alike(mesh, adjacency);
    std::vector<WedgeSample<glm::vec3>> shaded;
    shaded.reserve(samples.size());
    std::vector<glm::vec3> sums(mesh.normals.size(), glm::vec3(0.0f));
    std::vector<float> mass(mesh.normals.size(), 0.0f);
    std::vector<float> known(mesh.normals.size(), 0.0f);
    for (const FitSample& sample : samples) {
        const glm::vec3 normal = normal_at(source, sample);
        if (normal == glm::vec3(0.0f))
            continue;
        WedgeSample<glm::vec3> one{
            {}, {sample.weights[0], sample.weights[1], sample.weights[2]}, normal, sample.area};
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t wedge = first[mesh.wedges[sample.triangle][corner]];
            one.wedges[corner] = wedge;
            sums[wedge] += one.weights[corner] * sample.area * normal;
            mass[wedge] += one.weights[corner] * sample.area;
            known[wedge] += one.weights[corner];
        }
        shaded.push_back(one);
    }
    std::vector<glm::vec3> normals = mesh.normals;
    for (uint32_t wedge = 0; wedge < normals.size(); ++wedge) {
        if (known[wedge] >= kLeastSamples && glm::length(sums[wedge]) > kLeastAlike * mass[wedge])
            normals[wedge] = sums[wedge] / mass[wedge];
        else
            mass[wedge] = 0;
    }
    solve_wedges(shaded, mass, kNormalRounds, normals);
    for (uint32_t wedge = 0; wedge < normals.size(); ++wedge) {
        const uint32_t from = first[wedge];
        if (from == kNone || !(mass[from] > 0))
            continue;
        const float length = glm::length(normals[from]);
        if (length > 0 && std::isfinite(length))
            mesh.normals[wedge] = normals[from] / length;
    }
}

void fit_wedge_uvs(FitPlaces& places, const FitSamples& samples) {
    CollapseMesh& mesh = places.mesh();
    const Mesh& source = places.source();
    const std::vector<glm::vec3>& points = places.points();
    std::vector<WedgeSample<glm::vec2>> shown;
    shown.reserve(samples.size());
    std::vector<float> mass(mesh.uvs.size(), 0.0f);
    for (const FitSample& sample : samples) {
        const Triangle& wedges = mesh.wedges[sample.triangle];
        glm::vec3 place(0.0f);
        glm::vec2 carried(0.0f);
        float longest = 0;
        for (int corner = 0; corner < 3; ++corner) {
            const glm::vec2& uv = mesh.uvs[wedges[corner]];
            place += sample.weights[corner] * points[mesh.triangles[sample.triangle][corner]];
            carried += sample.weights[corner] * uv;
            longest = std::max(longest, glm::length(uv - mesh.uvs[wedges[(corner + 1) % 3]]));
        }
        const Triangle& t = source.triangles[sample.source];
        const glm::vec3 at =
            geometry::nearest_weights(places.original(t.x) - place, places.original(t.y) - place,
                                      places.original(t.z) - place);
        const glm::vec2 uv =
            at.x * source.uvs[t.x] + at.y * source.uvs[t.y] + at.z * source.uvs[t.z];
        if (!std::isfinite(longest) || !(glm::length(uv - carried) <= kSameIsland * longest))
            continue;
        shown.push_back({{wedges.x, wedges.y, wedges.z},
                         {sample.weights[0], sample.weights[1], sample.weights[2]},
                         uv,
                         sample.area});
        for (int corner = 0; corner < 3; ++corner)
            mass[wedges[corner]] += sample.area * sample.weights[corner];
    }
    solve_wedges(shown, mass, kUvRounds, mesh.uvs);
}

}  // namespace lodestone::simplify
