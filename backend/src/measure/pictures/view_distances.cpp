// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/pictures/view_distances.h"

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
/// Pictures show this much around the finest's bound, for larger stand-ins.
/// Taste: a larger value wastes more rays around the object.
constexpr double kFrameMargin = 1.1;

/// The rectangle around a mesh in a picture.
struct PictureFrame {
    glm::dvec3 right, up;
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};

    PictureFrame(const std::vector<glm::dvec3>& points, const glm::dvec3& towards) {
        const glm::dmat3 frame = picture_frame(towards);
        right = frame[0];
        up = frame[1];
        for (const glm::dvec3& point : points) {
            const glm::dvec3 at(glm::dot(point, right), glm::dot(point, up),
                                glm::dot(point, towards));
            low = glm::min(low, at);
            high = glm::max(high, at);
        }
        const glm::dvec3 margin = (kFrameMargin - 1) / 2 * (high - low);
        low -= margin;
        high += margin;
    }
};

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

/// The distance that at most a few of these exceed.
double most_of(std::vector<double>& far, size_t pixels) {
    const auto few =
        std::max<size_t>(1, static_cast<size_t>(kMostFar * static_cast<double>(pixels)));
    if (far.size() <= few)
        return 0;
    std::nth_element(far.begin(), far.begin() + static_cast<std::ptrdiff_t>(few), far.end(),
                     std::greater<>());
    return far[few];
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

void ViewDistances::aim(ViewPictures& pictures) const {
    pictures.rays.clear();
    const std::vector<glm::dvec3> corners = corners_of(finest_);
    if (corners.empty())
        return;
    for (uint32_t view = 0; view < directions_.size(); ++view) {
        const glm::dvec3& towards = directions_[view];
        const PictureFrame frame(corners, towards);
        const glm::dvec3 size = frame.high - frame.low;
        const double cell = std::sqrt(size.x * size.y / pictures.pixels);
        // A flat thing is a line from its side: nothing to see.
        if (!(cell > 0) || !std::isfinite(cell) || std::max(size.x, size.y) > cell * kPixels)
            continue;
        const double front = frame.high.z + size.x + size.y;
        const auto columns = static_cast<int>(std::ceil(size.x / cell));
        const auto rows = static_cast<int>(std::ceil(size.y / cell));
        for (int pixel = 0; pixel < rows * columns; ++pixel) {
            const int row = pixel / columns;
            const double x = frame.low.x + (pixel % columns + 0.5) * size.x / columns;
            const double y = frame.low.y + (row + 0.5) * size.y / rows;
            pictures.rays.push_back({x * frame.right + y * frame.up + front * towards, view});
        }
    }
}

const std::vector<ViewDistances::ViewRay>& ViewDistances::rays(double near, const Job& job) const {
    ViewPictures& pictures = near < kCoarse * radius_ ? fine_ : coarse_;
    std::vector<ViewRay>& out = pictures.rays;
    std::call_once(pictures.taken, [&] {
        aim(pictures);
        parallel_for((out.size() + kBlock - 1) / kBlock, [&](size_t block) {
            job.check();
            const ray::FlushDenormals burst;
            for (size_t i = block * kBlock; i < std::min(out.size(), (block + 1) * kBlock); ++i) {
                ViewRay& one = out[i];
                const ray::RayHit hit = scene_.first_hit(one.origin, -directions_[one.view]);
                one.seen = hit.hit;
                one.point = hit.point;
            }
        });
    });
    return out;
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
    std::vector<double> far;
    for (size_t begin = 0, end = 0; begin < asked.size(); begin = end) {
        size_t pixels = 0;
        far.clear();
        for (end = begin; end < asked.size() && asked[end].view == asked[begin].view; ++end) {
            pixels += off[end] >= 0 ? 1 : 0;
            if (off[end] > near && std::isfinite(off[end]))
                far.push_back(off[end]);
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
