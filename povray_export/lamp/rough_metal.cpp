// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/rough_metal.h"

#include "povray_export/lamp/placement_grades.h"
#include "povray_export/texture/surface_finish.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace lodestone::povray {
namespace {

// The pixels across from which on a thing shows what is around it.
// Taste: a smaller value finds it for smaller things, in more time.
constexpr double kAroundShows = 4;
// The share of the light around from which on a surface shows it.
// Taste: a smaller value finds it for surfaces that are hardly metal.
constexpr double kLeastShown = 0.1;
// The rays of one thing, and about those of all.
// Taste: more have less noise between things, in more time.
constexpr size_t kMostAroundRays = 256;
constexpr size_t kFewestAroundRays = 8;     // Taste: as kMostAroundRays
constexpr size_t kAllAroundRays = 100'000;  // Taste: as kMostAroundRays
// The steps of the light in an octave.
// Taste: more are nearer, for other files of alike things.
constexpr double kAroundSteps = 16;
// The radiance that counts as none.
// Taste: a tenth of what an 8-bit picture shows.
constexpr double kLeastAround = 3e-5;

/// Whether a material shows what is around it, and POV-Ray cannot.
bool shows_around(const Material& material) {
    SurfaceLook look = look_of(material);
    if (material.metallic_texture)
        look.metallic = 1;
    if (material.roughness_texture)
        look.roughness = std::max(look.roughness, 0.5);
    return finish_of(look).around >= kLeastShown ||
           (material.other && shows_around(*material.other));
}

light::LightAround stepped(const light::LightAround& light) {
    light::LightAround out;
    for (int i = 0; i < 3; ++i) {
        if (light.radiance[i] > kLeastAround)
            out.radiance[i] =
                std::exp2(std::round(kAroundSteps * std::log2(light.radiance[i])) / kAroundSteps);
    }
    if (out.radiance != glm::dvec3(0.0))
        out.part = std::round(kAroundSteps * light.part) / kAroundSteps;
    return out;
}

}  // namespace

std::vector<light::LightAround> light_on_rough_metal(const Model& model,
                                                     const light::RendererSurfaces& renderer,
                                                     std::span<const light::DrawnThing> drawn,
                                                     std::span<const double> pixels,
                                                     const light::LightDemands& demands,
                                                     const Job& job) {
    std::vector<light::LightAround> out(drawn.size());
    std::vector<uint8_t> shows;
    shows.reserve(model.materials.size());
    for (const Material& material : model.materials)
        shows.push_back(shows_around(material) ? 1 : 0);
    std::vector<light::AroundRequest> requests;
    for (uint32_t i = 0; i < drawn.size(); ++i) {
        const std::vector<uint32_t>& materials = drawn[i].representation->materials;
        if (pixels[i] >= kAroundShows &&
            std::any_of(materials.begin(), materials.end(), [&](uint32_t number) {
                return number < shows.size() && shows[number] != 0;
            }))
            requests.push_back({i, 0});
    }
    if (requests.empty() || light::LitScene::too_large(drawn))
        return out;
    const size_t rays =
        std::clamp(kAllAroundRays / requests.size(), kFewestAroundRays, kMostAroundRays);
    for (light::AroundRequest& request : requests)
        request.rays = static_cast<int>(rays);
    std::vector<light::LightAround> found;
    try {
        found = light::light_around(model, renderer, drawn, requests, demands, job);
    } catch (const Error& error) {
        if (error.status == Status::Cancelled)
            throw;
        return out;
    }
    // Where nothing hides the sky, all of it is shown already.
    for (light::LightAround& light : found) {
        if (!demands.sky_shaded)
            light.radiance = glm::max(light.radiance - demands.sky, glm::dvec3(0.0));
    }
    std::unordered_map<Hash, std::vector<size_t>> alike;  // requests
    for (size_t i = 0; i < requests.size(); ++i) {
        out[requests[i].drawn] = stepped(found[i]);
        alike[drawn[requests[i].drawn].representation->summary.hash].push_back(i);
    }
    for (const auto& [hash, copies] : alike) {
        if (copies.size() <= kPlacementGrades)
            continue;
        light::LightAround mean;
        for (const size_t i : copies) {
            mean.radiance += found[i].radiance / static_cast<double>(copies.size());
            mean.part += found[i].part / static_cast<double>(copies.size());
        }
        for (const size_t i : copies)
            out[requests[i].drawn] = stepped(mean);
    }
    return out;
}

}  // namespace lodestone::povray
