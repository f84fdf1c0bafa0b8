// SPDX-License-Identifier: GPL-3.0-or-later
#include "build/stand_ins.h"

#include "approximate/replace.h"
#include "approximate/simplify.h"
#include "approximate/stand_in_material.h"
#include "build/flatten.h"
#include "measure/deviation.h"
#include "measure/visible.h"

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
// DESIGN 1: a group is measured against children whose own error is at most a quarter of the result.
constexpr double kChildShare = 0.25;
// Rays from a triangle that decide whether anything outside can see it.
constexpr int kRaysPerTriangle = 24;
constexpr int kSubdivisions = 3;  // an ellipsoid measured as 1280 triangles

uint64_t bytes_of(const Candidate& candidate) {
    // What POV-Ray keeps (notes in model.cpp): the cost that candidates are compared by.
    return candidate.kind == Kind::Mesh ? candidate.mesh->triangles.size() * 245 : 1500;
}

std::vector<size_t> targets_of(size_t triangles, size_t first, double ratio) {
    std::vector<size_t> targets;
    for (auto target = static_cast<double>(first); target >= kFewestTriangles; target *= ratio) {
        const auto count = static_cast<size_t>(target);
        if (count < triangles && (targets.empty() || count < targets.back()))
            targets.push_back(count);
    }
    return targets;
}

/// Measures candidates against one finest mesh.
class Judge {
public:
    Judge(const Mesh& finest, std::span<const Material> materials, const Settings& settings,
          uint64_t seed, double child_error, const Job& job)
        : scene_(finest),
          reference_(finest, {settings.samples, settings.samples, seed}),
          size_(bound_of(finest.positions).radius),
          child_error_(child_error),
          seed_(seed),
          rays_(settings.rays) {
        measure::VisibleOptions options;
        options.rays = settings.rays;
        options.seed = seed;
        attributes_ =
            measure::measure_visible(finest, scene_, materials, options, {}, job).attributes;
    }

    const Attributes& attributes() const { return attributes_; }

    /// False when the mesh shows another amount of surface than the finest.
    bool measure_mesh(Candidate& candidate, std::span<const Material> materials,
                      const Job& job) const {
        measure::VisibleOptions options;
        options.rays = rays_ / 2;
        options.seed = seed_;
        const Attributes now =
            measure::measure_visible(*candidate.mesh, materials, options, {}, job).attributes;
        set_error(candidate, reference_.of(*candidate.mesh));
        return std::abs(now.visible_area - attributes_.visible_area) <=
               kMostAreaChange * attributes_.visible_area;
    }

    void measure_primitive(Candidate& candidate) const {
        set_error(candidate,
                  reference_.of(candidate.kind == Kind::Box
                                    ? tessellate_box(candidate.primitive)
                                    : tessellate_ellipsoid(candidate.primitive, kSubdivisions)));
    }

private:
    void set_error(Candidate& candidate, const measure::Deviation& deviation) const {
        candidate.error = std::max({deviation.error + child_error_, child_error_ / kChildShare,
                                    kLeastRelativeError * size_});
        candidate.max_error = std::max(candidate.error, deviation.max + child_error_);
    }

    ray::Scene scene_;
    measure::DeviationReference reference_;
    Attributes attributes_;
    double size_;
    double child_error_;
    uint64_t seed_;
    uint64_t rays_;
};

void add_levels(std::vector<Candidate>& candidates, const Mesh& mesh,
                const std::vector<Material>& materials, const std::vector<size_t>& targets,
                const Judge& judge, const Job& job) {
    if (targets.empty())
        return;
    for (Mesh& level : approximate::simplify_chain(mesh, targets, {}, job)) {
        if (level.empty())
            continue;
        Candidate candidate;
        candidate.mesh = std::make_shared<Mesh>(std::move(level));
        candidate.materials = materials;
        if (judge.measure_mesh(candidate, materials, job))
            candidates.push_back(std::move(candidate));
    }
}

void add_primitives(std::vector<Candidate>& candidates, const Bound& bound, const Judge& judge) {
    const Material material = approximate::mean_material(judge.attributes());
    const auto add = [&](Kind kind, const std::optional<Primitive>& primitive) {
        if (!primitive)
            return;
        Candidate candidate;
        candidate.kind = kind;
        candidate.primitive = *primitive;
        candidate.materials = {material};
        judge.measure_primitive(candidate);
        candidates.push_back(std::move(candidate));
    };
    add(Kind::Box, approximate::fit_box(judge.attributes(), bound));
    add(Kind::Ellipsoid, approximate::fit_ellipsoid(judge.attributes(), bound));
}

uint64_t seed_of(const Object& object, const Settings& settings) {
    return Hasher().value(object.source_hash).value(settings.seed).result();
}

}  // namespace

Hash hash_of(const Settings& settings) {
    constexpr uint32_t kAlgorithms = 1;  // raised whenever the same settings give other stand-ins
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
                           const MeshSource& source, const Job& job) {
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
    const Judge judge(*mesh, materials, settings, seed_of(object, settings), 0, job);
    out.attributes = judge.attributes();
    if (out.attributes.empty())
        return out;
    const size_t count = mesh->triangles.size();
    const auto first = static_cast<size_t>(static_cast<double>(count) * settings.level_ratio);
    add_levels(out.candidates, *mesh, materials, targets_of(count, first, settings.level_ratio),
               judge, job);
    if (object.role != Role::Environment)
        add_primitives(out.candidates, finest.summary.bound, judge);
    keep_useful(out.candidates, finest.summary.cost.bytes);
    return out;
}

StandIns stand_ins_of_group(const Model& model, ObjectIndex group, const Settings& settings,
                            const MeshSource& source, const Job& job) {
    StandIns out;
    const Object& object = model.objects[group];
    const Summary& finest = object.representations.at(0).summary;
    const uint64_t budget =
        std::min(settings.group_triangles, std::max<uint64_t>(1000, finest.cost.triangles / 3));
    const double error = error_for_triangles(model, group, budget, job);
    Flat flat = flatten(model, group, error, source, job);
    if (flat.mesh.empty())
        return out;
    const uint64_t seed = seed_of(object, settings);
    const Judge judge(flat.mesh, flat.materials, settings, seed, flat.child_error, job);
    out.attributes = judge.attributes();
    if (out.attributes.empty())
        return out;

    const std::vector<uint8_t> seen =
        measure::seen_from_outside(flat.mesh, ray::Scene(flat.mesh), kRaysPerTriangle, seed, job);
    Mesh shell = subset(flat.mesh, seen);
    if (shell.empty())
        shell = flat.mesh;
    const size_t count = shell.triangles.size();
    add_levels(out.candidates, shell, flat.materials,
               targets_of(count + 1, count, settings.level_ratio), judge, job);
    if (object.role != Role::Environment && !flat.environment)
        add_primitives(out.candidates, finest.bound, judge);
    std::vector<Candidate> all = out.candidates;
    keep_useful(out.candidates, finest.cost.bytes);
    if (out.candidates.empty()) {
        // Every group has a stand-in, even one that saves nothing but the occurrences.
        Candidate whole;
        whole.mesh = std::make_shared<Mesh>(std::move(shell));
        whole.materials = flat.materials;
        judge.measure_mesh(whole, flat.materials, job);
        all.push_back(std::move(whole));
        keep_useful(all, ~uint64_t{0});
        out.candidates = {all.back()};
    }
    return out;
}

}  // namespace lodestone::build
