// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/wedge_normals.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace lodestone::simplify {
namespace {

// Rounds of the fit.
// Taste: each comes nearer to the least squares, and to the noise of single samples.
constexpr int kRounds = 3;
// The fewest samples, counted by their weights, that tell a normal.
// Taste: fewer let single facets of a rough surface decide.
constexpr float kLeastSamples = 1;
// The length of the mean normal of the samples around a wedge, below which they have none in
// common: leaves, corners of boxes. The wedge keeps what it carried.
// Taste: 0.8 is slopes of 37 degrees to all sides.
constexpr float kLeastAlike = 0.8f;

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
    struct NormalSample {
        uint32_t wedges[3];
        glm::vec3 weights;
        glm::vec3 normal;
        float area;
    };
    const std::vector<uint32_t> first = first_alike(mesh, adjacency);
    std::vector<NormalSample> shaded;
    shaded.reserve(samples.size());
    std::vector<glm::vec4> mass(mesh.normals.size(), glm::vec4(0.0f));  // w: area
    std::vector<glm::vec3> normals(mesh.normals.size(), glm::vec3(0.0f));
    std::vector<float> known(mesh.normals.size(), 0.0f);
    for (const FitSample& sample : samples) {
        const glm::vec3 normal = normal_at(source, sample);
        if (normal == glm::vec3(0.0f))
            continue;
        NormalSample one{
            {}, {sample.weights[0], sample.weights[1], sample.weights[2]}, normal, sample.area};
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t wedge = first[mesh.wedges[sample.triangle][corner]];
            one.wedges[corner] = wedge;
            mass[wedge] += one.weights[corner] * glm::vec4(sample.area * normal, sample.area);
            known[wedge] += one.weights[corner];
        }
        shaded.push_back(one);
    }
    const auto told = [&](uint32_t wedge) {
        return known[wedge] >= kLeastSamples &&
               glm::length(glm::vec3(mass[wedge])) > kLeastAlike * mass[wedge].w;
    };
    for (uint32_t wedge = 0; wedge < normals.size(); ++wedge) {
        const float area = mass[wedge].w;
        normals[wedge] = told(wedge) ? glm::vec3(mass[wedge]) / area : mesh.normals[wedge];
    }
    // Jacobi steps with the mass of each wedge, which is the sum of its row.
    std::vector<glm::vec3> moves(normals.size());
    for (int round = 0; round < kRounds; ++round) {
        std::fill(moves.begin(), moves.end(), glm::vec3(0.0f));
        for (const NormalSample& one : shaded) {
            glm::vec3 off = one.normal;
            for (int corner = 0; corner < 3; ++corner)
                off -= one.weights[corner] * normals[one.wedges[corner]];
            for (int corner = 0; corner < 3; ++corner)
                moves[one.wedges[corner]] += one.area * one.weights[corner] * off;
        }
        for (uint32_t wedge = 0; wedge < normals.size(); ++wedge) {
            if (told(wedge))
                normals[wedge] += moves[wedge] / mass[wedge].w;
        }
    }
    for (uint32_t wedge = 0; wedge < normals.size(); ++wedge) {
        const uint32_t from = first[wedge];
        if (from == kNone || !told(from))
            continue;
        const float length = glm::length(normals[from]);
        if (length > 0 && std::isfinite(length))
            mesh.normals[wedge] = normals[from] / length;
    }
}

}  // namespace lodestone::simplify
