// SPDX-License-Identifier: GPL-3.0-or-later
#include "build/reduce.h"

#include "approximate/simplify.h"
#include "base/clock.h"
#include "measure/deviation.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lodestone::build {
namespace {

// How much finer than its coarser neighbor the levels tried for an error are.
constexpr double kStep = 0.7;

struct Reduced {
    std::shared_ptr<const Mesh> mesh;
    std::optional<measure::Deviation> deviation;
};

std::vector<Material> materials_of(const Model& model, const Representation& representation) {
    std::vector<Material> materials;
    for (const uint32_t material : representation.materials)
        materials.push_back(model.materials.at(material));
    return materials;
}

/// What is transparent is neither missed nor matched; what it looks like does not count.
measure::Deviation deviation_of(const measure::DeviationReference& reference, const Mesh& level,
                                const ray::SkinPtr& skin, const Job& job) {
    return reference.of(level, {{}, nullptr, skin}, job);
}

measure::DeviationReference reference_of(const Mesh& mesh, const ray::SkinPtr& skin,
                                         const Reduction& wanted, const Job& job) {
    return {mesh, {8192, 8192, wanted.seed}, {{}, nullptr, skin}, job};
}

Reduced to_count(const Mesh& mesh, const ray::SkinPtr& skin, size_t count, const Reduction& wanted,
                 double& cpu_s, const Job& job) {
    const double start = cpu_seconds();
    Reduced out{std::make_shared<Mesh>(approximate::simplify(mesh, count, {}, job)), {}};
    cpu_s += cpu_seconds() - start;
    if (wanted.measure)
        out.deviation = deviation_of(reference_of(mesh, skin, wanted, job), *out.mesh, skin, job);
    return out;
}

/// The coarsest level of a fine chain whose measured error is within the wanted one.
Reduced to_error(const Mesh& mesh, const ray::SkinPtr& skin, const Reduction& wanted, double& cpu_s,
                 const Job& job) {
    std::vector<size_t> targets;
    double target = kStep * static_cast<double>(mesh.triangles.size());
    while (target >= 1) {
        const auto count = static_cast<size_t>(target);
        if (targets.empty() || count < targets.back())
            targets.push_back(count);
        target *= kStep;
    }
    const double start = cpu_seconds();
    std::vector<Mesh> levels;
    if (!targets.empty())
        levels = approximate::simplify_chain(mesh, targets, {}, job);
    cpu_s += cpu_seconds() - start;
    const measure::DeviationReference reference = reference_of(mesh, skin, wanted, job);
    Reduced best{std::make_shared<Mesh>(mesh), measure::Deviation{0, 0}};
    for (Mesh& level : levels) {
        job.check();
        const measure::Deviation deviation = deviation_of(reference, level, skin, job);
        if (deviation.error > wanted.error)
            break;
        best = {std::make_shared<Mesh>(std::move(level)), deviation};
    }
    return best;
}

}  // namespace

ReductionReport reduce(Model& model, const Reduction& wanted, const Job& job) {
    const int given =
        (wanted.ratio != 0 ? 1 : 0) + (wanted.triangles != 0 ? 1 : 0) + (wanted.error != 0 ? 1 : 0);
    if (given != 1)
        fail(Status::InvalidArgument, "give one of ratio, triangles and error");
    if (wanted.ratio != 0 && !(wanted.ratio > 0 && wanted.ratio <= 1))
        fail(Status::InvalidArgument, "the ratio is ", wanted.ratio, "; 0 to 1 expected");
    if (wanted.error != 0 && !(wanted.error > 0))
        fail(Status::InvalidArgument, "the error is ", wanted.error, " m; more than 0 expected");

    job.stage(Stage::Simplify);
    ReductionReport report;
    std::vector<ObjectIndex> leaves;
    for (const ObjectIndex index : bottom_up(model)) {
        const Object& object = model.objects[index];
        if (object.representations.empty() || object.representations[0].summary.kind != Kind::Mesh)
            continue;
        leaves.push_back(index);
        report.triangles_before += object.representations[0].mesh().triangles.size();
    }
    const double share =
        wanted.triangles != 0 && report.triangles_before > 0
            ? static_cast<double>(wanted.triangles) / static_cast<double>(report.triangles_before)
            : wanted.ratio;
    std::vector<Reduced> made;
    image::TexelCache texels;
    for (size_t i = 0; i < leaves.size(); ++i) {
        job.check();
        const Representation& finest = model.objects[leaves[i]].representations[0];
        const Mesh& mesh = finest.mesh();
        ray::SkinPtr skin;  // only what measures needs one
        if (wanted.error != 0 || wanted.measure)
            skin = std::make_shared<const ray::Skin>(materials_of(model, finest), texels);
        const auto count = static_cast<size_t>(
            std::max(1.0, std::round(share * static_cast<double>(mesh.triangles.size()))));
        made.push_back(wanted.error != 0 ? to_error(mesh, skin, wanted, report.cpu_s, job)
                                         : to_count(mesh, skin, count, wanted, report.cpu_s, job));
        job.progress(static_cast<double>(i + 1) / static_cast<double>(leaves.size()));
    }
    for (size_t i = 0; i < leaves.size(); ++i) {  // nothing fails from here on
        Representation& finest = model.objects[leaves[i]].representations[0];
        report.triangles += made[i].mesh->triangles.size();
        if (made[i].deviation) {
            report.error = std::max(report.error, made[i].deviation->error);
            report.max_error = std::max(report.max_error, made[i].deviation->max);
        }
        finest.payload = made[i].mesh;
        summarize(finest, model);
        model.objects[leaves[i]].representations.resize(1);
    }
    return report;
}

}  // namespace lodestone::build
