// SPDX-License-Identifier: GPL-3.0-or-later
// Handing what a cut draws to viewers that keep it, portion by portion.
#include "capi/chosen.h"
#include "capi/guard.h"
#include "view/viewer_batches.h"

#include <cstring>

using namespace lodestone;
using namespace lodestone::capi;

struct lds_batch {
    view::BatchMesh mesh;
};

namespace {

template <typename T>
void copy_out(const std::vector<T>& from, void* to, const char* what) {
    if (from.empty())
        return;
    require(to, what);
    std::memcpy(to, from.data(), from.size() * sizeof(T));
}

}  // namespace

lds_status lds_cut_make_batches(lds_model* model, lds_cut* cut, size_t* out_count) {
    return guard([&] {
        require(model, "model");
        require(cut, "cut");
        require(out_count, "out_count");
        require_current(*model, *cut);
        cut->batches = view::batches_of(model->model, cut->cut, cut->colors);
        cut->batch_colors = cut->colors;
        *out_count = cut->batches.size();
    });
}

lds_status lds_cut_batch_keys(const lds_cut* cut, uint64_t* out_keys, uint64_t* out_triangles,
                              size_t capacity) {
    return guard([&] {
        require(cut, "cut");
        const size_t count = std::min(capacity, cut->batches.size());
        if (count > 0) {
            require(out_keys, "out_keys");
            require(out_triangles, "out_triangles");
        }
        for (size_t i = 0; i < count; ++i) {
            out_keys[i] = cut->batches[i].key;
            out_triangles[i] = cut->batches[i].triangles;
        }
    });
}

lds_status lds_batch_create(lds_model* model, const lds_cut* cut, size_t position, lds_job* job,
                            lds_batch** out_batch) {
    return guard([&] {
        require(model, "model");
        require(cut, "cut");
        require(out_batch, "out_batch");
        require_current(*model, *cut);
        if (position >= cut->batches.size())
            fail(Status::InvalidArgument, "batch ", position, " of ", cut->batches.size());
        const view::ViewerBatch& batch = cut->batches[position];
        const Job progress = job_of(job);
        std::vector<uint32_t> levels(cut->cut.chosen.size(), view::kBoxOnly);
        for (const view::BatchPiece& piece : batch.pieces)
            levels.at(piece.choice) = cut->cut.nodes.at(cut->cut.chosen.at(piece.choice)).lod;
        load_levels(*model, cut->cut, levels, progress);
        auto made = std::make_unique<lds_batch>();
        made->mesh = view::mesh_of(model->model, cut->cut, batch, cut->batch_colors, progress);
        *out_batch = made.release();
    });
}

void lds_batch_destroy(lds_batch* batch) {
    delete batch;
}

size_t lds_batch_vertex_count(const lds_batch* batch) {
    return batch == nullptr ? 0 : batch->mesh.positions.size();
}

size_t lds_batch_triangle_count(const lds_batch* batch) {
    return batch == nullptr ? 0 : batch->mesh.triangles.size();
}

lds_status lds_batch_box(const lds_batch* batch, double out_box[6]) {
    return guard([&] {
        require(batch, "batch");
        require(out_box, "out_box");
        Box3 box;
        for (const glm::vec3& position : batch->mesh.positions)
            box.add(glm::dvec3(position));
        if (box.empty())
            box.low = box.high = glm::dvec3(0.0);
        copy(box.low, out_box);
        copy(box.high, out_box + 3);
    });
}

lds_status lds_batch_copy(const lds_batch* batch, float* out_positions, int16_t* out_normals,
                          uint8_t* out_colors, uint32_t* out_triangles) {
    return guard([&] {
        require(batch, "batch");
        copy_out(batch->mesh.positions, out_positions, "out_positions");
        copy_out(batch->mesh.normals, out_normals, "out_normals");
        copy_out(batch->mesh.colors, out_colors, "out_colors");
        copy_out(batch->mesh.triangles, out_triangles, "out_triangles");
    });
}
