// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/reduced_model.h"

#include "base/clock.h"
#include "hierarchy/proposers/collapse_levels.h"
#include "measure/deviation/surface_deviation.h"
#include "simplify/cluster/vertex_clustering.h"
#include "simplify/height_field.h"
#include "simplify/simplify.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lodestone::hierarchy {
namespace {

// The triangles of a level that is tried for an error, over those of the next finer one.
// Taste: a larger value comes nearer to the error, with more tries.
constexpr double kStep = 0.7;

struct ReducedMesh {
    std::shared_ptr<const Mesh> mesh;
    std::optional<measure::SurfaceDeviation> deviation;
};

/// The deviation of a level. Transparent surfaces are neither missed nor matched, and their looks
/// do not count.
measure::SurfaceDeviation deviation_of(const measure::DeviationReference& reference,
                                       const Mesh& level, const ray::SkinPtr& skin,
                                       const Job& job) {
    return reference.of(level, {{}, nullptr, skin}, job);
}

measure::DeviationReference reference_of(const Mesh& mesh, const ray::SkinPtr& skin,
                                         const ReductionOptions& wanted, const Job& job) {
    return {mesh, {8192, 8192, wanted.seed}, {{}, nullptr, skin}, job};
}

/// The CPU seconds of this process while it lives, added up.
class Stopwatch {
public:
    explicit Stopwatch(double& sum) : sum_(sum), start_(cpu_seconds()) {}
    ~Stopwatch() { sum_ += cpu_seconds() - start_; }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

private:
    double& sum_;
    double start_;
};

simplify::SimplifyOptions options_of(const ReductionOptions& wanted) {
    simplify::SimplifyOptions options;
    options.mode = wanted.mode == ReductionMode::Best ? simplify::SimplifyMode::Best
                                                      : simplify::SimplifyMode::Fast;
    options.keep_topology = wanted.keep_topology;
    return options;
}

// Below this share of its triangles a grid's even samples are more than a sixth worse than
// clusters.
// Fitted: to levels of a terrain of 178,802 triangles; the script was not kept.
constexpr double kLeastOfGrid = 0.08;

/// The fastest way to a count: a regular grid is sub-sampled, everything else is clustered.
Mesh clustered(const Mesh& mesh, size_t count, const Job& job) {
    const auto triangles = static_cast<double>(mesh.triangles.size());
    if (count >= 2 && static_cast<double>(count) >= kLeastOfGrid * triangles) {
        if (const auto grid = simplify::find_grid(mesh))
            return simplify::subsample(mesh, *grid, count, job);
    }
    return simplify::cluster_vertices(mesh, count, job);
}

ReducedMesh to_count(const Mesh& mesh, const ray::SkinPtr& skin, size_t count,
                     const ReductionOptions& wanted, double& cpu_s, const Job& job) {
    ReducedMesh out;
    {
        const Stopwatch watch(cpu_s);
        out.mesh = std::make_shared<Mesh>(
            wanted.mode == ReductionMode::Cluster
                ? clustered(mesh, count, job)
                : simplify::simplify_mesh(mesh, count, options_of(wanted), job));
    }
    if (wanted.measure)
        out.deviation = deviation_of(reference_of(mesh, skin, wanted, job), *out.mesh, skin, job);
    return out;
}

/// The coarsest level of a fine chain whose measured error is within the wanted one.
ReducedMesh to_error(const Mesh& mesh, const ray::SkinPtr& skin, double error,
                     const ReductionOptions& wanted, double& cpu_s, const Job& job) {
    std::vector<size_t> targets;
    double target = kStep * static_cast<double>(mesh.triangles.size());
    while (target >= 1) {
        const auto count = static_cast<size_t>(target);
        if (targets.empty() || count < targets.back())
            targets.push_back(count);
        target *= kStep;
    }
    std::vector<Mesh> levels;
    if (!targets.empty() && wanted.mode != ReductionMode::Cluster) {
        const Stopwatch watch(cpu_s);
        levels = simplify::simplify_chain(mesh, targets, options_of(wanted), job);
    }
    const measure::DeviationReference reference = reference_of(mesh, skin, wanted, job);
    ReducedMesh best{std::make_shared<Mesh>(mesh), measure::SurfaceDeviation{0, 0}};
    for (size_t i = 0; i < targets.size(); ++i) {
        job.check();
        Mesh level;
        if (wanted.mode == ReductionMode::Cluster) {
            const Stopwatch watch(cpu_s);
            level = clustered(mesh, targets[i], job);
        } else if (i < levels.size()) {
            level = std::move(levels[i]);
        } else {
            break;
        }
        const measure::SurfaceDeviation deviation = deviation_of(reference, level, skin, job);
        if (deviation.error > error)
            break;
        best = {std::make_shared<Mesh>(std::move(level)), deviation};
    }
    return best;
}

/// For every object by how much its occurrences enlarge an error at most.
std::vector<double> stretches_of(const Model& model, const std::vector<ObjectIndex>& order) {
    std::vector<double> stretches(model.objects.size(), 0);
    if (!order.empty())
        stretches[order.back()] = 1;  // the root
    for (size_t i = order.size(); i-- > 0;) {
        const Object& object = model.objects[order[i]];
        if (!object.group())
            continue;
        for (const Placement& placement : object.representations[0].assembly().placements)
            stretches[placement.object] = std::max(
                stretches[placement.object], stretches[order[i]] * stretch(placement.transform));
    }
    return stretches;
}

double largest_side(const Model& model) {
    if (model.root == kNoObject || model.objects[model.root].representations.empty())
        return 0;
    const glm::dvec3 size = model.objects[model.root].bound().box.size();
    return std::max({size.x, size.y, size.z});
}

void check_targets(const ReductionOptions& wanted) {
    const int given = (wanted.ratio != 0 ? 1 : 0) + (wanted.triangles != 0 ? 1 : 0) +
                      (wanted.error != 0 ? 1 : 0) + (wanted.pixels != 0 ? 1 : 0);
    if (given != 1)
        fail(Status::InvalidArgument, "give one of ratio, triangles, error and pixels");
    if (wanted.ratio != 0 && !(wanted.ratio > 0 && wanted.ratio <= 1))
        fail(Status::InvalidArgument, "the ratio is ", wanted.ratio, "; 0 to 1 expected");
    if (wanted.error != 0 && !(wanted.error > 0))
        fail(Status::InvalidArgument, "the error is ", wanted.error, " m; more than 0 expected");
    if (wanted.pixels != 0 && !(wanted.pixels > 0))
        fail(Status::InvalidArgument, "the error is ", wanted.pixels,
             " pixels; more than 0 expected");
    if (wanted.pixels != 0 && !(wanted.height_px > 0))
        fail(Status::InvalidArgument, "the model is ", wanted.height_px,
             " pixels high; more than 0 expected");
    if (wanted.mode != ReductionMode::Fast && wanted.mode != ReductionMode::Best &&
        wanted.mode != ReductionMode::Cluster)
        fail(Status::InvalidArgument, "mode is ", static_cast<int>(wanted.mode), ", not 0, 1 or 2");
    if (wanted.keep_topology && wanted.mode == ReductionMode::Cluster)
        fail(Status::InvalidArgument, "mode cluster does not keep the topology; fast and best do");
}

}  // namespace

