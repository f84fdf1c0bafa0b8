// SPDX-License-Identifier: GPL-3.0-or-later
#include "build/stand_ins.h"

#include "approximate/replace.h"
#include "approximate/simplify.h"
#include "approximate/stand_in_material.h"
#include "build/flatten.h"
#include "measure/deviation.h"
#include "measure/looks.h"
#include "measure/opacity.h"
#include "measure/visible.h"
#include "quality/cut.h"

#include <algorithm>
#include <cmath>

namespace lodestone::build {
namespace {

// A level that shows this much more or less surface than the original is no simplification of it
// (foliage gone bald), however near its remaining points are.
constexpr double kMostAreaChange = 0.25;
// Fewer triangles than this are left to primitives.
constexpr size_t kFewestTriangles = 8;
// An error below this fraction of the size is float noise; the finest alone has error 0.
constexpr double kLeastRelativeError = 1e-7;
// Roads, pavements and lawns lie on the ground in thin layers. A level that sinks by a little more
// than the layer is thick hides it, which shows from as far as the layer is wide: environment
// counts as this many times wider than it is off.
constexpr double kLayerWidth = 16;
// Rays from a triangle that decide whether anything outside can see it.
constexpr int kRaysPerTriangle = 24;
// Below this mean opacity nothing solid stands for it: it would hide what shines through.
constexpr double kLeastOpacity = 0.9;
constexpr int kSubdivisions = 3;  // an ellipsoid measured as 1280 triangles

uint64_t bytes_of(const Candidate& candidate) {
    return candidate.kind == Kind::Mesh ? candidate.mesh->triangles.size() * kBytesPerTriangle
                                        : kBytesPerPrimitive;
}

std::vector<size_t> targets_of(size_t triangles, size_t first, double ratio) {
    std::vector<size_t> targets;
    auto target = static_cast<double>(first);
    while (target >= kFewestTriangles) {
        const auto count = static_cast<size_t>(target);
        if (count < triangles && (targets.empty() || count < targets.back()))
            targets.push_back(count);
        target *= ratio;
    }
    return targets;
}

/// The ground is large, and what lies on it (roads, fields) a small share of it.
uint32_t samples_of(bool environment, const Settings& settings) {
    return environment ? 8 * settings.samples : settings.samples;
}

/// Measures candidates against one finest mesh.
class Judge {
public:
    Judge(const Mesh& finest, std::span<const Material> materials, image::TexelCache& texels,
          const Settings& settings, bool environment, uint64_t seed, double child_error,
          const Job& job)
        : size_(bound_of(finest.positions).radius),
          child_error_(child_error),
          layer_width_(environment ? kLayerWidth : 1),
          seed_(seed),
          rays_(settings.rays),
          skin_(std::make_shared<const ray::Skin>(materials, texels)),
          finest_looks_(looks_.of(finest, materials)),
          reference_(finest, {samples_of(environment, settings), settings.samples, seed},
                     {finest_looks_, &looks_, skin_}, job),
          opacity_(measure::mean_opacity(finest, *skin_, seed)) {
        measure::VisibleOptions options;
        options.rays = settings.rays;
        options.seed = seed;
        attributes_ =
            measure::measure_visible(finest, ray::Scene(finest, skin_), skin_, options, {}, job)
                .attributes;
    }

    const Attributes& attributes() const { return attributes_; }
    /// Whether something solid may stand for it.
    bool solid() const { return opacity_ >= kLeastOpacity; }
    /// Of the finest's materials, which levels share.
    const ray::SkinPtr& skin() const { return skin_; }

    void repaint(Mesh& level, const Job& job) const { reference_.repaint(level, skin_.get(), job); }

    /// Of a level with the finest's materials. False when it shows another amount of surface.
    bool measure_mesh(Candidate& candidate, const Job& job) {
        const Mesh& mesh = *candidate.mesh;
        measure::VisibleOptions options;
        options.rays = rays_ / 2;
        options.seed = seed_;
        const double visible =
            measure::measure_visible(mesh, ray::Scene(mesh, skin_), skin_, options, {}, job)
                .attributes.visible_area;
        const std::vector<uint16_t> looks = looks_.of(mesh, candidate.materials);
        set_error(candidate, reference_.of(mesh, {looks, &looks_, skin_}, job));
        return std::abs(visible - attributes_.visible_area) <=
               kMostAreaChange * attributes_.visible_area;
    }

