// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/sky/sky_horizon.h"

#include "base/maths.h"
#include "light/sky/sky_sampler.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::light {
namespace {

// The placements that are asked, and the rays of each.
// Taste: more are truer; quarters need few.
constexpr size_t kMostPlaces = 64;
constexpr size_t kRaysOfPlace = 16;  // Taste: as kMostPlaces
// The mean of the placements' cosines to one axis from which on that is up for all of them.
// Taste: a smaller value lets leaning things stand on the ground.
constexpr double kUpright = 0.9;
// The steps of the part that is kept.
// Taste: more are truer, and change with smaller changes of the scene.
constexpr double kSteps = 4;

/// The axis of the own frame that points up at the placements; zero: there is none.
glm::dvec3 upright(std::span<const Affine> places) {
    glm::dvec3 sum(0.0);
    for (const Affine& world : places) {
        const glm::dvec3 up = glm::transpose(world.linear) * glm::dvec3(0.0, 0.0, 1.0);
        const double length = glm::length(up);
        if (length > 0 && std::isfinite(length))
            sum += up / length;
    }
    sum /= std::max<double>(1, static_cast<double>(places.size()));
    glm::dvec3 out(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(sum[axis]) >= kUpright)
            out[axis] = sum[axis] > 0 ? 1 : -1;
    }
    return out;
}

}  // namespace

SkyHorizon sky_horizon(const SkySurface& surface, std::span<const Affine> places,
                       const SkyScene& scene) {
    const glm::dvec3 up = upright(places);
    if (up == glm::dvec3(0.0) || !(surface.area() > 0))
        return {};
    const ray::FlushDenormals fast;
    const size_t count = std::min(places.size(), kMostPlaces);
    const glm::dvec3 upward(0.0, 0.0, 1.0);
    int seen = 0;
    int passed = 0;
    for (size_t i = 0; i < count; ++i) {
        SkyRequest request{surface, places[i * places.size() / count], &scene};
        request.horizon.up = up;
        const SkySampler sampler(request);
        uint32_t blocker = ray::PlacedScenes::kNothing;
        uint32_t near = ray::kNoTriangle;
        for (size_t k = 0; k < kRaysOfPlace; ++k) {
            // Each placement asks at other points of the surface.
            const size_t number = k * count + i;
            const size_t triangle = surface.triangle_at((static_cast<double>(number) + 0.5) /
                                                        static_cast<double>(count * kRaysOfPlace));
            const auto placed = triangle < surface.areas.size()
                                    ? sampler.placed(*surface.mesh, triangle)
                                    : std::nullopt;
            if (!placed)
                continue;
            const bool both = !surface.opaque_slot(surface.mesh->slot(triangle));
            const SkySampler::SkyRay ray =
                sampler.ray(sampler.place(*surface.mesh, triangle, *placed,
                                          static_cast<uint32_t>(number), near),
                            both && k % 2 == 1);
            if (!ray.open || !sampler.down(ray) || sampler.hidden_alone(ray))
                continue;
            const bool free = !sampler.hidden(ray, blocker);
            // From under the ground there is always sky below, and nobody looks.
            if (free && scene.first_block(ray.from_world, upward).back)
                continue;
            ++passed;
            seen += free ? 1 : 0;
        }
    }
    const double below = passed > 0 ? std::round(kSteps * seen / passed) / kSteps : 1;
    return {up, below, true};
}

}  // namespace lodestone::light
