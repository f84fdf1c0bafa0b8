// SPDX-License-Identifier: GPL-3.0-or-later
#include "build/judge.h"

#include "measure/opacity.h"
#include "measure/visible.h"

#include <algorithm>
#include <cmath>

namespace lodestone::build {
namespace {

// A level that shows this much more or less surface than the original is no simplification of it
// (foliage gone bald), however near its remaining points are.
constexpr double kMostAreaChange = 0.25;
// An error below this fraction of the size is float noise; the finest alone has error 0.
constexpr double kLeastRelativeError = 1e-7;
// Roads, pavements and lawns lie on the ground in thin layers. A level that sinks by a little more
// than the layer is thick hides it, which shows from as far as the layer is wide: environment
// counts as this many times wider than it is off.
constexpr double kLayerWidth = 16;
// Below this mean opacity nothing solid stands for it: it would hide what shines through.
constexpr double kLeastOpacity = 0.9;
constexpr int kSubdivisions = 3;  // an ellipsoid measured as 1280 triangles

/// The ground is large, and what lies on it (roads, fields) a small share of it.
uint32_t samples_of(bool environment, const Settings& settings) {
    return environment ? 8 * settings.samples : settings.samples;
}

}  // namespace

double counted_error(double error, bool environment, double size) {
    return std::max((environment ? kLayerWidth : 1) * error, kLeastRelativeError * size);
}

Judge::Judge(const Mesh& finest, std::span<const Material> materials, image::TexelCache& texels,
             const Settings& settings, bool environment, uint64_t seed, double child_error,
             const Job& job)
    : size_(bound_of(finest.positions).radius),
      child_error_(child_error),
      environment_(environment),
      seed_(seed),
      rays_(settings.rays),
      skin_(std::make_shared<const ray::Skin>(materials, texels)),
      finest_looks_(looks_.of(finest, materials)),
      reference_(finest, {samples_of(environment, settings), settings.samples, seed},
                 {finest_looks_, &looks_, skin_}, job) {}

void Judge::measure_finest(const Mesh& finest, const Job& job) {
    opacity_ = measure::mean_opacity(finest, *skin_, seed_);
    measure::VisibleOptions options;
    options.rays = rays_;
    options.seed = seed_;
    attributes_ =
        measure::measure_visible(finest, ray::Scene(finest, skin_), skin_, options, {}, job)
            .attributes;
}

bool Judge::solid() const {
    return opacity_ >= kLeastOpacity;
}

bool Judge::shows_as_much(const Mesh& level, const Job& job) const {
    measure::VisibleOptions options;
    options.rays = rays_ / 2;
    options.seed = seed_;
    const double visible =
        measure::measure_visible(level, ray::Scene(level, skin_), skin_, options, {}, job)
            .attributes.visible_area;
    return std::abs(visible - attributes_.visible_area) <=
           kMostAreaChange * attributes_.visible_area;
}

void Judge::measure_mesh(Candidate& candidate, const Job& job) {
    const Mesh& mesh = *candidate.mesh;
    const std::vector<uint16_t> looks = looks_.of(mesh, candidate.materials);
    set_error(candidate, reference_.of(mesh, {looks, &looks_, skin_}, job));
}

void Judge::measure_primitive(Candidate& candidate, const Job& job) {
    const Mesh mesh = candidate.kind == Kind::Box
                          ? tessellate_box(candidate.primitive)
                          : tessellate_ellipsoid(candidate.primitive, kSubdivisions);
    const std::vector<uint16_t> looks = looks_.of(mesh, candidate.materials);
    set_error(candidate, reference_.of(mesh, {looks, &looks_, nullptr}, job));
}

void Judge::set_error(Candidate& candidate, const measure::Deviation& deviation) const {
    const auto counted = [&](double error) {
        return counted_error(error, environment_, size_) + child_error_;
    };
    candidate.error = counted(deviation.error);
    candidate.max_error = std::max(candidate.error, counted(deviation.max));
}

}  // namespace lodestone::build
