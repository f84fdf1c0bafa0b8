// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/pictures/view_distances.h"

#include "base/maths.h"
#include "base/parallel.h"
#include "measure/pictures/cube_views.h"
#include "measure/visible/visible_sampler.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace lodestone::measure {
namespace {

/// The pixels of a picture.
/// Taste: more see smaller things, in time in proportion.
constexpr double kPixels = 576;
/// The same where the whole is eight pixels large or less for those who use it.
/// Taste: as kPixels.
constexpr double kFewPixels = 144;
/// The distance that counts as near, over the radius, from which on there are few.
/// Law: a quarter of the radius is an eighth of the size.
constexpr double kCoarse = 0.25;
/// The share of a picture's pixels that may be farther off.
/// Taste: a larger value loses thin parts, a smaller one counts single spikes.
constexpr double kMostFar = 0.001;
/// The share of a picture from which on the finest is seen well, and the pixels that it is to cover
/// where it is less.
/// Taste: larger values see smaller parts of what is strewn, for more rays.
constexpr double kThin = 0.125;
constexpr double kCovered = 1000;  // Taste: as kThin
/// The parts along both sides of a pixel, at most.
/// Taste: as kThin.
constexpr double kMostParts = 8;

/// The corners of a mesh's triangles, each once.
std::vector<glm::dvec3> corners_of(const Mesh& mesh) {
    std::vector<uint8_t> used(mesh.positions.size(), 0);
    for (const Triangle& t : mesh.triangles)
        used[t.x] = used[t.y] = used[t.z] = 1;
    std::vector<glm::dvec3> out;
    for (size_t i = 0; i < used.size(); ++i) {
        const glm::dvec3 point(mesh.positions[i]);
        if (used[i] != 0 && std::isfinite(point.x + point.y + point.z))
            out.push_back(point);
    }
    return out;
}

/// The distance that a ray found, and the pixels that it stands for.
using PixelDistance = std::pair<double, uint64_t>;

/// The distance that at most a few of these pixels exceed.
double most_of(std::vector<PixelDistance>& far, uint64_t pixels) {
    const auto few = static_cast<uint64_t>(kMostFar * static_cast<double>(pixels));
    std::sort(far.begin(), far.end(), std::greater<>());
    uint64_t farther = 0;
    for (size_t i = 0; i < far.size(); ++i) {
        farther += far[i].second;
        if (i > 0 && farther > few)
            return far[i].first;
    }
    return 0;
}

/// The distances of points, mostly neighbors in the list, to one surface.
class NearDistances {
public:
    NearDistances(const ray::MeshScene& scene, double near)
        : scene_(scene), near_(near), exact_(!scene.see_through()) {}

    /// Metres to the nearest point; where that is `near` or less, any number up to `near`.
    double operator()(const glm::dvec3& point) {
        // A point beside one that is near is no farther off than that one and the way to it.
        const double most = known_ + glm::distance(point, at_);
        if (most <= near_)
            return most;
        const ray::ClosestPoint closest =
            scene_.closest_point(point, std::numeric_limits<double>::infinity(), last_, near_);
        last_ = closest.triangle;
        if (exact_) {
            known_ = closest.distance;
            at_ = point;
        }
        return closest.distance;
    }

private:
    const ray::MeshScene& scene_;
    double near_;
    bool exact_;  // else edges of what is seen through are known roughly
    uint32_t last_ = ray::kNoTriangle;
    double known_ = std::numeric_limits<double>::infinity();  // the distance of this point:
    glm::dvec3 at_{0.0};
};

}  // namespace

ViewDistances::ViewDistances(const Mesh& finest, const ray::MeshScene& scene)
    : finest_(finest),
      scene_(scene),
      directions_(cube_directions()),
      radius_(radius_of(finest)),
      fine_{kPixels, {}, {}},
      coarse_{kFewPixels, {}, {}} {}

void ViewDistances::cast(std::span<ViewRay> rays, const Job& job) const {
    parallel_for((rays.size() + kBlock - 1) / kBlock, [&](size_t block) {
        job.check();
        const ray::FlushDenormals burst;
        for (size_t i = block * kBlock; i < std::min(rays.size(), (block + 1) * kBlock); ++i) {
            ViewRay& one = rays[i];
            const ray::RayHit hit = scene_.first_hit(one.origin, -directions_[one.view]);
            one.seen = hit.hit;
            one.point = hit.point;
        }
    });
}

