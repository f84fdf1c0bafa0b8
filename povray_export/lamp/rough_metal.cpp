// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/rough_metal.h"

#include "light/light_around.h"
#include "povray_export/lamp/placement_grades.h"
#include "povray_export/texture/surface_finish.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

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
constexpr size_t kMostAround = 256;
constexpr size_t kFewestAround = 8;     // Taste: as kMostAround
constexpr size_t kAroundAll = 100'000;  // Taste: as kMostAround
// The steps of the light in an octave.
// Taste: more are nearer, for other files of alike things.
constexpr double kAroundSteps = 16;
// The distinct triangles at which rays are cast, at most: as for the sky.
// Taste: a larger value finds it in larger scenes, for seconds and gigabytes.
constexpr uint64_t kMostTriangles = 6'000'000;
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

/// Whether rays can be cast at all of it in a moment.
bool is_small(std::span<const light::DrawnThing> drawn) {
    std::unordered_set<Hash> known;
    uint64_t triangles = 0;
    for (const light::DrawnThing& thing : drawn) {
        const RepresentationSummary& summary = thing.representation->summary;
        if (known.insert(summary.hash).second)
            triangles += summary.cost.triangles;
    }
    return triangles <= kMostTriangles;
}

glm::dvec3 stepped(const glm::dvec3& light) {
    glm::dvec3 out(0.0);
    for (int i = 0; i < 3; ++i) {
        if (light[i] > kLeastAround)
            out[i] = std::exp2(std::round(kAroundSteps * std::log2(light[i])) / kAroundSteps);
    }
    return out;
}

}  // namespace

std::vector<glm::dvec3> light_on_rough_metal(const Model& model,
                                             const light::RendererSurfaces& renderer,
                                             std::span<const light::DrawnThing> drawn,
                                             std::span<const double> pixels,
                                             const light::LightDemands& demands, const Job& job) {
    std::vector<glm::dvec3> out(drawn.size(), glm::dvec3(0.0));
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
    if (requests.empty() || !is_small(drawn))
        return out;
    const size_t rays = std::clamp(kAroundAll / requests.size(), kFewestAround, kMostAround);
    for (light::AroundRequest& request : requests)
        request.rays = static_cast<int>(rays);
    std::vector<glm::dvec3> found;
    try {
        found = light::light_around(model, renderer, drawn, requests, demands, job);
    } catch (const Error& error) {
        if (error.status == Status::Cancelled)
            throw;
        return out;
    }
    std::unordered_map<Hash, std::vector<size_t>> alike;  // requests
    for (size_t i = 0; i < requests.size(); ++i) {
        out[requests[i].drawn] = stepped(found[i]);
        alike[drawn[requests[i].drawn].representation->summary.hash].push_back(i);
    }
    for (const auto& [hash, copies] : alike) {
        if (copies.size() <= kPlacementGrades)
            continue;
        glm::dvec3 sum(0.0);
        for (const size_t i : copies)
            sum += found[i];
        for (const size_t i : copies)
            out[requests[i].drawn] = stepped(sum / static_cast<double>(copies.size()));
    }
    return out;
}

}  // namespace lodestone::povray
