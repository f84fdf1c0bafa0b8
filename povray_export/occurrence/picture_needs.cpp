// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/occurrence/picture_needs.h"

#include "base/error.h"
#include "base/maths.h"
#include "choose/criterion.h"
#include "choose/view_pyramid.h"
#include "light/light_arrival.h"
#include "light/light_plan.h"
#include "povray_export/scene/camera_writer.h"
#include "povray_export/scene/invertible_transform.h"
#include "ray/mesh_scene.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

namespace lodestone::povray {
namespace {

/// The rays through a picture that take as long as to write, parse and shade one triangle.
/// Taste: of 20 to 100 us; a larger value looks through smaller scenes.
constexpr double kRaysOfTriangle = 10;
/// The most distinct triangles that are looked through.
/// Taste: a larger value saves more of larger scenes, for 0.3 kB and 3 us each.
constexpr uint64_t kMostTriangles = 2'000'000;
/// The most triangles of all placements together.
/// Taste: a byte for each.
constexpr uint64_t kMostPlaced = uint64_t{1} << 28u;

/// The share of the picture that the bounds of all that is drawn cover, at most.
double covered_by_bounds(const Model& model, const choose::Cut& cut, const View& view) {
    const choose::ViewPyramid pyramid(view);
    double pixels = 0;
    for (const uint32_t chosen : cut.chosen) {
        const choose::CutNode& node = cut.nodes.at(chosen);
        const Representation& drawn = model.objects.at(node.object).representations.at(node.lod);
        const Bound bound = transformed(drawn.summary.bound, cut.world(node));
        if (drawn.summary.kind == Kind::Assembly || pyramid.outside(bound))
            continue;
        const double pixel = choose::pixel_size(view, distance(bound, view.camera.position));
        const double across = bound.radius / pixel;
        pixels += std::isfinite(across) ? kPi * across * across : kInfinity;
    }
    return std::min(1.0, pixels / (double(view.width) * double(view.height)));
}

/// Whether the picture is worth looking through: that takes less than what it may spare. To many
/// lamps the picture itself casts many times as many rays, and each thing on their way counts.
bool pays(const View& view, uint64_t triangles, std::span<const Light> lights) {
    if (static_cast<size_t>(std::count_if(lights.begin(), lights.end(), light::is_lamp)) >=
        light::kManyLamps)
        return true;
    return kRaysOfTriangle * static_cast<double>(triangles) >= light::SeenParts::rays(view);
}

}  // namespace

void PictureNeeds::find(const Model& model, const light::RendererSurfaces& renderer,
                        const choose::Cut& cut, const View& view, std::span<const Light> lights,
                        bool still, const Job& job) {
    *this = PictureNeeds();
    bounds_cover_ = covered_by_bounds(model, cut, view);
    full_detail_ = !(view.pixel_error > 0);
    if (full_detail_)
        lights = {};
    if ((full_detail_ && !still) || view.modifiers.off_screen == OffScreen::Full ||
        has_depth_blur(view.camera) || !ray::available())
        return;
    std::vector<light::DrawnThing> drawn;
    std::unordered_set<Hash> known;
    uint64_t triangles = 0;
    uint64_t placed = 0;
    drawn_.assign(cut.chosen.size(), kUnknown);
    for (size_t position = 0; position < cut.chosen.size(); ++position) {
        const choose::CutNode& node = cut.nodes.at(cut.chosen[position]);
        const Representation& representation =
            model.objects.at(node.object).representations.at(node.lod);
        Affine world = cut.world(node);
        if (representation.summary.kind == Kind::Assembly || !make_invertible(world))
            continue;
        placed += representation.summary.cost.triangles;
        if (known.insert(representation.summary.hash).second)
            triangles += representation.summary.cost.triangles;
        drawn_[position] = static_cast<uint32_t>(drawn.size());
        drawn.push_back({&representation, world, node.hidden});
    }
    if (triangles > kMostTriangles || placed > kMostPlaced || !pays(view, triangles, lights))
        return;
    try {
        parts_.emplace(model, renderer, drawn, view, lights, job);
    } catch (const Error& error) {
        if (error.status == Status::Cancelled)
            throw;
        return;  // a mask that cannot be decoded: what draws it says so
    }
    if (!parts_->known())
        parts_.reset();
    else if (!full_detail_)
        count_bytes(drawn);
}

/// Sums the bytes of each distinct representation, as far as no copy needs its triangles.
void PictureNeeds::count_bytes(std::span<const light::DrawnThing> drawn) {
    std::unordered_map<Hash, std::vector<uint8_t>> needed;
    std::unordered_map<Hash, uint64_t> bytes;
    for (size_t i = 0; i < drawn.size(); ++i) {
        const RepresentationSummary& summary = drawn[i].representation->summary;
        if (is_copied(summary.kind)) {
            bytes_left_out_ += parts_->needs(i) == 0 ? summary.cost.bytes : 0;
            continue;
        }
        bytes[summary.hash] = summary.cost.bytes;
        const std::span<const uint8_t> own = parts_->triangles(i);
        std::vector<uint8_t>& all = needed[summary.hash];
        all.resize(own.size(), 0);
        for (size_t k = 0; k < own.size(); ++k)
            all[k] = all[k] != 0 || own[k] != 0 ? 1 : 0;
    }
    for (const auto& [hash, triangles] : needed) {
        const auto unused = std::count(triangles.begin(), triangles.end(), uint8_t{0});
        if (!triangles.empty())
            bytes_left_out_ += static_cast<uint64_t>(static_cast<double>(bytes[hash]) *
                                                     static_cast<double>(unused) /
                                                     static_cast<double>(triangles.size()));
    }
}

}  // namespace lodestone::povray