void ViewDistances::divide(const PictureGrid& grid, std::span<const ViewRay> whole, size_t parts,
                           const Job& job, std::vector<ViewRay>& out) const {
    const std::vector<uint8_t> overlapped = grid.overlapped(finest_, parts);
    std::vector<ViewRay> fine;
    for (size_t pixel = 0; pixel < whole.size(); ++pixel) {
        ViewRay rest = whole[pixel];
        rest.pixels = 0;
        const size_t column = parts * (pixel % grid.columns());
        const size_t row = parts * (pixel / grid.columns());
        for (size_t i = 0; i < parts * parts; ++i) {
            const size_t part = (row + i / parts) * parts * grid.columns() + column + i % parts;
            if (overlapped[part] != 0)
                fine.push_back({grid.origin(part, parts), rest.view});
            else
                ++rest.pixels;
        }
        // Only a stand-in can be where the finest is not.
        if (!rest.seen && rest.pixels > 0)
            out.push_back(rest);
    }
    cast(fine, job);
    out.insert(out.end(), fine.begin(), fine.end());
}

std::vector<ViewDistances::ViewRay> ViewDistances::taken(double pixels, const Job& job) const {
    const std::vector<glm::dvec3> corners = corners_of(finest_);
    if (corners.empty())
        return {};
    std::vector<PictureGrid> grids;
    std::vector<ViewRay> whole;
    for (uint32_t view = 0; view < directions_.size(); ++view) {
        const PictureGrid& grid = grids.emplace_back(corners, directions_[view], pixels);
        for (size_t pixel = 0; pixel < grid.pixels(); ++pixel)
            whole.push_back({grid.origin(pixel), view});
    }
    cast(whole, job);
    std::vector<ViewRay> out;
    auto rays = std::span<const ViewRay>(whole);
    for (const PictureGrid& grid : grids) {
        const auto here = rays.first(grid.pixels());
        rays = rays.subspan(here.size());
        const auto covered = static_cast<double>(
            std::count_if(here.begin(), here.end(), [](const ViewRay& one) { return one.seen; }));
        size_t parts = 1;
        if (covered < kThin * static_cast<double>(here.size()))
            parts = static_cast<size_t>(limited(std::sqrt(kCovered / covered), 1, kMostParts));
        if (parts > 1)
            divide(grid, here, parts, job, out);
        else
            out.insert(out.end(), here.begin(), here.end());
    }
    return out;
}

const std::vector<ViewDistances::ViewRay>& ViewDistances::rays(double near, const Job& job) const {
    ViewPictures& pictures = near < kCoarse * radius_ ? fine_ : coarse_;
    std::call_once(pictures.taken, [&] { pictures.rays = taken(pictures.pixels, job); });
    return pictures.rays;
}

double ViewDistances::worst(const ray::MeshScene& stand_in, ViewedWay ways, double near,
                            const Job& job) const {
    const std::vector<ViewRay>& asked = rays(near, job);
    std::vector<double> off(asked.size(), -1);  // below 0: nothing is there
    parallel_for((asked.size() + kBlock - 1) / kBlock, [&](size_t block) {
        job.check();
        const ray::FlushDenormals burst;
        NearDistances to_stand_in(stand_in, near);
        NearDistances to_finest(scene_, near);
        for (size_t i = block * kBlock; i < std::min(asked.size(), (block + 1) * kBlock); ++i) {
            const ViewRay& one = asked[i];
            ray::RayHit hit;
            if (ways == ViewedWay::Both)
                hit = stand_in.first_hit(one.origin, -directions_[one.view]);
            if (hit.hit && one.seen && glm::length(hit.point - one.point) <= near) {
                off[i] = 0;
                continue;
            }
            if (one.seen)
                off[i] = to_stand_in(one.point);
            if (hit.hit)
                off[i] = std::max(off[i], to_finest(hit.point));
        }
    });
    double out = 0;
    std::vector<PixelDistance> far;
    for (size_t begin = 0, end = 0; begin < asked.size(); begin = end) {
        uint64_t pixels = 0;
        far.clear();
        for (end = begin; end < asked.size() && asked[end].view == asked[begin].view; ++end) {
            pixels += off[end] >= 0 ? asked[end].pixels : 0;
            if (off[end] > near && std::isfinite(off[end]))
                far.emplace_back(off[end], asked[end].pixels);
        }
        out = std::max(out, most_of(far, pixels));
    }
    return out;
}

double farthest_apart(const Mesh& from, const Mesh& to) {
    double out = std::numeric_limits<double>::infinity();
    Box3 box;
    for (const glm::dvec3& point : corners_of(from))
        box.add(point);
    if (box.empty())
        return out;
    // A corner of a box is the farthest of all its points from any point.
    for (const glm::dvec3& point : corners_of(to))
        out = std::min(out, glm::length(glm::max(point - box.low, box.high - point)));
    return out;
}

}  // namespace lodestone::measure