    void measure_primitive(Candidate& candidate, const Job& job) {
        const Mesh mesh = candidate.kind == Kind::Box
                              ? tessellate_box(candidate.primitive)
                              : tessellate_ellipsoid(candidate.primitive, kSubdivisions);
        const std::vector<uint16_t> looks = looks_.of(mesh, candidate.materials);
        set_error(candidate, reference_.of(mesh, {looks, &looks_, nullptr}, job));
    }

private:
    void set_error(Candidate& candidate, const measure::Deviation& deviation) const {
        candidate.error =
            std::max(layer_width_ * deviation.error + child_error_, kLeastRelativeError * size_);
        candidate.max_error =
            std::max(candidate.error, layer_width_ * deviation.max + child_error_);
    }

    measure::Looks looks_;
    double size_;
    double child_error_;
    double layer_width_;
    uint64_t seed_;
    uint64_t rays_;
    ray::SkinPtr skin_;
    std::vector<uint16_t> finest_looks_;
    measure::DeviationReference reference_;
    double opacity_;
    Attributes attributes_;
};

bool shows_vertex_colors(const Material& material) {
    return material.vertex_colors || (material.other && shows_vertex_colors(*material.other));
}

void add_levels(std::vector<Candidate>& candidates, const Mesh& mesh,
                const std::vector<Material>& materials, const std::vector<size_t>& targets,
                Judge& judge, const Job& job) {
    if (targets.empty())
        return;
    Mesh plain;  // colors that no material shows would only be in the way
    const bool uncolored = !mesh.colors.empty() &&
                           std::none_of(materials.begin(), materials.end(), shows_vertex_colors);
    if (uncolored) {
        plain = mesh;
        plain.colors.clear();
    }
    for (Mesh& level : approximate::simplify_chain(uncolored ? plain : mesh, targets, {}, job)) {
        if (level.empty())
            continue;
        judge.repaint(level, job);
        Candidate candidate;
        candidate.mesh = std::make_shared<Mesh>(std::move(level));
        candidate.materials = materials;
        if (judge.measure_mesh(candidate, job))
            candidates.push_back(std::move(candidate));
    }
}

void add_primitives(std::vector<Candidate>& candidates, const Bound& bound, Judge& judge,
                    const Job& job) {
    const Material material = approximate::mean_material(judge.attributes());
    const auto add = [&](Kind kind, const std::optional<Primitive>& primitive) {
        if (!primitive)
            return;
        Candidate candidate;
        candidate.kind = kind;
        candidate.primitive = *primitive;
        candidate.materials = {material};
        judge.measure_primitive(candidate, job);
        candidates.push_back(std::move(candidate));
    };
    add(Kind::Box, approximate::fit_box(judge.attributes(), bound));
    add(Kind::Ellipsoid, approximate::fit_ellipsoid(judge.attributes(), bound));
}

/// What no ray from outside reaches is left out; everything stays when nothing would.
Mesh without_hidden(const Mesh& mesh, const ray::SkinPtr& skin, uint64_t seed, const Job& job) {
    const ray::Scene scene(mesh, skin);
    Mesh shell = subset(mesh, measure::seen_from_outside(mesh, scene, kRaysPerTriangle, seed, job));
    return shell.empty() ? mesh : shell;
}

uint64_t seed_of(const Object& object, const Settings& settings) {
    return Hasher().value(object.source_hash).value(settings.seed).result();
}

}  // namespace

Hash hash_of(const Settings& settings) {
    constexpr uint32_t kAlgorithms = 11;  // raised whenever the same settings give other stand-ins
    return Hasher()
        .value(kAlgorithms)
        .value(settings.level_ratio)
        .value(settings.rays)
        .value(settings.samples)
        .value(settings.group_triangles)
        .value(settings.seed)
        .result();
}

void keep_useful(std::vector<Candidate>& candidates, uint64_t finest_bytes) {
    std::stable_sort(
        candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
            return bytes_of(a) != bytes_of(b) ? bytes_of(a) < bytes_of(b) : a.error < b.error;
        });
    std::vector<Candidate> front;  // cheapest first, errors falling
    for (Candidate& candidate : candidates) {
        if (bytes_of(candidate) < finest_bytes &&
            (front.empty() || candidate.error < front.back().error))
            front.push_back(std::move(candidate));
    }
    std::reverse(front.begin(), front.end());
    candidates = std::move(front);
}

