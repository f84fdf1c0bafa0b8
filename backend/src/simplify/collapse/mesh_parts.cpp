// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse/mesh_parts.h"

#include "base/parallel.h"
#include "simplify/collapse/part_distances.h"

#include <algorithm>
#include <utility>

namespace lodestone::simplify {
namespace {

/// The triangles, of the mean area, that removing a part takes as far off as the part lies from
/// what is left without it.
/// Law: as many as there are for each vertex; a collapse moves about that much.
constexpr double kTakenOff = 2;

/// Parts after which a job is asked whether it goes on.
/// Taste: some milliseconds.
constexpr size_t kCheckEvery = 1024;

bool cheaper(const CollapsePart& a, const CollapsePart& b) {
    return a.cost < b.cost;
}

}  // namespace

void CollapseParts::measure(const CollapseMesh& mesh, double weight) {
    parts_.clear();
    if (mesh.part_count <= 1)
        return;
    struct PartMoments {
        double area = 0;
        glm::dvec3 first{0.0};
        double second = 0;
        size_t triangles = 0;
        glm::dvec3 origin{0.0};
    };
    std::vector<PartMoments> sums(mesh.part_count);
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (mesh.dead(i))
            continue;
        const Triangle& t = mesh.triangles[i];
        PartMoments& sum = sums[mesh.parts[t.x]];
        // Moments are about a vertex of the part: small parts far out lose no digits.
        if (sum.triangles++ == 0)
            sum.origin = mesh.points[t.x];
        const double area = glm::length(glm::dvec3(mesh.facets[i]));
        sum.area += area;
        glm::dvec3 middle(0.0);
        double squares = 0;
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 arm = mesh.points[t[corner]] - sum.origin;
            middle += arm / 3.0;
            squares += glm::dot(arm, arm);
        }
        sum.first += area * middle;
        // The second moment of a triangle: 1/12 of its area at each vertex, 3/4 at the centroid.
        sum.second += area * (squares / 12 + 0.75 * glm::dot(middle, middle));
    }
    for (uint32_t part = 0; part < sums.size(); ++part) {
        const PartMoments& sum = sums[part];
        if (sum.triangles == 0)
            continue;
        const double shift = sum.area > 0 ? glm::dot(sum.first, sum.first) / sum.area : 0;
        parts_.push_back({part, sum.triangles, weight * std::max(0.0, sum.second - shift)});
    }
    std::stable_sort(parts_.begin(), parts_.end(), cheaper);
    parts_.pop_back();
}

void CollapseParts::count(const CollapseMesh& mesh) {
    if (parts_.empty())
        return;
    std::vector<uint32_t> counts(mesh.part_count, 0);
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (!mesh.dead(i))
            ++counts[mesh.parts[mesh.triangles[i].x]];
    }
    for (CollapsePart& part : parts_)
        part.triangles = counts[part.part];
    std::erase_if(parts_, [](const CollapsePart& part) { return part.triangles == 0; });
}

void CollapseParts::locate(const CollapseMesh& mesh, double below, size_t from, const Job& job) {
    // Parts up to so many times dearer are located with them: making the distances takes longer.
    // Taste: a larger value locates parts that are never near their turn.
    constexpr double kAhead = 8;
    const auto first = parts_.begin() + static_cast<ptrdiff_t>(from);
    const auto end_below = [&](double cost) {
        return std::partition_point(first, parts_.end(),
                                    [&](const CollapsePart& part) { return part.cost < cost; });
    };
    if (std::all_of(first, end_below(below), [](const CollapsePart& part) { return part.located; }))
        return;
    double area = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        area += mesh.dead(i) ? 0 : glm::length(glm::dvec3(mesh.facets[i]));
    const double weight = kTakenOff * area / static_cast<double>(mesh.live);
    if (!(weight > 0))
        return;
    std::vector<uint32_t> ranks(mesh.part_count, static_cast<uint32_t>(parts_.size()));
    for (uint32_t i = 0; i < parts_.size(); ++i)
        ranks[parts_[i].part] = i;
    const PartDistances distances(mesh, ranks);
    const auto end = static_cast<size_t>(end_below(kAhead * below) - parts_.begin());
    parallel_for(end - from, [&](size_t i) {
        if (i % kCheckEvery == 0)
            job.check();
        CollapsePart& part = parts_[from + i];
        if (!std::exchange(part.located, true))
            part.cost =
                weight * distances.farthest(static_cast<uint32_t>(from + i), part.cost / weight);
    });
    std::stable_sort(first, parts_.end(), cheaper);
}

size_t CollapseParts::remove(CollapseMesh& mesh, const std::vector<uint8_t>& doomed) const {
    size_t gone = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (mesh.dead(i) || !doomed[mesh.parts[mesh.triangles[i].x]])
            continue;
        mesh.triangles[i].x = kNone;
        ++gone;
    }
    mesh.live -= gone;
    return gone;
}

}  // namespace lodestone::simplify
