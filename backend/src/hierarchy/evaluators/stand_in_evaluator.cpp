// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/evaluators/stand_in_evaluator.h"

#include "hierarchy/evaluators/lamp_glow.h"
#include "measure/visible/surface_opacity.h"
#include "solids/keep_on_floor.h"
#include "solids/match_solids.h"
#include "solids/painted_box.h"
#include "solids/solid_replacement.h"
#include "solids/stand_in_material.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lodestone::hierarchy {
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
// A thing is flat where it is, in the standard deviations of its surface, this much thinner than
// wide.
constexpr double kFlat = 0.05;
// Below this mean opacity nothing solid stands for it: it would hide what shines through.
constexpr double kLeastOpacity = 0.9;
constexpr int kMeasuredSubdivisions = 3;  // an ellipsoid measured as 1280 triangles
// Of the pixel size from which on whole pictures agree, what is near in space may have as an error.
constexpr double kPictures = 0.5;
constexpr double kPatches = 0.5;  // likewise of the patches that look different
// Over the radius: what is used up to here is that where the whole is 24 pixels large or more, and
// looks alike.
constexpr double kUsedNear = 1.0 / 12;

Mesh tessellated(const StandInCandidate& primitive) {
    return primitive.kind == Kind::Box
               ? tessellate_box(primitive.primitive)
               : tessellate_ellipsoid(primitive.primitive, kMeasuredSubdivisions);
}

/// What stands for a candidate where rays are cast; `solid` holds it unless it is a mesh.
const Mesh& traced_mesh(const StandInCandidate& candidate, Mesh& solid) {
    if (candidate.kind == Kind::Mesh)
        return *candidate.mesh;
    solid = candidate.kind == Kind::Composite ? tessellate(*candidate.composite, 2)
                                              : tessellated(candidate);
    return solid;
}

/// The ground is large, and what lies on it (roads, fields) a small share of it; a few triangles,
/// with all of their corners, are known from a few points of each.
uint32_t samples_of(const Mesh& finest, bool environment, const BuildSettings& settings) {
    constexpr uint64_t kOfTriangle = 8;
    constexpr uint64_t kFewest = 512;
    if (environment)
        return 8 * settings.samples;
    return static_cast<uint32_t>(std::min<uint64_t>(
        settings.samples, std::max(kFewest, kOfTriangle * finest.triangles.size())));
}

std::vector<double> area_by_tag(const measure::VisibleAttributes& visible, size_t tags) {
    uint64_t all = 0;
    for (const uint64_t hits : visible.hits_by_tag)
        all += hits;
    std::vector<double> out(tags, 0);
    for (size_t tag = 0; all > 0 && tag < std::min(tags, visible.hits_by_tag.size()); ++tag)
        out[tag] = visible.attributes.visible_area * static_cast<double>(visible.hits_by_tag[tag]) /
                   static_cast<double>(all);
    return out;
}

}  // namespace

double counted_error(double error, bool environment, double size) {
    return std::max((environment ? kLayerWidth : 1) * error, kLeastRelativeError * size);
}

StandInEvaluator::StandInEvaluator(const Mesh& finest, std::span<const Material> materials,
                                   image::TexelCache& texels, const BuildSettings& settings,
                                   bool environment, uint64_t seed, double child_error,
                                   const Job& job, int rays_of_triangle)
    : texels_(texels),
      size_(bound_of(finest.positions).radius),
      child_error_(child_error),
      environment_(environment),
      seed_(seed),
      rays_(settings.rays),
      materials_(materials.begin(), materials.end()),
      skin_(std::make_shared<const ray::MeshSkin>(materials, texels)),
      finest_looks_(looks_.of(finest, materials)),
      reference_(
          finest,
          {samples_of(finest, environment, settings), settings.samples, seed, rays_of_triangle},
          {finest_looks_, &looks_, skin_}, job) {}

void StandInEvaluator::measure_finest(const Mesh& finest, const Job& job) {
    opacity_ = measure::mean_opacity(finest, *skin_, seed_);
    // The reference was made with the same rays.
    cast_ = reference_.take_cast_points();
    attributes_ = measure::measure_visible(finest, reference_.sampler(), skin_,
                                           visible_options(rays_), {}, cast_, job)
                      .attributes;
    if (!environment_)
        patches_.emplace(finest, reference_.sampler(), *skin_, cast_, seed_);
}

bool is_flat(double across, double through) {
    return through < kFlat * kFlat * across;
}

bool is_flat(const Attributes& attributes) {
    const auto variance = [&](int axis) {
        const glm::dvec3& along = attributes.axes[axis];
        return glm::dot(along, attributes.moments * along);
    };
    return !attributes.empty() && is_flat(variance(1), variance(2));
}

void StandInEvaluator::count_layers() {
    layer_ = is_flat(attributes_);
}

