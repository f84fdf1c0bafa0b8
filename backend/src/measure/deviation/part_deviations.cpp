// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/deviation/part_deviations.h"

#include "base/parallel.h"
#include "measure/deviation/sample_errors.h"

#include <algorithm>

namespace lodestone::measure {
namespace {

// The points of a part.
// Law: the 99.9 % quantile of fewer than a thousand would be the largest distance.
constexpr size_t kPoints = 1024;
// The points of all parts together, where these are few and so large.
// Taste: a larger value knows the errors of large parts better, in time in proportion.
constexpr size_t kPointsOfAll = 32768;

SurfaceDeviation one_way(const PartedSurface& from, const ray::MeshScene& to, size_t part,
                         uint32_t points, uint64_t seed) {
    std::vector<SurfaceSample> samples;
    add_area_samples(
        from.mesh, from.scene,
        from.order.subspan(from.before[part], from.before[part + 1] - from.before[part]), points,
        seed + part, samples);
    std::vector<double> places;
    uint32_t last = ray::kNoTriangle;
    for (const SurfaceSample& sample : samples) {
        const ray::ClosestPoint closest =
            to.closest_point(sample.point, std::numeric_limits<double>::infinity(), last);
        last = closest.triangle;
        places.push_back(closest.distance);
    }
    return deviation_of(samples, places, std::vector<double>(samples.size(), 0), 0);
}

}  // namespace

std::vector<SurfaceDeviation> part_deviations(const PartedSurface& finest,
                                              const PartedSurface& stand_in, uint64_t seed,
                                              const Job& job) {
    std::vector<SurfaceDeviation> out(finest.before.size() - 1);
    const auto points = static_cast<uint32_t>(std::max(kPoints, kPointsOfAll / out.size()));
    parallel_for(out.size(), [&](size_t part) {
        job.check();
        const SurfaceDeviation there = one_way(finest, stand_in.scene, part, points, seed);
        const SurfaceDeviation back = one_way(stand_in, finest.scene, part, points, seed);
        out[part] = {std::max(there.error, back.error), std::max(there.max, back.max)};
    });
    return out;
}

}  // namespace lodestone::measure
