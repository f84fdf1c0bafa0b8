// SPDX-License-Identifier: GPL-3.0-or-later
// Showing a cut in false colors.
#include "base/color.h"
#include "capi/chosen.h"
#include "capi/guard.h"
#include "image/compare_shown.h"
#include "povray_export/texture/surface_finish.h"
#include "view/viewer_surface.h"

#include <cmath>

using namespace lodestone;
using namespace lodestone::capi;

namespace {

uint8_t displayed(double linear) {
    const auto value = static_cast<float>(std::clamp(linear, 0.0, 1.0));
    return static_cast<uint8_t>(std::lround(encode_srgb(value) * 255.0f));
}

}  // namespace

lds_status lds_cut_set_colors(lds_cut* cut, const double* colors, size_t count) {
    return guard([&] {
        require(cut, "cut");
        if (count != 0 && count != cut->cut.chosen.size())
            fail(Status::InvalidArgument, count, " colors for ", cut->cut.chosen.size(),
                 " chosen occurrences");
        if (count > 0)
            require(colors, "colors");
        std::vector<glm::dvec3> given;
        given.reserve(count);
        for (size_t i = 0; i < count; ++i) {
            given.push_back(vector(colors + 3 * i, "a color"));
            if (glm::any(glm::lessThan(given.back(), glm::dvec3(0.0))) ||
                glm::any(glm::greaterThan(given.back(), glm::dvec3(1.0))))
                fail(Status::InvalidArgument, "color ", i, " is not within 0 and 1");
        }
        cut->colors = std::move(given);
    });
}

lds_status lds_cut_set_identities(lds_cut* cut) {
    return guard([&] {
        require(cut, "cut");
        if (cut->cut.chosen.size() >= (size_t{1} << 24u) - 1)
            fail(Status::InvalidArgument, cut->cut.chosen.size(),
                 " occurrences are more than there are colors to tell them by");
        std::vector<glm::dvec3> given;
        for (size_t i = 0; i < cut->cut.chosen.size(); ++i) {
            const std::array<double, 3> color = image::identity_color(static_cast<uint32_t>(i));
            given.emplace_back(color[0], color[1], color[2]);
        }
        cut->colors = std::move(given);
    });
}

lds_status lds_cut_make_surface(lds_model* model, lds_cut* cut, uint64_t most_triangles,
                                lds_job* job, uint64_t* out_triangles) {
    return guard([&] {
        require(model, "model");
        require(cut, "cut");
        require(out_triangles, "out_triangles");
        require_current(*model, *cut);
        view::ViewerSurface made;
        if (most_triangles > 0) {
            const Job progress = job_of(job);
            const std::vector<uint32_t> levels =
                view::surface_levels(model->model, cut->cut, most_triangles);
            load_levels(*model, cut->cut, levels, progress);
            made = view::surface_of(model->model, cut->cut, levels, progress);
        }
        cut->surface = std::move(made);
        *out_triangles = cut->surface.owners.size();
    });
}

lds_status lds_cut_surface_copy(const lds_cut* cut, float* out_corners, uint8_t* out_colors,
                                size_t capacity) {
    return guard([&] {
        require(cut, "cut");
        const view::ViewerSurface& surface = cut->surface;
        if (capacity < surface.owners.size())
            fail(Status::InvalidArgument, "the surface has ", surface.owners.size(),
                 " triangles, the buffers room for ", capacity);
        if (surface.owners.empty())
            return;
        require(out_corners, "out_corners");
        require(out_colors, "out_colors");
        for (size_t i = 0; i < surface.corners.size(); ++i) {
            for (int axis = 0; axis < 3; ++axis)
                out_corners[3 * i + static_cast<size_t>(axis)] = surface.corners[i][axis];
        }
        for (size_t i = 0; i < surface.owners.size(); ++i) {
            const uint32_t owner = surface.owners[i];
            const choose::CutNode& node = cut->cut.nodes[cut->cut.chosen[owner]];
            const glm::dvec3 color =
                (cut->colors.empty() ? povray::color_of(node.kind, node.lod) : cut->colors[owner]) *
                view::shade_of(surface.corners.data() + 3 * i);
            const uint8_t pixel[4] = {displayed(color.x), displayed(color.y), displayed(color.z),
                                      255};
            for (size_t corner = 0; corner < 3; ++corner)
                std::copy_n(pixel, 4, out_colors + 12 * i + 4 * corner);
        }
    });
}