bool StandInEvaluator::solid() const {
    return opacity_ >= kLeastOpacity;
}

bool StandInEvaluator::shows_as_much(const Mesh& level, const Job& job) const {
    return shows_as_much(level, ray::MeshScene(level, skin_), job);
}

bool StandInEvaluator::shows_as_much(const Mesh& level, const ray::MeshScene& scene,
                                     const Job& job) const {
    // Few rays tell what is nearly alike or far from it.
    constexpr double kUnsure = 0.15;
    const measure::VisibleSampler sampler(level, scene, seed_);
    double change = 0;
    for (const uint64_t share : {8, 2}) {
        const double visible = measure::visible_area(sampler, rays_ / share, job);
        change = std::abs(visible / attributes_.visible_area - 1);
        if (std::abs(change - kMostAreaChange) > kUnsure)
            break;
    }
    return change <= kMostAreaChange;
}

bool StandInEvaluator::prove(StandInCandidate& candidate, double used_to, const Job& job) const {
    const bool is_mesh = candidate.kind == Kind::Mesh;
    Mesh solid;
    const Mesh& mesh = traced_mesh(candidate, solid);
    const ray::SkinPtr skin = skin_of(candidate);
    const ray::MeshScene scene(mesh, skin);
    come_to(candidate, CandidateState::Measured);
    if (is_mesh && !shows_as_much(mesh, scene, job))
        return false;
    if (!patches_)
        return true;
    const double own = candidate.error - child_error_;
    const double unlike =
        patches_->largest_unlike_patch(mesh, scene, *skin, is_matched(used_to), own / kPatches);
    const double seen = kPatches * unlike + child_error_;
    candidate.error = std::max(candidate.error, seen);
    candidate.max_error = std::max(candidate.max_error, seen);
    return true;
}

bool StandInEvaluator::is_matched(double used_to) const {
    return !environment_ && (used_to >= kUsedNear * size_ ||
                             std::any_of(materials_.begin(), materials_.end(), emits));
}

void StandInEvaluator::measure_mesh(StandInCandidate& candidate, const Job& job, double useless,
                                    const measure::DeviationReference::RepaintResult& known) {
    if (known.surely_useless) {
        candidate.error = candidate.max_error = std::numeric_limits<double>::infinity();
        return;
    }
    const Mesh& mesh = *candidate.mesh;
    const std::vector<uint16_t> looks = looks_.of(mesh, candidate.materials);
    const measure::SurfaceLooks surface{looks, &looks_, skin_of(candidate)};
    const double most = distance_for(useless);
    set_error(candidate, rough_ ? reference_.roughly(mesh, surface, known, most, job)
                                : reference_.of(mesh, surface, known, most, job));
}

void StandInEvaluator::measure_primitive(StandInCandidate& candidate, const Job& job) {
    set_error(candidate, reference_.of(Solid{candidate.kind == Kind::Box, candidate.primitive},
                                       looks_.of(candidate.materials[0]),
                                       distance_for(least_primitive_), job));
    least_primitive_ = std::min(least_primitive_, candidate.error);
}

const Attributes& StandInEvaluator::sure(const Mesh& finest, uint64_t rays, double settled,
                                         const Job& job) {
    if (sure_rays_ < rays) {
        measure::VisibleOptions options = visible_options(rays);
        options.settled = settled;
        sure_ =
            measure::measure_visible(finest, reference_.sampler(), skin_, options, {}, cast_, job)
                .attributes;
        sure_rays_ = rays;
    }
    return sure_;
}

void StandInEvaluator::settle(StandInCandidate& candidate, const Mesh& finest, double floor,
                              const Job& job) {
    // Solids that hide each other: 32,768 rays know their centroid to .1 % of the radius of
    // gyration, 262,144 to .04 %.
    constexpr uint32_t kRaysOfMany = 262144;
    constexpr uint64_t kSeedOfMany = 1;
    constexpr double kStands = 1e-9;  // over the size
    if (!candidate.by_few_rays)
        return;
    candidate.by_few_rays = false;
    // Where all of it is two pixels wide or less nobody sees a few thousandths of that.
    if (candidate.error >= size_)
        return;
    if (candidate.kind == Kind::Composite) {
        // The same rays for all (7 MB): making them takes as long as asking them once.
        static const solids::VisibleSolids kVisible(kRaysOfMany, kSeedOfMany);
        Composite composite = *candidate.composite;
        solids::settle_composite(composite,
                                 sure(finest, kRaysOfMany, solids::kSettledComposite, job), floor,
                                 kVisible, job);
        candidate.composite = std::make_shared<const Composite>(std::move(composite));
        return;
    }
    if (!(attributes_.relative_error > 0))
        return;
    const bool box = candidate.kind == Kind::Box;
    const bool clear = candidate.materials[0].alpha_mode == AlphaMode::Blend;
    Primitive& primitive = candidate.primitive;
    const bool stands = solids::reach_of(primitive, box).low <= floor + kStands * size_;
    if (clear) {
        Material& material = candidate.materials[0];
        const double through = 1 - material.alpha;
        const auto now =
            solids::settled(solids::ClearSolid{primitive, 1 - through * through}, attributes_,
                            sure(finest, solids::kRaysOfClear * rays_, 0, job));
        primitive = now.primitive;
        material.alpha = solids::surface_alpha(now.opacity);
    } else {
        primitive =
            solids::settled(primitive, attributes_,
                            sure(finest, solids::kRaysOfSolid * rays_, solids::kSettled, job));
    }
    const double low = solids::reach_of(primitive, box).low;
    if (stands || low < floor)
        primitive.center.z += floor - low;
}

