// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/clock.h"
#include "base/parallel.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "hierarchy/flattened_group.h"
#include "hierarchy/reduced_model.h"
#include "measure/visible/surface_inertia.h"
#include "measure/visible/visible_attributes.h"

using namespace lodestone;
using namespace lodestone::capi;

namespace {

void copy_tensor(const glm::dmat3& tensor, double out[6]) {
    const double values[6] = {tensor[0][0], tensor[1][1], tensor[2][2],
                              tensor[1][0], tensor[2][1], tensor[0][2]};
    std::copy(values, values + 6, out);
}

}  // namespace

lds_status lds_surface_inertia(const float* positions, size_t vertex_count,
                               const uint32_t* triangles, size_t triangle_count, double* out_area,
                               double out_center[3], double out_inertia[6]) {
    return guard([&] {
        require(positions, "positions");
        require(triangles, "triangles");
        require(out_area, "out_area");
        require(out_center, "out_center");
        require(out_inertia, "out_inertia");
        Mesh mesh;
        mesh.positions.resize(vertex_count);
        for (size_t i = 0; i < vertex_count; ++i)
            mesh.positions[i] = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
        mesh.triangles.resize(triangle_count);
        for (size_t i = 0; i < triangle_count; ++i)
            mesh.triangles[i] = {triangles[3 * i], triangles[3 * i + 1], triangles[3 * i + 2]};
        check(mesh);
        const measure::SurfaceInertia inertia = measure::inertia_of_mesh(mesh);
        if (!(inertia.area > 0))
            fail(Status::InvalidArgument, "the surface has no area");
        *out_area = inertia.area;
        copy(inertia.center, out_center);
        copy_tensor(inertia.inertia(), out_inertia);
    });
}

lds_status lds_measure_options_default(lds_measure_options* options) {
    return guard([&] {
        lds_measure_options out{};
        out.rays = 4096;
        out.seed = 1;
        hand_out(options, out, "options");
    });
}

lds_status lds_model_measure(lds_model* model, lds_object object,
                             const lds_measure_options* options, lds_job* job,
                             lds_attributes* out_attributes) {
    return guard([&] {
        require(model, "model");
        known_bytes(out_attributes, "out_attributes");
        const lds_measure_options given = checked(options, "options");
        const ThreadLimit limit(given.threads);
        model->summarize();
        model->load_pictures();
        const hierarchy::MeshSource source = [&](const Representation& representation) {
            if (const auto* held =
                    std::get_if<std::shared_ptr<const Mesh>>(&representation.payload))
                return *held;
            return model->store.value().load_mesh(representation.summary.hash);
        };
        const Job progress = job_of(job);
        progress.stage(JobStage::Measure);
        const std::vector<uint64_t> uses(model->model.objects.size(), 1);
        hierarchy::OpenedGroup opened(model->model, model->index_of(object), uses);
        const hierarchy::FlattenedGroup flat =
            hierarchy::flatten_group(opened, 0, source, progress);
        measure::VisibleOptions wanted;
        wanted.rays = given.rays;
        wanted.relative_error = given.relative_error;
        wanted.seed = given.seed;
        const Attributes measured =
            measure::measure_visible(flat.mesh, flat.materials, wanted, {}, progress).attributes;
        progress.progress(1);
        lds_attributes out{};
        out.visible_area = measured.visible_area;
        out.surface_area = measured.surface_area;
        copy(measured.centroid, out.centroid);
        copy_tensor(measured.inertia(), out.inertia);
        out.normal_moment = measured.normal_moment;
        copy(measured.color, out.color);
        out.roughness = measured.roughness;
        out.metallic = measured.metallic;
        out.relative_error = measured.relative_error;
        out.rays = measured.rays;
        hand_out(out_attributes, out, "out_attributes");
    });
}

lds_status lds_simplify_options_default(lds_simplify_options* options) {
    return guard([&] {
        lds_simplify_options out{};
        out.seed = 1;
        hand_out(options, out, "options");
    });
}

lds_status lds_model_simplify(lds_model* model, const lds_simplify_options* options, lds_job* job,
                              lds_simplify_report* out_report) {
    return guard([&] {
        require(model, "model");
        known_bytes(out_report, "out_report");
        const lds_simplify_options given = checked(options, "options");
        const ThreadLimit limit(given.threads);
        model->load_finest();
        model->summarize();  // its bound
        hierarchy::ReductionOptions wanted;
        wanted.ratio = given.ratio;
        wanted.triangles = given.triangles;
        wanted.error = given.error;
        wanted.pixels = given.pixels;
        wanted.height_px = given.height_px;
        wanted.measure = given.measure != 0;
        wanted.seed = given.seed;
        wanted.mode = static_cast<hierarchy::ReductionMode>(given.mode);
        wanted.keep_topology = given.keep_topology != 0;
        const hierarchy::ReductionReport done =
            hierarchy::reduce_model(model->model, wanted, job_of(job));
        model->summarized = false;
        lds_simplify_report out{};
        out.triangles_before = done.triangles_before;
        out.triangles = done.triangles;
        out.cpu_s = done.cpu_s;
        out.error = done.error;
        out.max_error = done.max_error;
        hand_out(out_report, out, "out_report");
    });
}