StandIns stand_ins_of_leaf(const Model& model, const Object& object, const Settings& settings,
                           const MeshSource& source, image::TexelCache& texels, const Job& job) {
    StandIns out;
    const Representation& finest = object.representations.at(0);
    const std::shared_ptr<const Mesh> mesh = source(finest);
    if (mesh->empty())
        return out;
    std::vector<Material> materials;
    for (const uint32_t material : finest.materials)
        materials.push_back(model.materials.at(material));
    if (materials.empty())
        materials.emplace_back();
    Judge judge(*mesh, materials, texels, settings, object.role == Role::Environment,
                seed_of(object, settings), 0, job);
    out.attributes = judge.attributes();
    if (out.attributes.empty())
        return out;
    const size_t count = mesh->triangles.size();
    const auto first = static_cast<size_t>(static_cast<double>(count) * settings.level_ratio);
    add_levels(out.candidates, *mesh, materials, targets_of(count, first, settings.level_ratio),
               judge, job);
    if (object.role != Role::Environment && judge.solid())
        add_primitives(out.candidates, finest.summary.bound, judge, job);
    keep_useful(out.candidates, finest.summary.cost.bytes);
    return out;
}

StandIns stand_ins_of_group(const Model& model, ObjectIndex group, const Surroundings& surroundings,
                            const Settings& settings, const MeshSource& source,
                            image::TexelCache& texels, const Job& job) {
    StandIns out;
    if (surroundings.hidden[group] != 0)
        return out;  // always opened: rays of one class see other parts of it than those of another
    const Object& object = model.objects[group];
    const Summary& finest = object.representations.at(0).summary;
    const std::vector<uint64_t>& uses = surroundings.uses;
    const bool environment = surroundings.environment[group] != 0;
    const uint64_t budget =
        std::min(settings.group_triangles, std::max<uint64_t>(1000, finest.cost.triangles / 3));
    const double fine = error_for_triangles(model, group, budget, job);
    const Flat reference = flatten(model, group, fine, source, job);
    if (reference.mesh.empty())
        return out;
    const uint64_t seed = seed_of(object, settings);
    Judge judge(reference.mesh, reference.materials, texels, settings, environment, seed,
                reference.child_error, job);
    out.attributes = judge.attributes();
    if (out.attributes.empty())
        return out;

    Mesh shell = without_hidden(reference.mesh, judge.skin(), seed, job);
    const size_t count = shell.triangles.size();
    add_levels(out.candidates, shell, reference.materials,
               targets_of(count + 1, count, settings.level_ratio), judge, job);
    if (!environment && judge.solid())
        add_primitives(out.candidates, finest.bound, judge, job);

    // A stand-in that costs more than what the children would use at its error is none: parts that
    // many groups share are cheap, one mesh for each of the groups is not.
    std::vector<Candidate> useful;
    for (const Candidate& candidate : out.candidates) {
        const double own = static_cast<double>(bytes_of(candidate)) /
                               static_cast<double>(std::max<uint64_t>(1, uses[group])) +
                           static_cast<double>(kBytesPerOccurrence);
        if (own < bytes_within(model, group, candidate.error, uses, job))
            useful.push_back(candidate);
    }
    keep_useful(useful, finest.cost.bytes);
    if (useful.empty()) {
        // Every group has a stand-in, even one that saves nothing but the occurrences.
        Candidate whole;
        whole.mesh = std::make_shared<Mesh>(std::move(shell));
        whole.materials = reference.materials;
        judge.measure_mesh(whole, job);
        out.candidates.push_back(std::move(whole));
        keep_useful(out.candidates, ~uint64_t{0});
        useful = {out.candidates.back()};
    }
    out.candidates = std::move(useful);
    return out;
}

}  // namespace lodestone::build