void StandInEvaluator::take_pictures(const Mesh& finest, bool coarse, const Job& job) {
    using Pictures = measure::AgreementReference;
    take_pictures_of(finest, coarse ? Pictures::kCoarseSide : Pictures::kSide, job);
}

void StandInEvaluator::take_pictures_of(const Mesh& finest, int side, const Job& job) {
    if (is_whole(finest))
        pictures_.emplace(finest, finest_scene(), skin_, seed_, side, job);
    else
        pictures_.emplace(finest, skin_, seed_, side, job);
    glow_.reset();
}

ray::SkinPtr StandInEvaluator::skin_of(const StandInCandidate& unmatched) const {
    const bool same =
        unmatched.kind == Kind::Mesh && unmatched.materials.size() == materials_.size();
    return same ? skin_ : skin_of(unmatched.materials);
}

ray::SkinPtr StandInEvaluator::skin_of(std::span<const Material> materials) const {
    return std::make_shared<const ray::MeshSkin>(materials, texels_);
}

void StandInEvaluator::match_glow(StandInCandidate& candidate,
                                  const measure::AgreementReference::TracedPictures& traced,
                                  const Mesh& finest, const Job& job) {
    constexpr double kMost = 4;
    const auto emitted = [&](const measure::AgreementReference::TracedPictures& pictures,
                             std::span<const Material> materials) {
        std::vector<Material> dark;
        for (const Material& material : materials)
            dark.push_back(unlit(material));
        return pictures_->brightness_of(pictures, skin_of(dark)).light;
    };
    if (!glow_)
        glow_ = emitted(pictures_->trace(finest, skin_, job), materials_);
    const glm::dvec3 now = emitted(traced, candidate.materials);
    glm::dvec3 more(1.0);
    for (int i = 0; i < 3; ++i) {
        const double ratio = now[i] / (*glow_)[i];
        if (now[i] != 1 && (*glow_)[i] != 1 && std::isfinite(ratio))  // 1: none of that color
            more[i] = std::clamp(ratio, 1 / kMost, kMost);
    }
    for (Material& material : candidate.materials)
        emit_more(material, more);
}

void StandInEvaluator::compare_pictures(StandInCandidate& candidate,
                                        std::span<const uint16_t> tinted, const Job& job) {
    constexpr double kAlikeBright = 0.02;
    // Of a mesh some of the light is that of other slots.
    constexpr int kRounds = 2;
    std::vector<uint16_t> all(candidate.materials.size());
    std::iota(all.begin(), all.end(), uint16_t{0});
    ray::SkinPtr current = skin_of(candidate.materials);
    Mesh solid;
    const auto traced = pictures_->trace(traced_mesh(candidate, solid), current, job);
    const auto match = [&](std::span<const uint16_t> slots, int rounds) {
        for (int round = 0; round < rounds && !slots.empty(); ++round) {
            const glm::dvec3 light = pictures_->brightness_of(traced, current).light;
            const glm::dvec3 off = glm::abs(light - 1.0);
            if (std::max({off.x, off.y, off.z}) <= kAlikeBright)
                break;
            // Light that is scattered once is in proportion to the color.
            for (const uint16_t slot : slots) {
                if (slot < all.size())
                    solids::brighten(candidate.materials[slot], light);
            }
            current = skin_of(candidate.materials);
        }
    };
    match(tinted, kRounds);
    match(all, 1);  // what these cannot make up for, as of a house of many boards
    const double error = pictures_->of(traced, current).error;
    set_error(candidate, {error, error});
    come_to(candidate, CandidateState::Pictured);
}

