// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/lit_surroundings.h"

#include "base/hash.h"
#include "povray_export/lamp/placement_grades.h"
#include "povray_export/texture/surface_finish.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace lodestone::povray {
namespace {

// The pixels across from which on a thing shows what is around it.
// Taste: a smaller value finds it for smaller things, in more time.
constexpr double kAroundShows = 4;
// The share of the light around from which on a surface shows it as rough metal does.
// Taste: a smaller value tells copies that are hardly metal from each other.
constexpr double kLeastShown = 0.1;
// The rays of one thing of rough metal, and about those of all.
// Taste: more have less noise between things, in more time.
constexpr size_t kMostAroundRays = 256;
constexpr size_t kFewestAroundRays = 8;     // Taste: as kMostAroundRays
constexpr size_t kAllAroundRays = 100'000;  // Taste: as kMostAroundRays
// The rays of all copies that are no metal, and about those of all such things; the copies that cast
// them. They show a tenth of what rough metal does.
// Taste: as kMostAroundRays.
constexpr size_t kMostMattRays = 256;
constexpr size_t kAllMattRays = 10'000;  // Taste: as kMostAroundRays
constexpr size_t kMattCopies = 8;        // Taste: more know more of the places of copies
// The steps of the light in an octave.
// Taste: more are nearer, for other files of alike things.
constexpr double kAroundSteps = 16;
// The radiance that counts as none.
// Taste: a tenth of what an 8-bit picture shows.
constexpr double kLeastAround = 3e-5;

/// How a material shows what is around it, and POV-Ray cannot.
enum class AroundShown { No, AsGloss, AsMetal };

AroundShown around_shown(const Material& material) {
    SurfaceLook look = look_of(material);
    if (material.metallic_texture)
        look.metallic = 1;
    if (material.roughness_texture)
        look.roughness = std::max(look.roughness, 0.5);
    AroundShown out = AroundShown::No;
    if (finish_of(look).around >= kLeastShown)
        out = AroundShown::AsMetal;
    else if (white_gloss(look) > 0)
        out = AroundShown::AsGloss;
    return material.other ? std::max(out, around_shown(*material.other)) : out;
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

/// Things that have one light: drawn things, some of which ask for it.
struct AlikeThings {
    std::vector<uint32_t> drawn;
    size_t first = 0;  // of the requests
    size_t count = 0;

    light::LightAround mean(std::span<const light::LightAround> found) const {
        light::LightAround out;
        for (const light::LightAround& light : found.subspan(first, count)) {
            out.radiance += light.radiance / static_cast<double>(count);
            out.part += light.part / static_cast<double>(count);
        }
        return out;
    }
};

/// The things that show what is around them, by what they share it with.
class AroundGroups {
public:
    AroundGroups(const Model& model, std::span<const light::DrawnThing> drawn,
                 std::span<const SurroundedThing> things, bool gloss) {
        std::vector<AroundShown> shown;
        shown.reserve(model.materials.size());
        for (const Material& material : model.materials)
            shown.push_back(around_shown(material));
        for (uint32_t i = 0; i < drawn.size(); ++i) {
            if (things[i].pixels < kAroundShows)
                continue;
            AroundShown most = AroundShown::No;
            for (const uint32_t number : drawn[i].representation->materials) {
                if (number < shown.size())
                    most = std::max(most, shown[number]);
            }
            const Hash hash = drawn[i].representation->summary.hash;
            if (most == AroundShown::AsMetal)
                metal_[hash].drawn.push_back(i);
            else if (most == AroundShown::AsGloss && gloss)
                gloss_[Hasher().value(hash).value(things[i].sky ? things[i].sky->hash : 0).result()]
                    .drawn.push_back(i);
        }
    }

    std::vector<light::AroundRequest> requests() {
        std::vector<light::AroundRequest> out;
        size_t metals = 0;
        for (const auto& [hash, alike] : metal_)
            metals += alike.drawn.size();
        const size_t rays = std::clamp(kAllAroundRays / std::max(metals, size_t{1}),
                                       kFewestAroundRays, kMostAroundRays);
        for (auto& [hash, alike] : metal_)
            ask(alike, alike.drawn.size(), rays, out);
        const size_t matt = std::clamp(kAllMattRays / std::max(gloss_.size(), size_t{1}),
                                       kFewestAroundRays, kMostMattRays);
        for (auto& [key, alike] : gloss_) {
            const size_t copies = std::min(alike.drawn.size(), kMattCopies);
            ask(alike, copies, matt / copies, out);
        }
        return out;
    }

    /// Tells each thing what was found for the requests.
    void tell(std::span<const light::LightAround> found,
              std::vector<light::LightAround>& out) const {
        for (const auto& [hash, alike] : metal_) {
            const bool own = alike.count <= kPlacementGrades;
            const light::LightAround mean = stepped(alike.mean(found));
            for (size_t k = 0; k < alike.count; ++k)
                out[alike.drawn[k]] = own ? stepped(found[alike.first + k]) : mean;
        }
        for (const auto& [key, alike] : gloss_) {
            const light::LightAround mean = stepped(alike.mean(found));
            for (const uint32_t i : alike.drawn)
                out[i] = mean;
        }
    }

private:
    /// Lets so many of the things, far from each other in the list, cast rays.
    static void ask(AlikeThings& alike, size_t count, size_t rays,
                    std::vector<light::AroundRequest>& out) {
        alike.first = out.size();
        alike.count = count;
        for (size_t k = 0; k < count; ++k)
            out.push_back({alike.drawn[k * alike.drawn.size() / count], static_cast<int>(rays)});
    }

    std::map<Hash, AlikeThings> metal_;  // by mesh
    std::map<Hash, AlikeThings> gloss_;  // by mesh and light of the sky
};

}  // namespace

std::vector<light::LightAround> lit_surroundings(const Model& model,
                                                 const light::RendererSurfaces& renderer,
                                                 std::span<const light::DrawnThing> drawn,
                                                 std::span<const SurroundedThing> things,
                                                 const light::LightDemands& demands, bool still,
                                                 const Job& job) {
    std::vector<light::LightAround> out(drawn.size());
    AroundGroups groups(model, drawn, things, still && demands.bounces == 0);
    const std::vector<light::AroundRequest> requests = groups.requests();
    if (requests.empty() || light::LitScene::too_large(drawn))
        return out;
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
    groups.tell(found, out);
    return out;
}

}  // namespace lodestone::povray
