// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/fit/corner_normals.h"

#include "base/parallel.h"
#include "simplify/fit/wedge_fit.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <utility>

namespace lodestone::simplify {
namespace {

/// The fewest samples on a triangle.
/// Taste: fewer do not tell its shading.
constexpr size_t kSamplesToShade = 4;
/// The mean square difference of normals above which a triangle is shaded anew, and the part of it
/// that may then be left: a rim is in it, or noise of a scan.
/// Taste: 0.001 is 1.8 degrees, which an eye sees on a flat face.
constexpr float kLeastOff = 0.001f;
// Taste: a larger part shades more triangles anew for little, and makes facets of what curves.
constexpr float kLeft = 0.25f;
// The same where the mesh is rough: there a triangle's own normals carry relief, which wedges blend
// away.
// Taste: a smaller part leaves triangles to their wedges for a tenth of what is off.
constexpr float kLeftRough = 0.9f;
/// The share of a triangle's area that must differ, by its square, by no more than kFlat from one
/// normal where the mesh is not rough; the rest is a rim.
/// Taste: a smaller share makes plates of what curves, a larger one blends rims over flat sides.
constexpr float kFlatShare = 0.5f;
// Taste: 0.001 is 1.8 degrees, which an eye sees on a flat face.
constexpr float kFlat = 0.001f;
// The same for the first guess, a mean that rims are in.
// Taste: 0.03 is 10 degrees.
constexpr float kNearFlat = 0.03f;
/// The same as kLeastOff where the mesh is rough: it has so many triangles that nobody sees single
/// ones, and its wedges are off by so much in the mean. What is smooth keeps its wedges: with
/// normals of its own each triangle would be a facet.
/// Taste: 0.01 is 6 degrees, which nobody sees among others.
constexpr float kLeastRough = 0.01f;
// Taste: 0.005 is 4 degrees; a larger value has fewer facets on smooth things and less relief on
// terrain.
constexpr double kRough = 0.005;
// Taste: fewer are facets of a smooth thing that is seen near enough.
constexpr size_t kManyTriangles = 2000;
/// The cosine of corners at one vertex that share a normal.
/// Taste: 0.995 is 6 degrees; a larger cosine keeps more relief and more normals.
constexpr float kAlike = 0.995f;
// Triangles that one thread computes at a time.
// Taste: larger chunks share the work less evenly.
constexpr size_t kTrianglesAtOnce = 2048;

bool shaded(const glm::vec3& normal) {
    return normal != glm::vec3(0.0f);
}

/// The linear function over one triangle that is nearest to the normals of its samples. Their mean
/// counts like one more sample.
class TriangleShading {
public:
    void add(const FitSample& sample, const glm::vec3& normal) {
        const glm::vec3 weights(sample.weights[0], sample.weights[1], sample.weights[2]);
        for (int corner = 0; corner < 3; ++corner) {
            squares_[corner] += sample.area * weights[corner] * weights;
            sums_[corner] += sample.area * weights[corner] * normal;
        }
        area_ += sample.area;
        ++count_;
    }
    size_t count() const { return count_; }
    /// Computes the normals of the three corners; false when samples cancel out.
    bool solve(glm::vec3* corners) const {
        const glm::vec3 mean = (sums_[0] + sums_[1] + sums_[2]) / area_;
        const float pull = area_ / static_cast<float>(count_);
        const glm::mat3 inverse = glm::inverse(squares_ + glm::mat3(pull));
        for (int corner = 0; corner < 3; ++corner) {
            glm::vec3 normal(0.0f);
            for (int k = 0; k < 3; ++k)
                normal += inverse[k][corner] * (sums_[k] + pull * mean);
            const float length = glm::length(normal);
            if (!(length > 0.1f) || !std::isfinite(length))
                return false;
            corners[corner] = normal / length;
        }
        return true;
    }

private:
    glm::mat3 squares_{0.0f};
    glm::vec3 sums_[3] = {glm::vec3(0.0f), glm::vec3(0.0f), glm::vec3(0.0f)};
    float area_ = 0;
    size_t count_ = 0;
};

/// The linear function nearest to the normals on a triangle; false when few tell it.
bool linear_normals(const FitSamples& samples, std::span<const PlacedSample> on, const Mesh& source,
                    glm::vec3* corners) {
    TriangleShading shading;
    for (const PlacedSample& placed : on) {
        const FitSample& sample = samples[placed.index];
        const glm::vec3 normal = normal_at(source, sample);
        if (shaded(normal))
            shading.add(sample, normal);
    }
    return shading.count() >= kSamplesToShade && shading.solve(corners);
}

/// The mean square difference between the normals of samples and those blended from the corners'.
float off_by(const glm::vec3* corners, const FitSamples& samples, std::span<const PlacedSample> on,
             const Mesh& source) {
    float sum = 0;
    float area = 0;
    for (const PlacedSample& placed : on) {
        const FitSample& s = samples[placed.index];
        const glm::vec3 normal = normal_at(source, s);
        const glm::vec3 blend =
            s.weights[0] * corners[0] + s.weights[1] * corners[1] + s.weights[2] * corners[2];
        const float length = glm::length(blend);
        const glm::vec3 off = normal - (length > 0 ? blend / length : blend);
        sum += s.area * glm::dot(off, off);
        area += s.area;
    }
    return area > 0 ? sum / area : 0;
}

/// The normal of most of a triangle, the same for its three corners; false when it is not flat.
bool flat_normal(const FitSamples& samples, std::span<const PlacedSample> on, const Mesh& source,
                 glm::vec3* corners) {
    glm::vec3 normal(0.0f);
    float within = 4;  // all of them
    for (const float next : {kNearFlat, kFlat, 0.0f}) {
        glm::vec3 sum(0.0f);
        float flat = 0;
        float area = 0;
        for (const PlacedSample& placed : on) {
            const FitSample& sample = samples[placed.index];
            const glm::vec3 one = normal_at(source, sample);
            const glm::vec3 off = one - normal;
            area += sample.area;
            if (!(glm::dot(off, off) <= within))
                continue;
            sum += sample.area * one;
            flat += sample.area;
        }
        const float length = glm::length(sum);
        if (!(length > 0) || !(flat >= kFlatShare * area))
            return false;
        normal = sum / length;
        within = next;
    }
    std::fill_n(corners, 3, normal);
    return true;
}

/// By how much the wedges of a triangle shade it unlike its samples (mean square).
float off_by_wedges(const CollapseMesh& mesh, uint32_t triangle, const FitSamples& samples,
                    std::span<const PlacedSample> on, const Mesh& source) {
    const Triangle& wedges = mesh.wedges[triangle];
    const glm::vec3 carried[3] = {mesh.normals[wedges.x], mesh.normals[wedges.y],
                                  mesh.normals[wedges.z]};
    return off_by(carried, samples, on, source);
}

/// Writes new normals into `corners`, unless those of the wedges are off by little (`before`) or
/// the new ones leave much of it. What is not rough gets one normal for all of the triangle.
bool shade_anew(const FitSamples& samples, std::span<const PlacedSample> on, const Mesh& source,
                bool rough, float before, glm::vec3* corners) {
    if (on.size() < kSamplesToShade || !(before > (rough ? kLeastRough : kLeastOff)))
        return false;
    glm::vec3 found[3];
    if (!(rough ? linear_normals(samples, on, source, found)
                : flat_normal(samples, on, source, found)) ||
        !(off_by(found, samples, on, source) < (rough ? kLeftRough : kLeft) * before))
        return false;
    std::copy(found, found + 3, corners);
    return true;
}

/// Gives corners at `vertex` that come out alike, of wedges that were alike, their mean.
void share_normals(const CollapseMesh& mesh, const Adjacency& adjacency, uint32_t vertex,
                   std::vector<glm::vec3>& normals) {
    struct SharedNormal {
        glm::vec3 first;
        glm::vec3 carried;
        glm::vec3 sum;
    };
    std::vector<SharedNormal> found;
    std::vector<std::pair<uint32_t, uint32_t>> members;  // corner, index in `found`
    for (const uint32_t t : adjacency.around(vertex)) {
        for (uint32_t corner = 0; corner < 3; ++corner) {
            const uint32_t at = 3 * t + corner;
            if (mesh.triangles[t][static_cast<int>(corner)] != vertex || !shaded(normals[at]))
                continue;
            const glm::vec3 carried = mesh.normals[mesh.wedges[t][static_cast<int>(corner)]];
            const auto alike =
                std::find_if(found.begin(), found.end(), [&](const SharedNormal& one) {
                    return glm::dot(one.first, normals[at]) > kAlike &&
                           glm::dot(one.carried, carried) > kOneWedge;
                });
            const auto index = static_cast<uint32_t>(alike - found.begin());
            if (alike == found.end())
                found.push_back({normals[at], carried, glm::vec3(0.0f)});
            found[index].sum += glm::length(mesh.facets[t]) * normals[at];
            members.emplace_back(at, index);
        }
    }
    for (const auto& [at, index] : members) {
        const float length = glm::length(found[index].sum);
        if (length > 0)
            normals[at] = found[index].sum / length;
    }
}

}  // namespace

std::vector<glm::vec3> corner_normals(const FitPlaces& places, const Adjacency& adjacency,
                                      const FitSamples& samples, const Job& job) {
    const CollapseMesh& mesh = places.mesh();
    const Mesh& source = places.source();
    if (mesh.normals.empty())
        return {};
    const size_t count = mesh.triangles.size();
    const SamplesByTriangle by_triangle(places, samples);
    std::vector<float> off(count, 0.0f);
    const auto for_each_triangle = [&](const auto& act) {
        parallel_for((count + kTrianglesAtOnce - 1) / kTrianglesAtOnce, [&](size_t chunk) {
            job.check();
            const size_t end = std::min(count, (chunk + 1) * kTrianglesAtOnce);
            for (size_t t = chunk * kTrianglesAtOnce; t < end; ++t)
                act(static_cast<uint32_t>(t));
        });
    };
    for_each_triangle(
        [&](uint32_t t) { off[t] = off_by_wedges(mesh, t, samples, by_triangle.on(t), source); });
    double sum = 0;
    double area = 0;
    for (size_t t = 0; t < count; ++t) {
        const double weight = glm::length(mesh.facets[t]);
        sum += weight * off[t];
        area += weight;
    }
    const bool rough = count >= kManyTriangles && sum > kRough * area;
    std::vector<glm::vec3> normals(3 * count, glm::vec3(0.0f));
    std::atomic<bool> any{false};
    for_each_triangle([&](uint32_t t) {
        if (shade_anew(samples, by_triangle.on(t), source, rough, off[t], &normals[3 * size_t{t}]))
            any.store(true, std::memory_order_relaxed);
    });
    if (!any.load())
        return {};
    for (uint32_t v = 0; v < mesh.points.size(); ++v)
        share_normals(mesh, adjacency, v, normals);
    return normals;
}

}  // namespace lodestone::simplify