void StandInEvaluator::match_brightness(StandInCandidate& candidate, const Mesh& finest,
                                        double used_to, const Job& job) {
    constexpr double kAlikeBright = 0.01;
    constexpr double kMost = 2;
    // What glows, and what is clear, has no part in the correction: further rounds are nearer.
    constexpr int kRounds = 3;
    const bool glows = std::any_of(materials_.begin(), materials_.end(), emits);
    if (candidate.state != CandidateState::Measured || !is_matched(used_to))
        return;
    using Pictures = measure::AgreementReference;
    if (!pictures_)
        take_pictures_of(finest, glows ? Pictures::kSide : Pictures::kBrightSide, job);
    ray::SkinPtr current = skin_of(candidate.materials);
    Mesh solid;
    const auto traced = pictures_->trace(traced_mesh(candidate, solid), current, job);
    if (glows) {
        match_glow(candidate, traced, finest, job);
        current = skin_of(candidate.materials);
    }
    for (int round = 0; round < kRounds; ++round) {
        const glm::dvec3 light = pictures_->brightness_of(traced, current).light;
        const glm::dvec3 off = glm::abs(light - 1.0);
        if (!(std::max({off.x, off.y, off.z}) > kAlikeBright))
            break;
        for (Material& material : candidate.materials) {
            // The color of glass is that of what is seen through it.
            if (!(material.transmission * (1 - material.metallic) > 0.5))
                solids::brighten(material,
                                 glm::clamp(light, glm::dvec3(1 / kMost), glm::dvec3(kMost)));
        }
        current = skin_of(candidate.materials);
    }
    come_to(candidate, CandidateState::Matched);
    if (candidate.kind != Kind::Mesh || layer_)
        return;
    // Near something else that is left a point may have been all that closed a gap. Where the error
    // is as large as the pictures' pixels all that they show counts, half.
    const double own = candidate.error - child_error_;
    const double seen = own < kUsedNear * size_ ? pictures_->gap_error(traced, current, own)
                                                : kPictures * pictures_->of(traced, current).error;
    candidate.error = std::max(candidate.error, seen + child_error_);
    candidate.max_error = std::max(candidate.max_error, seen + child_error_);
}

void StandInEvaluator::paint(StandInCandidate& candidate) const {
    if (candidate.kind != Kind::Box || candidate.state == CandidateState::Pictured || !patches_ ||
        candidate.materials[0].alpha_mode != AlphaMode::Opaque || emits(candidate.materials[0]))
        return;
    std::optional<solids::PaintedBox> painted = solids::painted_box(
        candidate.primitive, candidate.materials[0],
        patches_->fitted_vertex_colors(tessellate_box(candidate.primitive), finest_scene()));
    if (!painted)
        return;
    candidate.kind = Kind::Mesh;
    candidate.mesh = std::make_shared<const Mesh>(std::move(painted->mesh));
    candidate.materials = {std::move(painted->material)};
}

bool StandInEvaluator::looks_alike(const Mesh& drawn, std::span<const Material> materials,
                                   const Mesh& finest, double error, const Job& job) {
    constexpr double kMostOff = 0.1;
    if (!pictures_)
        take_pictures_of(finest, measure::AgreementReference::kCoarseSide, job);
    const ray::SkinPtr skin = skin_of(materials);
    const auto traced = pictures_->trace(drawn, skin, job);
    const measure::PictureAgreement seen = pictures_->of(traced, skin);
    const double light = (seen.light.x + seen.light.y + seen.light.z) / 3;
    return std::abs(light - 1) <= kMostOff && kPictures * seen.error + child_error_ <= error;
}

measure::VisibleOptions StandInEvaluator::visible_options(uint64_t rays) const {
    measure::VisibleOptions options;
    options.rays = rays;
    options.seed = seed_;
    return options;
}

std::vector<double> StandInEvaluator::visible_by_tag(const Mesh& finest,
                                                     std::span<const uint32_t> by_triangle,
                                                     size_t tags, const Job& job) const {
    if (!is_whole(finest))
        return visible_by_tag_of_level(finest, by_triangle, tags, job);
    return area_by_tag(measure::measure_visible(finest, reference_.sampler(), skin_,
                                                visible_options(rays_), by_triangle, cast_, job),
                       tags);
}

std::vector<double> StandInEvaluator::visible_by_tag_of_level(const Mesh& level,
                                                              std::span<const uint32_t> by_triangle,
                                                              size_t tags, const Job& job) const {
    return area_by_tag(measure::measure_visible(level, ray::MeshScene(level, skin_), skin_,
                                                visible_options(rays_), by_triangle, job),
                       tags);
}

double StandInEvaluator::distance_for(double error) const {
    return (error - child_error_) / counted_error(1, environment_ || layer_, 0);
}

void StandInEvaluator::set_error(StandInCandidate& candidate,
                                 const measure::SurfaceDeviation& deviation) const {
    const auto counted = [&](double error) {
        return counted_error(error, environment_ || layer_, size_) + child_error_;
    };
    candidate.error = counted(deviation.error);
    candidate.max_error = std::max(candidate.error, counted(deviation.max));
}

}  // namespace lodestone::hierarchy
