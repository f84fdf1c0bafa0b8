// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/finest.h"

#include "hierarchy/counted_error.h"
#include "hierarchy/lamp_materials.h"
#include "measure/visible/surface_opacity.h"

#include <algorithm>

namespace lodestone::hierarchy {
namespace {

// Below this mean opacity nothing solid stands for it: it would hide what shines through.
// Taste: a larger value leaves fewer solids to what is nearly opaque.
constexpr double kLeastOpacity = 0.9;
// The rays from a triangle of a group that decide whether anything outside can see it.
// Taste: more find more triangles behind narrow gaps, in time in proportion.
constexpr int kRaysPerTriangle = 16;

/// The ground is large, and what lies on it (roads, fields) a small share of it; a few triangles,
/// with all of their corners, are known from a few points of each.
uint32_t samples_of(const Mesh& finest, bool environment, const BuildSettings& settings) {
    // How many times as many samples the ground has.
    // Taste: more see smaller things on it, in time in proportion.
    constexpr uint32_t kOfEnvironment = 8;
    // The samples of a triangle where they are few.
    // Taste: more know errors better, in time in proportion.
    constexpr uint64_t kOfTriangle = 2;
    // The fewest samples of a mesh.
    // Taste: more know the errors of simple meshes better, in time in proportion.
    constexpr uint64_t kFewest = 256;
    if (environment)
        return kOfEnvironment * settings.samples;
    return static_cast<uint32_t>(std::min<uint64_t>(
        settings.samples, std::max(kFewest, kOfTriangle * finest.triangles.size())));
}

/// Few samples come with few rays, but colors and solids are made by them: four times the share.
uint64_t rays_of(uint32_t samples, const BuildSettings& settings) {
    const uint64_t more = 4 * uint64_t{samples};
    return more < settings.samples ? settings.rays * more / settings.samples : settings.rays;
}

}  // namespace

bool MeasuredFinest::solid() const {
    return opacity >= kLeastOpacity;
}

ray::SkinPtr MeasuredFinest::skin_of(std::span<const Material> own) const {
    return std::make_shared<const ray::MeshSkin>(own, texels);
}

measure::VisibleOptions MeasuredFinest::visible_options(uint64_t rays_of_it) const {
    measure::VisibleOptions out;
    out.rays = rays_of_it;
    out.seed = options.seed;
    return out;
}

double MeasuredFinest::error_at(double distance) const {
    return counted_error(distance, options.environment || layered, size) + options.child_error;
}

double MeasuredFinest::distance_for(double error) const {
    return (error - options.child_error) / counted_error(1, options.environment || layered, 0);
}

MeasuredFinest measure_finest(const Mesh& mesh, std::span<const Material> materials,
                              image::TexelCache& texels, const BuildSettings& settings,
                              const FinestOptions& options, const Job& job) {
    const uint32_t samples = samples_of(mesh, options.environment, settings);
    MeasuredFinest out{mesh, texels, options, rays_of(samples, settings),
                       bound_of(mesh.positions).radius};
    out.materials.assign(materials.begin(), materials.end());
    out.skin = out.skin_of(materials);
    out.looks = std::make_unique<measure::LookPalette>();
    const std::vector<uint16_t> looks = out.looks->of(mesh, materials);
    auto reference = std::make_unique<measure::DeviationReference>(
        mesh,
        measure::DeviationOptions{samples, settings.samples, options.seed,
                                  options.group ? kRaysPerTriangle : 0},
        measure::SurfaceLooks{looks, out.looks.get(), out.skin}, job);
    out.opacity = measure::mean_opacity(mesh, *out.skin, options.seed);
    out.cast = reference->take_cast_points();  // of the same rays
    out.reference = std::move(reference);
    out.attributes = measure::measure_visible(mesh, out.sampler(), out.skin,
                                              out.visible_options(out.rays), {}, out.cast, job)
                         .attributes;
    out.glows = std::any_of(materials.begin(), materials.end(), emits);
    out.layered = options.in_layers && is_flat(out.attributes);
    out.views = std::make_unique<const measure::ViewDistances>(mesh, out.scene());
    if (!options.group)
        out.shading = std::make_unique<const measure::ShadedPatches>(mesh, out.sampler(), out.cast,
                                                                     out.attributes.visible_area);
    if (!options.environment)
        out.patches.emplace(mesh, out.sampler(), *out.skin, out.cast);
    return out;
}

}  // namespace lodestone::hierarchy
