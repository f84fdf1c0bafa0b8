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

Reduced to_count(const Mesh& mesh, size_t count, const Reduction& wanted, double& cpu_s,
                 const Job& job) {
    const double start = cpu_seconds();
    Reduced out{std::make_shared<Mesh>(approximate::simplify(mesh, count, {}, job)), {}};
    cpu_s += cpu_seconds() - start;
    if (wanted.measure)
        out.deviation = measure::DeviationReference(mesh, {8192, 8192, wanted.seed}).of(*out.mesh);
    return out;
}

/// The coarsest level of a fine chain whose measured error is within the wanted one.
Reduced to_error(const Mesh& mesh, const Reduction& wanted, double& cpu_s, const Job& job) {
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
    const measure::DeviationReference reference(mesh, {8192, 8192, wanted.seed});
    Reduced best{std::make_shared<Mesh>(mesh), measure::Deviation{0, 0}};
    for (Mesh& level : levels) {
        job.check();
        const measure::Deviation deviation = reference.of(level);
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
    for (size_t i = 0; i < leaves.size(); ++i) {
        job.check();
        const Mesh& mesh = model.objects[leaves[i]].representations[0].mesh();
        const auto count = static_cast<size_t>(
            std::max(1.0, std::round(share * static_cast<double>(mesh.triangles.size()))));
        made.push_back(wanted.error != 0 ? to_error(mesh, wanted, report.cpu_s, job)
                                         : to_count(mesh, count, wanted, report.cpu_s, job));
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