ReductionReport reduce_model(Model& model, const ReductionOptions& wanted, const Job& job) {
    check_targets(wanted);
    job.stage(JobStage::Simplify);
    ReductionReport report;
    std::vector<ObjectIndex> leaves;
    const std::vector<ObjectIndex> order = bottom_up(model);
    const std::vector<double> stretches = stretches_of(model, order);
    const bool by_error = wanted.error != 0 || wanted.pixels != 0;
    const double error =
        wanted.pixels != 0 ? wanted.pixels * largest_side(model) / wanted.height_px : wanted.error;
    for (const ObjectIndex index : order) {
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
    std::vector<ReducedMesh> made;
    image::TexelCache texels;
    for (size_t i = 0; i < leaves.size(); ++i) {
        job.check();
        const Representation& finest = model.objects[leaves[i]].representations[0];
        const Mesh& mesh = finest.mesh();
        ray::SkinPtr skin;  // only what measures needs one
        if (by_error || wanted.measure)
            skin = std::make_shared<const ray::MeshSkin>(materials_of(model, finest), texels);
        const auto count = static_cast<size_t>(
            std::max(1.0, std::round(share * static_cast<double>(mesh.triangles.size()))));
        const double within = error / std::max(stretches[leaves[i]], 1e-300);
        made.push_back(by_error ? to_error(mesh, skin, within, wanted, report.cpu_s, job)
                                : to_count(mesh, skin, count, wanted, report.cpu_s, job));
        job.progress(static_cast<double>(i + 1) / static_cast<double>(leaves.size()));
    }
    for (size_t i = 0; i < leaves.size(); ++i) {  // nothing fails from here on
        Representation& finest = model.objects[leaves[i]].representations[0];
        report.triangles += made[i].mesh->triangles.size();
        if (made[i].deviation) {
            const double scale = stretches[leaves[i]];
            report.error = std::max(report.error, scale * made[i].deviation->error);
            report.max_error = std::max(report.max_error, scale * made[i].deviation->max);
        }
        finest.payload = made[i].mesh;
        summarize(finest, model);
        model.objects[leaves[i]].representations.resize(1);
    }
    return report;
}

}  // namespace lodestone::hierarchy
